#include "node/odometry_messages.h"

#include <algorithm>
#include <stdexcept>

#include <sensor_msgs/point_cloud2_iterator.h>
#include <Eigen/Eigenvalues>

#include "input/to_text.h"
#include "node/tf/sensor_pose.h"

namespace rotrocc {
namespace {

/// Row-major, as the 6x6 covariances of geometry_msgs are.
void copyCovariance(const Matrix6d& covariance, boost::array<double, 36>& message) {
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.data()) = covariance;
}

/// Throws std::invalid_argument if it is not finite, symmetric and positive semidefinite.
Matrix6d toCovariance(const boost::array<double, 36>& message) {
  const Matrix6d covariance =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.data());
  if (!covariance.allFinite()) {
    throw std::invalid_argument("the covariance has a number that is not finite: correct it");
  }
  const double rounding = 1e-6 * covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > rounding) {
    throw std::invalid_argument("the covariance is not symmetric: correct it");
  }
  const Matrix6d symmetric = 0.5 * (covariance + covariance.transpose());
  const double least = Eigen::SelfAdjointEigenSolver<Matrix6d>(symmetric).eigenvalues().minCoeff();
  if (least < -rounding) {
    throw std::invalid_argument("the covariance has the eigenvalue " + toText(least) +
                                ", but none may be negative: correct it");
  }
  return symmetric;
}

}  // namespace

nav_msgs::Odometry toOdometry(const BaseState& state,
                              const std::string& odom_frame,
                              const std::string& base_frame) {
  nav_msgs::Odometry message;
  message.header.stamp = toRosTime(state.stamp_ns);
  message.header.frame_id = odom_frame;
  message.child_frame_id = base_frame;
  message.pose.pose = tf2::toMsg(state.T_odom_base.T);
  copyCovariance(state.T_odom_base.covariance, message.pose.covariance);
  message.twist.twist = tf2::toMsg(state.twist.twist);
  copyCovariance(state.twist.covariance, message.twist.covariance);
  return message;
}

geometry_msgs::TwistWithCovarianceStamped toTwist(const StepVelocity& velocity,
                                                  const std::string& base_frame) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header.stamp = toRosTime(velocity.stamp_ns);
  message.header.frame_id = base_frame;
  message.twist.twist = tf2::toMsg(velocity.twist.twist);
  copyCovariance(velocity.twist.covariance, message.twist.covariance);
  return message;
}

UncertainTransform toPose(const geometry_msgs::PoseWithCovarianceStamped& message,
                          const std::string& odom_frame) {
  const std::string& frame = message.header.frame_id;
  if (!frame.empty() && frame != odom_frame) {
    throw std::invalid_argument("the pose is in the frame " + frame + ", but must be in " +
                                odom_frame + ": transform it, or leave frame_id empty");
  }
  const geometry_msgs::Pose& pose = message.pose.pose;
  geometry_msgs::Transform transform;
  transform.translation.x = pose.position.x;
  transform.translation.y = pose.position.y;
  transform.translation.z = pose.position.z;
  transform.rotation = pose.orientation;
  return {toEigen(transform), toCovariance(message.pose.covariance)};
}

sensor_msgs::PointCloud2 toPointCloud(const Correspondences& features,
                                      const FeatureSet& set,
                                      const cv::Mat& left_image,
                                      const std_msgs::Header& header) {
  using Field = sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.height = 1;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  // clang-format off
  modifier.setPointCloud2Fields(4, "x", 1, Field::FLOAT32, "y", 1, Field::FLOAT32,
                                "z", 1, Field::FLOAT32, "intensity", 1, Field::FLOAT32);
  // clang-format on
  modifier.resize(static_cast<std::size_t>(std::count(set.begin(), set.end(), 1)));
  if (cloud.width == 0) return cloud;  // an iterator would access the first point
  sensor_msgs::PointCloud2Iterator<float> out(cloud, "x");
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set[i] == 0) continue;
    for (int axis = 0; axis < 3; ++axis)
      out[axis] = static_cast<float>(features[i].point_cur[axis]);
    const cv::Point pixel(cvRound(features[i].cur_px.x()), cvRound(features[i].cur_px.y()));
    const bool inside = cv::Rect({0, 0}, left_image.size()).contains(pixel);
    out[3] = inside ? static_cast<float>(left_image.at<unsigned char>(pixel)) : 0.0f;
    ++out;
  }
  return cloud;
}

}  // namespace rotrocc
