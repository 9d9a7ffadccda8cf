#include "node/tf/tf_feed.h"

#include <chrono>
#include <thread>

#include <ros/init.h>
#include <tf2_ros/transform_listener.h>

namespace rotrocc {

std::shared_ptr<void> listenToTf(tf2::BufferCore& buffer) {
  return std::make_shared<tf2_ros::TransformListener>(buffer);
}

bool waitForTransform(const tf2::BufferCore& buffer,
                      const std::string& target,
                      const std::string& source,
                      const ros::Time& stamp,
                      double timeout_s) {
  constexpr std::chrono::milliseconds kPoll(2);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!buffer.canTransform(target, source, stamp)) {
    if (ros::isShuttingDown() || std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

}  // namespace rotrocc
