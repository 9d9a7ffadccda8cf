#include "player/kitti_player.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <ros/init.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_eigen/tf2_eigen.h>
#include <boost/algorithm/string/join.hpp>

#include "input/input_error.h"
#include "input/message_conversion.h"
#include "input/to_text.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {
namespace {

constexpr std::chrono::milliseconds kPollPeriod(100);
constexpr std::chrono::milliseconds kRecordingPollPeriod(5);
constexpr int kPollsPerWarning = 50;
constexpr std::chrono::seconds kProgressPeriod(5);
constexpr std::chrono::milliseconds kLastOdometryDelay(500);
constexpr int kQueueSize = 10;

/// Throws std::invalid_argument if nobody would rectify the images.
std::unique_ptr<Recording> openPlayable(const PlayerOptions& options) {
  RecordingOptions how;
  how.topics = options.topics;
  std::istringstream files(options.calibration);
  how.sequence.calibration.assign(std::istream_iterator<std::string>(files), {});
  how.base_frame = options.base_frame;
  how.raw_sequence = options.rectify;
  how.sequence.max_stamp_difference_s = options.max_stamp_difference_s;
  how.sequence.being_written = options.image_timeout_s > 0.0;
  std::unique_ptr<Recording> recording = openRecording({options.bag}, how);
  if (!options.rectify && recording->isRaw()) {
    throw std::invalid_argument("by their calibration, the images of " + recording->description() +
                                " are not rectified: start with rectify:=true");
  }
  return recording;
}

/// As poses of the camera, relative to the first one, like the trajectory that the odometry writes.
/// Throws std::runtime_error if the file cannot be written.
void writeGroundTruth(const std::string& file,
                      const nav_msgs::Path& path_of_base,
                      const Eigen::Isometry3d& T_base_camera) {
  TrajectoryWriter writer(file, TrajectoryFormat::kTum);
  for (const geometry_msgs::PoseStamped& pose : path_of_base.poses) {
    Eigen::Isometry3d T_first_base;
    tf2::fromMsg(pose.pose, T_first_base);
    writer.write(
        {toNanoseconds(pose.header.stamp), T_base_camera.inverse() * T_first_base * T_base_camera});
  }
}

}  // namespace

KittiPlayer::KittiPlayer(ros::NodeHandle& nh,
                         ros::NodeHandle& private_nh,
                         std::function<void()> on_end)
    : options_(readPlayerOptions(private_nh)),
      recording_(openPlayable(options_)),
      publisher_(nh, *recording_, options_.rectify ? "image_raw" : "image_rect"),
      clock_publisher_(nh.advertise<rosgraph_msgs::Clock>("/clock", kQueueSize)),
      clock_(options_.rate,
             options_.paused,
             [this](const ros::Time& time) {
               rosgraph_msgs::Clock message;
               message.clock = time;
               clock_publisher_.publish(message);
             }),
      synchronizer_(options_.max_stamp_difference_s, kQueueSize),
      monitor_(nh),
      pause_service_(private_nh.advertiseService("pause", &KittiPlayer::onPause, this)),
      on_end_(std::move(on_end)) {
  const double length_s = (recording_->end() - recording_->begin()).toSec();
  if (options_.start > length_s) {
    throw std::invalid_argument("parameter start is " + toText(options_.start) +
                                " s, but the recording is only " + fixedText(length_s, 1) +
                                " s long");
  }
  begin_ = recording_->begin() + ros::Duration(options_.start);
  end_ = recording_->end();
  if (options_.duration > 0.0) end_ = std::min(end_, begin_ + ros::Duration(options_.duration));
  if (!options_.ground_truth_file.empty()) {
    writeGroundTruth(options_.ground_truth_file, publisher_.truth(), recording_->T_base_camera());
  }
  thread_ = std::thread(&KittiPlayer::run, this);
}

KittiPlayer::~KittiPlayer() {
  clock_.stop();
  thread_.join();
}

void KittiPlayer::setPaused(bool paused) {
  clock_.setPaused(paused);
  ROS_INFO(paused ? "paused" : "playing");
}

bool KittiPlayer::onPause(std_srvs::SetBool::Request& request,
                          std_srvs::SetBool::Response& response) {
  setPaused(request.data);
  response.success = true;
  return true;
}

