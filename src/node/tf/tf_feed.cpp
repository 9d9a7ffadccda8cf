#include "node/tf/tf_feed.h"

#include <tf2_ros/transform_listener.h>

namespace rotrocc {

std::shared_ptr<void> listenToTf(tf2::BufferCore& buffer) {
  return std::make_shared<tf2_ros::TransformListener>(buffer);
}

}  // namespace rotrocc
