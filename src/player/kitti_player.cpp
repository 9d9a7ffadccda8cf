#include "player/kitti_player.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <ros/init.h>
#include <rosbag/view.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/Image.h>

#include "bags/bag_reading.h"
#include "bags/ground_truth.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::chrono::milliseconds kPollPeriod(100);
constexpr int kPollsPerWarning = 50;
constexpr std::chrono::seconds kProgressPeriod(5);
constexpr std::chrono::milliseconds kLastOdometryDelay(500);
constexpr int kQueueSize = 10;

std::string cameraFrame(const rosbag::Bag& bag, const StereoTopics& topics) {
  return firstMessage<sensor_msgs::Image>(bag, topics.left_image)->header.frame_id;
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

KittiPlayer::TimeRange KittiPlayer::rangeToPlay(const rosbag::Bag& bag,
                                                const StereoTopics& topics,
                                                const PlayerOptions& options) {
  rosbag::View view(bag, rosbag::TopicQuery(topics.all()));
  const double length_s = (view.getEndTime() - view.getBeginTime()).toSec();
  if (options.start > length_s) {
    throw std::invalid_argument("parameter start is " + toText(options.start) +
                                " s, but the bag is only " + toText(length_s) + " s long");
  }
  TimeRange range = {view.getBeginTime() + ros::Duration(options.start), view.getEndTime()};
  if (options.duration > 0.0) {
    range.end = std::min(range.end, range.begin + ros::Duration(options.duration));
  }
  return range;
}

KittiPlayer::KittiPlayer(ros::NodeHandle& nh,
                         ros::NodeHandle& private_nh,
                         std::function<void()> on_end)
    : options_(readPlayerOptions(private_nh)),
      bag_(openBag(options_.bag)),
      topics_(findStereoTopics(topicTypes(bag_), options_.left_image, options_.right_image)),
      range_(rangeToPlay(bag_, topics_, options_)),
      tf_(bag_, options_.base_frame, cameraFrame(bag_, topics_)),
      publisher_(nh, bag_, topics_, tf_),
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
  if (!options_.ground_truth_file.empty()) {
    writeGroundTruth(options_.ground_truth_file, publisher_.truth(), tf_.T_base_camera());
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
  ROS_INFO("playing %s and %s of %s",
           topics_.left_image.c_str(),
           topics_.right_image.c_str(),
           options_.bag.c_str());
  if (!ros::Time::isSimTime()) {
    ROS_WARN("use_sim_time is not set: nodes use the clock of this machine instead of the bag's");
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
    const bool odometry_missing = options_.lockstep && !monitor_.connected();
    if (missing.empty() && !odometry_missing) return;
    if (polls % kPollsPerWarning == kPollsPerWarning - 1) {
      ROS_WARN("waiting for subscribers of %s%s",
               join(missing).c_str(),
               odometry_missing ? " and a publisher of odom" : "");
    }
    std::this_thread::sleep_for(kPollPeriod);
  }
}

void KittiPlayer::playOnce() {
  rosbag::View view(
      bag_, rosbag::TopicQuery(publisher_.recordedTopics()), range_.begin, range_.end);
  publisher_.publishBeginning();
  monitor_.restart();
  synchronizer_.reset();
  clock_.start(view.getBeginTime());
  last_progress_ = WallClock::now();
  for (const rosbag::MessageInstance& message : view) {
    if (!clock_.waitUntil(message.getTime()) || stopped()) return;
    publisher_.publishTruthUntil(message.getTime());
    if (message.getTopic() == topics_.left_image || message.getTopic() == topics_.right_image) {
      playImage(message);
    } else {
      publisher_.publish(message);
    }
    showProgress(message.getTime());
  }
}

void KittiPlayer::playImage(const rosbag::MessageInstance& message) {
  const auto image = readMessage<sensor_msgs::Image>(message);
  const bool left = message.getTopic() == topics_.left_image;
  const auto pair = left ? synchronizer_.addLeft(image) : synchronizer_.addRight(image);
  if (pair) monitor_.expect(pair->left->header.stamp);
  if (left) {
    publisher_.publishLeft(image);
  } else {
    publisher_.publishRight(image);
  }
  if (pair && options_.lockstep) waitForOdometry(pair->left->header.stamp);
}

void KittiPlayer::waitForOdometry(const ros::Time& stamp) {
  const auto deadline =
      WallClock::now() + std::chrono::duration<double>(options_.lockstep_timeout_s);
  while (!monitor_.wait(stamp, kPollPeriod)) {
    if (stopped()) return;
    if (WallClock::now() < deadline) continue;
    ROS_WARN("no odometry for the pair of %.6f s within %g s; continuing",
             stamp.toSec(),
             options_.lockstep_timeout_s);
    return;
  }
}

void KittiPlayer::showProgress(const ros::Time& time) {
  if (WallClock::now() - last_progress_ < kProgressPeriod) return;
  last_progress_ = WallClock::now();
  ROS_INFO("%.1f of %.1f s: %s",
           (time - range_.begin).toSec(),
           (range_.end - range_.begin).toSec(),
           monitor_.summary().c_str());
}

}  // namespace rotrocc
