#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

namespace rotrocc {

/// Calls callbacks in a thread of its own, one after the other.
///
/// Nodelets have one because the manager's callbacks may lag for good: with nodelet 1.10.0 (Debian
/// 11), a message that arrives during onInit() has no callback, and each later callback of its
/// topic gets the message before the last one (nodelet_core#106).
class CallbackThread {
 public:
  /// The callbacks of what is created with the returned handle come after start().
  ros::NodeHandle attach(ros::NodeHandle nh) {
    nh.setCallbackQueue(&queue_);
    return nh;
  }

  void start() { spinner_.start(); }

  /// Call before what has the callbacks is destroyed.
  void stop() { spinner_.stop(); }

 private:
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace rotrocc
