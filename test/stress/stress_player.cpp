#include "stress/stress_player.h"

#include <sys/stat.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <ros/init.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "bags/recording.h"
#include "input/message_conversion.h"
#include "input/stereo_synchronizer.h"
#include "node/odometry_messages.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/SetPose.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kPairs = 100;  // of the recording, kept in memory
constexpr int kQueueSize = 100;
constexpr double kMaxStampDifference_s = 0.01;
constexpr int kBurst = 20;         // pairs at once
constexpr int kPairsPerCall = 50;  // of the services
constexpr int kLastPairs = 3;
/// Between two faults in turn, so that the log of one is not held back for that of another.
constexpr std::chrono::seconds kRest(6);
constexpr std::chrono::seconds kTfLimit(20);
constexpr std::chrono::seconds kSettleLimit(180);
const char* const kCameraFrame = "stress_camera";
const char* const kHeadFrame = "stress_head";
constexpr unsigned kPairsPerHead = 3;  // for each tf of the head

/// Subscribes to all that the odometry publishes, and mostly stands still: then it does not read
/// its sockets, as a computer behind a bad network. First it has the time to connect.
const char* const kSlowSubscriber =
    "sh -c 'rostopic hz odom path status flow inliers & trap \"kill -KILL $!; exit\" INT; "
    "while sleep 3; do kill -STOP $!; sleep 8; kill -CONT $!; done'";

/// Not the current time: in a previous run, the odometry may have received later stamps.
ros::Time firstStamp() {
  return ros::Time(1000.0);
}

void setStamp(const ros::Time& stamp, StressPair& pair) {
  pair.left.header.stamp = pair.right.header.stamp = stamp;
}

}  // namespace

StressPlayer::StressPlayer(ros::NodeHandle& nh, const StressOptions& options)
    : options_(options),
      faults_(options.in_turn ? FaultInjector(options.seed)
                              : FaultInjector(options.fault_share, options.seed)),
      audit_(nh),
      services_("stereo_odometry"),
      left_image_(nh.advertise<sensor_msgs::Image>("left/image_rect", kQueueSize)),
      right_image_(nh.advertise<sensor_msgs::Image>("right/image_rect", kQueueSize)),
      left_info_(nh.advertise<sensor_msgs::CameraInfo>("left/camera_info", kQueueSize)),
      right_info_(nh.advertise<sensor_msgs::CameraInfo>("right/camera_info", kQueueSize)) {
  read();
  if (mkfifo(fifo_.c_str(), 0600) != 0) throw std::runtime_error("cannot make " + fifo_);
}

void StressPlayer::read() {
  const auto recording = openRecording({options_.recording});
  recording->select(recording->begin(), recording->end(), false);
  truth_ = recording->truth();
  StereoSynchronizer synchronizer(kMaxStampDifference_s, kQueueSize);
  RecordedMessage message;
  while (recording_.size() < kPairs && recording->next(message)) {
    using Side = StereoSynchronizer::Side;
    std::optional<StereoImages> pair;
    if (message.left_image) pair = synchronizer.add(Side::kLeft, message.left_image);
    if (message.right_image) pair = synchronizer.add(Side::kRight, message.right_image);
    if (!pair) continue;
    const RecordedMessage infos = recording->firstInfos();
    recording_.emplace_back();
    recording_.back().left = *pair->left;
    recording_.back().right = *pair->right;
    recording_.back().left_info = *infos.left_info;
    recording_.back().right_info = *infos.right_info;
    recording_.back().left.header.frame_id = kCameraFrame;
  }
  if (recording_.size() < 2) {
    throw std::runtime_error(options_.recording + " has no two stereo pairs");
  }
  if (!options_.guess_frame.empty() && truth_.poses.size() < recording_.size()) {
    throw std::runtime_error(options_.recording + " has no true path for guess_frame");
  }
  const ros::Duration length =
      recording_.back().left.header.stamp - recording_.front().left.header.stamp;
  step_ = length * (1.0 / static_cast<double>(recording_.size() - 1));
}

