#include "node/gyro/gyro_input.h"

#include <utility>

#include <ros/transport_hints.h>

#include "input/message_conversion.h"
#include "node/tf/camera_mount.h"

namespace rotrocc {
namespace {

constexpr int kSampleQueueSize = 1000;  // a second of the fastest gyroscopes
constexpr std::chrono::seconds kVerticalWait(2);

}  // namespace

GyroInput::GyroInput(const ros::NodeHandle& nh, double timeout_s, Log log)
    : log_(std::move(log)), timeout_(timeout_s) {
  ros::NodeHandle own(nh);
  own.setCallbackQueue(&queue_);
  subscriber_ = own.subscribe<sensor_msgs::Imu>(
      "imu",
      kSampleQueueSize,
      [this](const sensor_msgs::Imu::ConstPtr& message) { receive(*message); },
      ros::VoidConstPtr(),
      ros::TransportHints().tcpNoDelay());
  spinner_.start();
}

GyroInput::~GyroInput() {
  subscriber_.shutdown();
  spinner_.stop();
}

void GyroInput::receive(const sensor_msgs::Imu& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (message.header.stamp.isZero()) {
    return predictor_.refuse("its stamp is zero, the driver must set header.stamp");
  }
  if (message.angular_velocity_covariance[0] == -1.0) {
    return predictor_.refuse("it has no angular velocity, angular_velocity_covariance[0] is -1");
  }
  gyro_frame_ = withoutSlash(message.header.frame_id);
  predictor_.add(toGyroSample(message));
  if (message.linear_acceleration_covariance[0] != -1.0) {
    const geometry_msgs::Vector3& acceleration = message.linear_acceleration;
    vertical_.add(toGyroSample(message), {acceleration.x, acceleration.y, acceleration.z});
  }
  received_.notify_all();
}

std::optional<Eigen::Matrix3d> GyroInput::rotation(const std::string& camera_frame,
                                                   std::int64_t from_ns,
                                                   std::int64_t to_ns) {
  std::unique_lock<std::mutex> lock(mutex_);
  was_asked_ = true;
  if (backoff_.waits() && predictor_.whyDistrusted().empty()) {
    received_.wait_for(lock, timeout_, [&] {
      const auto newest_ns = predictor_.history().newest_ns();
      return newest_ns && *newest_ns >= to_ns;
    });
  }
  const std::string why_no_mount = whyNoMount(withoutSlash(camera_frame));
  if (why_no_mount.empty()) return predictor_.rotation(from_ns, to_ns);
  predictor_.miss(why_no_mount);
  return std::nullopt;
}

/// Looks up the mount, unless it is known. Does not wait for tf.
std::string GyroInput::whyNoMount(const std::string& camera_frame) {
  if (!predictor_.history().newest_ns()) return "no message on " + subscriber_.getTopic();
  const std::string frames = gyro_frame_ + " to " + camera_frame;
  if (frames == mounted_on_) return "";
  mounted_on_.clear();
  if (!listener_) listener_ = std::make_unique<tf2_ros::TransformListener>(tf_);
  try {
    predictor_.setMount(
        toEigen(tf_.lookupTransform(camera_frame, gyro_frame_, ros::Time()).transform).linear());
  } catch (const std::exception&) {
    return "no tf from '" + gyro_frame_ + "', the frame of " + subscriber_.getTopic() + ", to " +
           camera_frame;
  }
  mounted_on_ = frames;
  listener_.reset();
  return "";
}

bool GyroInput::waitsForVertical(const std::string& camera_frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!vertical_wait_) vertical_wait_ = now;
  const bool is_known = whyNoMount(withoutSlash(camera_frame)).empty() && vertical_.isComplete();
  return !is_known && now < *vertical_wait_ + kVerticalWait;
}

std::optional<Eigen::Vector3d> GyroInput::up(const std::string& camera_frame,
                                             std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string why = whyNoMount(withoutSlash(camera_frame));
  if (why.empty()) why = vertical_.whyUnknown(stamp_ns);
  if (why.empty()) return predictor_.R_camera_gyro() * vertical_.up();
  log_.warn("the first pose is not level, but as the robot stands: " + why);
  return std::nullopt;
}

void GyroInput::observe(const OdometryResult& result) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!mounted_on_.empty()) predictor_.observe(result);
  if (!was_asked_) return;  // a first pair
  was_asked_ = false;
  const bool used = predictor_.whyNot().empty();
  used ? backoff_.onHit() : backoff_.onMiss();
  tell(used);
}

void GyroInput::tell(bool used) {
  in_a_row_ = used == was_used_ ? in_a_row_ + 1 : 1;
  was_used_ = used;
  if (in_a_row_ < kPairs || told_used_ == used) return;
  told_used_ = used;
  if (used) {
    log_.info("the gyroscope predicts rotations (" + mounted_on_ + ")");
  } else {
    log_.warn("the gyroscope is not used: " + predictor_.whyNot());
  }
}

void GyroInput::report(OdometryStatus& status) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  status.imu_reason = predictor_.whyNot();
  status.rotations_predicted = predictor_.counts().predicted;
  status.rotations_missed = predictor_.counts().missed;
}

void GyroInput::describe(StatusWrapper& status) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  describeGyro(predictor_, subscriber_.getTopic(), status);
}

}  // namespace rotrocc
