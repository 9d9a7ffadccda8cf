#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <ros/message_event.h>
#include <ros/subscriber.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include "input/callback_thread.h"

namespace rotrocc {

/// The transforms of /tf and /tf_static, received in a thread of its own.
class TfReceiver {
 public:
  using Event = ros::MessageEvent<tf2_msgs::TFMessage const>;
  using Observer = std::function<void(const Event& event, bool is_static)>;

  /// `observer` gets each message, in that thread.
  explicit TfReceiver(Observer observer = {});

  const tf2::BufferCore& buffer() const { return buffer_; }

  /// Also from other threads. Returns false, and leaves it out, if it is invalid.
  bool add(const geometry_msgs::TransformStamped& transform, bool is_static) {
    return buffer_.setTransform(transform, "", is_static);
  }

  /// Call with the stamp of each pair: after a jump back, the transforms from before it are
  /// dropped, as the buffer would reject those that are older.
  void follow(std::int64_t stamp_ns);

 private:
  ros::Subscriber subscribe(const std::string& topic, bool is_static);

  Observer observer_;
  tf2::BufferCore buffer_;
  std::int64_t last_stamp_ns_ = 0;
  CallbackThread callbacks_;
  ros::Subscriber subscriber_, static_subscriber_;  // last, so that callbacks end before
};

}  // namespace rotrocc
