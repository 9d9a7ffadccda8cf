#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace rotrocc {

/// A pool of threads that share the parts of a job with the calling thread: the left and right
/// image in parallel, or parts of a list. They sleep between jobs, so that the processor is free
/// for other nodelets of the process.
class Workers {
 public:
  /// `threads` >= 1 includes the calling thread. There are never more threads than processors,
  /// and fewer if the system cannot start them.
  explicit Workers(int threads);
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;

  /// Calls part(0) to part(parts - 1), each once, in any order and in parallel, and returns when
  /// all have finished. If a part throws, the remaining parts are skipped and the exception is
  /// rethrown here; if several throw, one of their exceptions. Must be called by one thread at a
  /// time, and not from within a part.
  template <class Part>
  void run(int parts, Part&& part) {
    share(parts, std::ref(part));  // no copy, which might allocate memory
  }

  /// Number of parts of a list. More parts than threads balance parts of different cost.
  static constexpr int kListParts = 8;

  /// Calls each(i, part) for all i below `count`, as run() does. `part` is below kListParts. No two
  /// calls with the same `part` run at the same time, so it can select a buffer. The part of an
  /// index i does not depend on the number of threads.
  template <class Each>
  void forEach(std::size_t count, Each&& each) {
    run(kListParts, [&](int index) {
      const auto part = static_cast<std::size_t>(index);
      const std::size_t end = count * (part + 1) / kListParts;
      for (std::size_t i = count * part / kListParts; i < end; ++i) each(i, part);
    });
  }

 private:
  using Job = std::function<void(int part)>;
  class Pool;

  void share(int parts, const Job& job);

  std::unique_ptr<Pool> pool_;
};

}  // namespace rotrocc