void KittiPlayer::run() {
  ROS_INFO("playing %s", recording_->description().c_str());
  if (!recording_->leftOut().empty()) ROS_WARN("%s", recording_->leftOut().c_str());
  if (!ros::Time::isSimTime()) {
    ROS_WARN(
        "use_sim_time is not set: nodes use the clock of this machine instead of the recording's");
  }
  try {
    waitForSubscribers();
    do {
      playOnce();
    } while (options_.loop && !stopped());
    std::this_thread::sleep_for(kLastOdometryDelay);
    ROS_INFO("%s", monitor_.summary().c_str());
    if (synchronizer_.unmatched() > 0) {
      ROS_WARN("%zu images without a partner within %g s (max_stamp_difference_s)",
               static_cast<std::size_t>(synchronizer_.unmatched()),
               options_.max_stamp_difference_s);
    }
  } catch (const std::exception& error) {
    ROS_FATAL("playing %s: %s", options_.bag.c_str(), error.what());
  }
  std::fflush(stdout);  // the nodelet manager of Debian 11 may crash on exit
  on_end_();
}

bool KittiPlayer::stopped() const {
  return clock_.stopped() || !ros::ok();
}

void KittiPlayer::waitForSubscribers() {
  for (int polls = 0; !stopped(); ++polls) {
    const std::vector<std::string> missing = publisher_.topicsWithoutSubscriber();
    const bool odometry_missing = options_.lockstep_timeout_s > 0.0 && !monitor_.connected();
    if (missing.empty() && !odometry_missing) return;
    if (polls % kPollsPerWarning == kPollsPerWarning - 1) {
      ROS_WARN("waiting for subscribers of %s%s",
               boost::algorithm::join(missing, ", ").c_str(),
               odometry_missing ? " and a publisher of odom" : "");
    }
    std::this_thread::sleep_for(kPollPeriod);
  }
}

void KittiPlayer::playOnce() {
  recording_->select(begin_, end_, true);
  publisher_.publishBeginning();
  monitor_.restart();
  clock_.start(begin_);
  last_progress_ = WallClock::now();
  RecordedMessage message;
  while (waitForRecording() && readMessage(message)) {
    if (!clock_.waitUntil(message.time) || stopped()) return;
    publisher_.publishTruthUntil(message.time);
    play(message);
    showProgress(message.time);
  }
}

/// Skips images that cannot be decoded. Returns false at the end.
bool KittiPlayer::readMessage(RecordedMessage& message) const {
  while (true) {
    try {
      return recording_->next(message);
    } catch (const InputError& error) {
      ROS_WARN("skipped an image: %s", error.what());
    }
  }
}

/// Returns false if the player is stopped.
bool KittiPlayer::waitForRecording() const {
  const auto deadline = WallClock::now() + std::chrono::duration<double>(options_.image_timeout_s);
  while (!recording_->hasNext()) {
    if (stopped()) return false;
    if (WallClock::now() > deadline) {
      throw std::runtime_error("no further pair was written for " +
                               toText(options_.image_timeout_s) +
                               " s (image_timeout_s): is the program that writes them running?");
    }
    std::this_thread::sleep_for(kRecordingPollPeriod);
  }
  return true;
}

void KittiPlayer::play(const RecordedMessage& message) {
  std::optional<StereoImages> pair;
  using Side = StereoSynchronizer::Side;
  if (message.left_image) pair = synchronizer_.add(Side::kLeft, message.left_image);
  if (message.right_image) pair = synchronizer_.add(Side::kRight, message.right_image);
  if (pair) monitor_.expect(pair->left->header.stamp);
  publisher_.publish(message);
  if (pair && options_.lockstep_timeout_s > 0.0) waitForOdometry(pair->left->header.stamp);
}

void KittiPlayer::waitForOdometry(const ros::Time& stamp) {
  const auto deadline =
      WallClock::now() + std::chrono::duration<double>(options_.lockstep_timeout_s);
  while (!monitor_.wait(stamp, kPollPeriod)) {
    if (stopped()) return;
    if (WallClock::now() < deadline) continue;
    ROS_WARN("no odometry for the pair of %.3f s within %g s; continuing",
             stamp.toSec(),
             options_.lockstep_timeout_s);
    return;
  }
}

void KittiPlayer::showProgress(const ros::Time& time) {
  if (WallClock::now() - last_progress_ < kProgressPeriod) return;
  last_progress_ = WallClock::now();
  ROS_INFO("%.1f of %.1f s: %s",
           (time - begin_).toSec(),
           (end_ - begin_).toSec(),
           monitor_.summary().c_str());
}

}  // namespace rotrocc
