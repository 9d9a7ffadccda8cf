#pragma once

#include <chrono>
#include <thread>

namespace rotrocc {

/// Only against hanging: far longer than on a busy machine.
constexpr std::chrono::minutes kHangLimit(3);

/// Waits for a condition, which may have side effects. Returns whether it became true.
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
