#pragma once

#include <chrono>

namespace rotrocc {

/// Adds the time from construction to destruction to the time of a stage.
class StageTimer {
 public:
  explicit StageTimer(double& account_ms) : account_ms_(account_ms) {}
  ~StageTimer() {
    account_ms_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& account_ms_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace rotrocc
