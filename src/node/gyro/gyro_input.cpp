#include "node/gyro/gyro_input.h"

#include <utility>

#include <ros/transport_hints.h>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr int kSampleQueueSize = 1000;  // a second of the fastest gyroscopes
constexpr std::chrono::seconds kVerticalWait(2);
constexpr std::int64_t kMemory_ns = static_cast<std::int64_t>(1e9 * GyroHistory::kLength_s);

}  // namespace

GyroInput::GyroInput(const ros::NodeHandle& nh,
                     const tf2::BufferCore& tf,
                     const NodeParameters& parameters,
                     Log log)
    : log_(std::move(log)),
      base_frame_(parameters.base_frame),
      pose_(tf, base_frame_, parameters.transform_timeout_s, std::nullopt) {
  subscriber_ = callbacks_.attach(nh).subscribe<sensor_msgs::Imu>(
      "imu",
      kSampleQueueSize,
      [this](const sensor_msgs::Imu::ConstPtr& message) { receive(*message); },
      ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay());
  callbacks_.start();
}

void GyroInput::receive(const sensor_msgs::Imu& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (message.header.stamp.isZero()) {
    return predictor_.reject("its stamp is zero: the driver must set header.stamp");
  }
  if (message.angular_velocity_covariance[0] == -1.0) {
    return predictor_.reject("it has no angular velocity: angular_velocity_covariance[0] is -1");
  }
  gyro_frame_ = withoutSlash(message.header.frame_id);
  predictor_.add(toGyroSample(message));
  if (message.linear_acceleration_covariance[0] != -1.0) {
    const geometry_msgs::Vector3& acceleration = message.linear_acceleration;
    vertical_.add(toGyroSample(message), {acceleration.x, acceleration.y, acceleration.z});
  }
}

void GyroInput::gather(std::int64_t stamp_ns,
                       const Eigen::Isometry3d& T_base_camera,
                       const WaitFor& wait) {
  std::unique_lock<std::mutex> lock(mutex_);
  const bool waits = watch_.waits() && !predictor_.whyDistrusted();
  lock.unlock();
  const auto has_samples = [&] {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto newest_ns = predictor_.history().newest_ns();
    return newest_ns && *newest_ns >= stamp_ns;
  };
  if (waits) wait(kTimeout_s, has_samples);
  lock.lock();
  const std::string frame = gyro_frame_;
  lock.unlock();
  // Without those from before a time jump, and those that are too old for its samples.
  auto& poses = R_camera_gyro_;
  poses.erase(poses.lower_bound(stamp_ns), poses.end());
  poses.erase(poses.begin(), poses.lower_bound(stamp_ns - kMemory_ns));
  const auto T_base_gyro = frame.empty() ? std::nullopt : pose_.find(frame, stamp_ns, wait);
  if (T_base_gyro) poses[stamp_ns] = T_base_camera.linear().transpose() * T_base_gyro->linear();
}

std::optional<Eigen::Matrix3d> GyroInput::rotation(std::int64_t from_ns, std::int64_t to_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  was_asked_ = true;
  const auto why_no_pose = whyNoPose(from_ns, to_ns);
  if (!why_no_pose) return predictor_.rotation(from_ns, to_ns);
  predictor_.miss(*why_no_pose);
  return std::nullopt;
}

/// Sets the poses at two pairs, if they are known.
std::optional<std::string> GyroInput::whyNoPose(std::int64_t from_ns, std::int64_t to_ns) {
  if (!predictor_.history().newest_ns()) return "no message on " + subscriber_.getTopic();
  const auto from = R_camera_gyro_.find(from_ns);
  const auto to = R_camera_gyro_.find(to_ns);
  if (from == R_camera_gyro_.end() || to == R_camera_gyro_.end()) {
    return "no tf from '" + gyro_frame_ + "', the frame of " + subscriber_.getTopic() + ", to " +
           base_frame_ + " at a pair";
  }
  predictor_.setMount(from->second, to->second);
  return std::nullopt;
}

bool GyroInput::waitsForVertical(std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!vertical_wait_) vertical_wait_ = now;
  const bool is_known = !whyNoPose(stamp_ns, stamp_ns) && vertical_.isComplete();
  return !is_known && now < *vertical_wait_ + kVerticalWait;
}

std::optional<Eigen::Vector3d> GyroInput::up(std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto why = whyNoPose(stamp_ns, stamp_ns);
  if (!why) why = vertical_.whyUnknown(stamp_ns);
  if (!why) return R_camera_gyro_.at(stamp_ns) * vertical_.up();
  log_.warn("the first pose is not level: " + *why);
  return std::nullopt;
}

void GyroInput::observe(const OdometryResult& result, OdometryStatus& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!whyNoPose(result.prev_stamp_ns, result.stamp_ns)) predictor_.observe(result);
  if (std::exchange(was_asked_, false)) {  // not by a first pair
    const auto& why_not = predictor_.whyNot();
    if (watch_.observe(!why_not)) {
      why_not ? log_.warn("the gyroscope is not used: " + *why_not)
              : log_.info("the gyroscope predicts rotations (" + gyro_frame_ + " on " +
                          base_frame_ + ")");
    }
  }
  status.imu_reason = predictor_.whyNot().value_or("");
  status.rotations_predicted = predictor_.counts().predicted;
  status.rotations_missed = predictor_.counts().missed;
}

void GyroInput::describe(StatusWrapper& status) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  describeGyro(predictor_, subscriber_.getTopic(), status);
}

}  // namespace rotrocc