void StressPlayer::waitForOdometry() {
  while (ros::ok() && !(audit_.connected() && right_info_.getNumSubscribers() > 0 &&
                        left_image_.getNumSubscribers() > 0)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

bool StressPlayer::run() {
  waitForOdometry();
  const bool with_faults = options_.in_turn || options_.fault_share > 0.0;
  if (with_faults) slow_subscriber_.emplace(kSlowSubscriber, "/dev/null");
  const auto period = std::chrono::duration_cast<steady_clock::duration>(
      std::chrono::duration<double>(1.0 / options_.rate_hz));
  end_ = steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(
                                   std::chrono::duration<double>(options_.duration_s));
  const auto loop = static_cast<int>(2 * recording_.size() - 2);  // forwards and backwards
  ros::Time stamp = firstStamp();
  begin_ = next_ = steady_clock::now();
  audit_.beginLoop();
  bool started = false;
  for (int i = 0; ros::ok() && !ended(); ++i) {
    if (!has_mount_ && (!with_faults || tfIsLate())) publishMount();
    started = started || audit_.loopRecovered();
    if (options_.in_turn) {
      if (burst_left_ == 0) stamp = ros::Time::now();
    } else if (with_faults && started && i % loop == 0) {
      audit_.beginLoop();
      stamp = firstStamp();
    }
    const auto forth = static_cast<std::size_t>(i % loop);
    const std::size_t back = static_cast<std::size_t>(loop) - forth;
    send(std::min(forth, back), stamp);
    if (with_faults && !options_.in_turn && i % kPairsPerCall == kPairsPerCall - 1) callServices();
    next_ += period;
    if (burst_left_ > 0) {
      --burst_left_;
    } else {
      std::this_thread::sleep_until(next_);
    }
  }
  settle(stamp);
  std::cout << audit_.report();
  for (const auto& [fault, count] : faults_.counts()) {
    std::cout << "fault: " << fault << ", " << count << '\n';
  }
  if (calls_ > 0) std::cout << "service calls " << calls_ << ", failed " << failed_calls_ << '\n';
  return audit_.passed() && failed_calls_ == 0;
}

bool StressPlayer::ended() const {
  if (steady_clock::now() >= end_) return true;
  return options_.in_turn && faults_.finished() && !was_faulty_ && audit_.recovered();
}

void StressPlayer::send(std::size_t index, ros::Time& stamp) {
  StressPair pair = recording_[index];
  setStamp(stamp, pair);
  // Noise: where it turns around, the pair after a dropped one would be that before it.
  pair.left.data[0] = pair.right.data[0] = static_cast<unsigned char>(++pairs_sent_);
  const Fault* before = was_faulty_ ? faults_.current() : nullptr;
  const bool is_faulty = faults_.apply(pair, mayBegin());
  if (is_faulty && faults_.current() != before) audit_.beginFault(*faults_.current());
  if (was_faulty_ && !is_faulty) {
    audit_.endFault();
    fault_end_ = steady_clock::now();
  }
  was_faulty_ = is_faulty;
  if (pair.on_head) pair.left.header.frame_id = kHeadFrame;
  if (pair.frozen) {
    pair.left.data = sent_.left.data;
    pair.right.data = sent_.right.data;
  }
  audit_.expect(stamp, std::uint64_t{pair.send_left} + std::uint64_t{pair.send_right});
  const ros::Duration ahead(pair.clock_s);
  publishTf(pair, index, stamp + ahead);
  for (auto* image : {&pair.left, &pair.right}) image->header.stamp += ahead;
  publish(pair);
  if (!pair.save_path.empty()) save(pair.save_path == kFifo ? fifo_ : pair.save_path);
  stamp += step_ + ros::Duration(pair.gap_s);
  pauseAfter(pair);
  sent_ = std::move(pair);
}

/// In turn, after a recovery and a rest.
bool StressPlayer::mayBegin() const {
  if (!options_.in_turn) return true;
  return !was_faulty_ && audit_.recovered() && steady_clock::now() > fault_end_ + kRest;
}

void StressPlayer::pauseAfter(const StressPair& pair) {
  double pause_s = 1e-3 * pair.pause_ms + pair.gap_s;
  if (pair.burst) {
    burst_left_ = kBurst;
    if (options_.in_turn) pause_s += kBurst / options_.rate_hz;
  }
  if (pause_s == 0.0) return;
  std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));
  next_ = steady_clock::now();
}

