#pragma once

#include <functional>
#include <memory>
#include <string>

#include <ros/time.h>
#include <tf2/buffer_core.h>

namespace rotrocc {

/// Starts to fill a buffer with tf. It is filled, by another thread, while the returned object
/// exists.
using TfFeed = std::function<std::shared_ptr<void>(tf2::BufferCore& buffer)>;

/// From the topics /tf and /tf_static.
std::shared_ptr<void> listenToTf(tf2::BufferCore& buffer);

/// Waits for a transform, at most `timeout_s` in real time: ROS time may stand still. Returns
/// whether it came.
bool waitForTransform(const tf2::BufferCore& buffer,
                      const std::string& target,
                      const std::string& source,
                      const ros::Time& stamp,
                      double timeout_s);

}  // namespace rotrocc
