#include "common/workers.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace rotrocc {

class Workers::Pool {
 public:
  explicit Pool(int threads) {
    const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    try {
      for (int i = 1; i < std::min(threads, processors); ++i) {
        threads_.emplace_back([this] { serve(); });
      }
    } catch (const std::system_error&) {
      // The system has no more threads: those that there are do the same work.
    }
  }

  ~Pool() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    called_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void share(int parts, const Job& job) {
    if (threads_.empty() || parts < 2) {
      for (int i = 0; i < parts; ++i) job(i);
      return;
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      job_ = &job;
      parts_ = parts;
      next_ = 0;
      ++jobs_;
    }
    called_.notify_all();
    work(job);

    // Threads that have not woken up yet are not waited for: they will find no job.
    std::unique_lock<std::mutex> lock(mutex_);
    job_ = nullptr;
    done_.wait(lock, [this] { return busy_ == 0; });
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  }

 private:
  void serve() {
    pthread_setname_np(pthread_self(), "odometry_help");  // for `top -H` and debuggers
    std::unique_lock<std::mutex> lock(mutex_);
    for (unsigned served = 0;;) {
      called_.wait(lock, [&] { return ending_ || (job_ != nullptr && jobs_ != served); });
      if (ending_) return;
      served = jobs_;
      const Job& job = *job_;
      ++busy_;
      lock.unlock();
      work(job);
      lock.lock();
      if (--busy_ == 0) done_.notify_one();
    }
  }

  /// Processes parts until none is left.
  void work(const Job& job) {
    try {
      for (int i = next_++; i < parts_; i = next_++) job(i);
    } catch (...) {
      next_ = parts_;
      const std::lock_guard<std::mutex> lock(mutex_);
      thrown_ = std::current_exception();
    }
  }

  std::vector<std::thread> threads_;
  std::atomic<int> next_{0};  // next part of the job
  int parts_ = 0;             // changes only while no thread is working

  std::mutex mutex_;  // guards the members below
  std::condition_variable called_, done_;
  const Job* job_ = nullptr;
  unsigned jobs_ = 0;  // number of jobs so far
  int busy_ = 0;       // working threads, excluding the calling one
  bool ending_ = false;
  std::exception_ptr thrown_;
};

Workers::Workers(int threads) : pool_(std::make_unique<Pool>(threads)) {}
Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

void Workers::share(int parts, const Job& job) {
  pool_->share(parts, job);
}

}  // namespace rotrocc