/// Sends some sound pairs, so that no image waits for a partner, and waits until the odometry has
/// counted all.
void StressPlayer::settle(ros::Time& stamp) {
  for (int i = 0; i < kLastPairs; ++i) {
    StressPair pair = recording_.front();
    setStamp(stamp, pair);
    audit_.expect(stamp, 2);
    publish(pair);
    stamp += step_;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  // Diagnostics come once a second; status too, 2 s after the last pair.
  std::this_thread::sleep_for(std::chrono::seconds(4));
  const auto limit = steady_clock::now() + kSettleLimit;
  while (ros::ok() && !audit_.images().addsUp() && steady_clock::now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// Whether the odometry has asked for it in the log, after silence_s, or will not.
bool StressPlayer::tfIsLate() const {
  return audit_.logged("no tf from base_link") || steady_clock::now() > begin_ + kTfLimit;
}

void StressPlayer::publishMount(double height_m) {
  has_mount_ = true;
  const Eigen::Isometry3d T_base_camera = Eigen::Translation3d(0, 0, height_m) * kittiMount();
  mount_broadcaster_.sendTransform(toTransform(T_base_camera, 0, "base_link", kCameraFrame));
}

void StressPlayer::publishTf(const StressPair& pair, std::size_t index, const ros::Time& stamp) {
  const std::int64_t stamp_ns = toNanoseconds(stamp);
  const std::string& guess_frame = options_.guess_frame;
  if (!guess_frame.empty() && pair.guess) {
    geometry_msgs::TransformStamped guess;
    guess.header.stamp = stamp;
    guess.header.frame_id = guess_frame;
    guess.child_frame_id = "base_link";
    const geometry_msgs::Pose& pose = truth_.poses[index].pose;
    guess.transform.translation.x = pose.position.x;
    guess.transform.translation.y = pose.position.y;
    guess.transform.translation.z = pose.position.z;
    guess.transform.rotation = pose.orientation;
    tf_broadcaster_.sendTransform(guess);
  }
  if (pair.rival_tf) {
    tf_broadcaster_.sendTransform(toTransform(Eigen::Isometry3d::Identity(),
                                              stamp_ns,
                                              "rival_odom",
                                              guess_frame.empty() ? "base_link" : guess_frame));
  }
  if (pair.on_head && pairs_sent_ % kPairsPerHead == 0) {
    const double pan_rad = 1e-3 * (pairs_sent_ / kPairsPerHead % 2);
    const Eigen::Isometry3d T_base_head =
        Eigen::AngleAxisd(pan_rad, Eigen::Vector3d::UnitZ()) * kittiMount();
    tf_broadcaster_.sendTransform(toTransform(T_base_head, stamp_ns, "base_link", kHeadFrame));
  }
  if (pair.moved) {
    publishMount(0.1);
    ++calls_;
    std_srvs::Trigger reset;
    if (!services_.call("reset", reset)) ++failed_calls_;
  }
}

void StressPlayer::publish(const StressPair& pair) {
  left_info_.publish(pair.left_info);
  right_info_.publish(pair.right_info);
  if (pair.send_left) left_image_.publish(pair.left);
  if (pair.send_right) right_image_.publish(pair.right);
}

/// One after the other; each must be answered, whatever the odometry does.
void StressPlayer::callServices() {
  const auto call = [&](const char* name, auto service) {
    ++calls_;
    if (!services_.call(name, service)) ++failed_calls_;
  };
  std_srvs::SetBool pause;
  SetPose set_pose;
  set_pose.request.pose.pose.pose.orientation.w = 1.0;
  SaveTrajectory save;
  save.request.path = "/no/such/directory/poses.txt";
  save.request.format = "tum";
  switch (calls_ / 2 % 4) {
    case 0:
      call("reset", std_srvs::Trigger());
      call("save_trajectory", save);
      break;
    case 1:
      call("set_pose", set_pose);
      call("save_trajectory", save);
      break;
    default:
      pause.request.data = true;
      call("pause", pause);
      pause.request.data = false;
      call("pause", pause);
  }
}

/// Must be refused at once.
void StressPlayer::save(const std::string& path) {
  SaveTrajectory save;
  save.request.path = path;
  save.request.format = "tum";
  ++calls_;
  if (!services_.call("save_trajectory", save) || save.response.success) ++failed_calls_;
}

}  // namespace rotrocc
