#pragma once

#include <chrono>
#include <thread>

namespace rotrocc {

/// Guards against hanging only: far beyond what a busy machine takes.
constexpr std::chrono::minutes kHangLimit(3);

/// Waits for a condition, which may act each time it is asked. Returns whether it came true.
template <class Condition>
bool waitUntil(Condition condition,
               std::chrono::milliseconds period = std::chrono::milliseconds(10)) {
  const auto limit = std::chrono::steady_clock::now() + kHangLimit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(period);
  }
  return true;
}

}  // namespace rotrocc
