#include "tools/odometry_bag.h"

#include <stdexcept>

#include <tf2_msgs/TFMessage.h>

#include "input/message_conversion.h"
#include "node/odometry_messages.h"

namespace rotrocc {

OdometryBag::OdometryBag(const std::string& path,
                         const Eigen::Isometry3d& T_base_camera,
                         const Parameters& parameters,
                         std::int64_t start_ns)
    : parameters_(parameters.node),
      start_ns_(start_ns),
      T_base_camera_(T_base_camera),
      odometry_(parameters.node, parameters.odometry.systematic_error) {
  try {
    bag_.open(path, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(path + " cannot be written: " + error.what());
  }
}

void OdometryBag::write(const OdometryResult& result) {
  BaseState state = odometry_.add(result, T_base_camera_);
  state.stamp_ns += start_ns_;
  const ros::Time stamp = toRosTime(state.stamp_ns);
  const std::string& odom = parameters_.odom_frame;
  const std::string& base = parameters_.base_frame;
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(toTransform(state.T_odom_base.T, state.stamp_ns, odom, base));
  bag_.write("/tf", stamp, tf);
  bag_.write("/stereo/odom", stamp, toOdometry(state, odom, base));
}

}  // namespace rotrocc
