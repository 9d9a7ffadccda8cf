#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <std_srvs/SetBool.h>

#include "bags/recorded_tf.h"
#include "bags/stereo_topics.h"
#include "input/stereo_synchronizer.h"
#include "player/odometry_monitor.h"
#include "player/playback_clock.h"
#include "player/player_options.h"
#include "player/recording_publisher.h"

namespace rotrocc {

/// Replays a stereo bag to an odometry, with /clock. See RecordingPublisher for its topics and
/// PlayerOptions for its private parameters; the service ~pause (std_srvs/SetBool) pauses. In
/// lockstep it waits for the odometry of each pair, so no pair is dropped on a slow machine.
class KittiPlayer {
 public:
  /// Plays in its own thread, which calls `on_end` at the end or on failure. Throws std::exception
  /// on invalid parameters or an unusable bag.
  KittiPlayer(ros::NodeHandle& nh, ros::NodeHandle& private_nh, std::function<void()> on_end);

  /// Stops playing.
  ~KittiPlayer();
  KittiPlayer(const KittiPlayer&) = delete;
  KittiPlayer& operator=(const KittiPlayer&) = delete;

  bool paused() const { return clock_.paused(); }
  void setPaused(bool paused);

 private:
  using WallClock = std::chrono::steady_clock;

  /// Time range to play, in record time of the bag.
  struct TimeRange {
    ros::Time begin;
    ros::Time end;
  };

  static TimeRange rangeToPlay(const rosbag::Bag& bag,
                               const StereoTopics& topics,
                               const PlayerOptions& options);
  void run();
  bool stopped() const;
  void waitForSubscribers();
  void playOnce();
  void playImage(const rosbag::MessageInstance& message);
  void waitForOdometry(const ros::Time& stamp);
  void showProgress(const ros::Time& time);
  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);

  const PlayerOptions options_;
  rosbag::Bag bag_;
  const StereoTopics topics_;
  const TimeRange range_;
  const RecordedTf tf_;

  RecordingPublisher publisher_;
  ros::Publisher clock_publisher_;
  PlaybackClock clock_;
  StereoSynchronizer synchronizer_;
  OdometryMonitor monitor_;
  ros::ServiceServer pause_service_;
  WallClock::time_point last_progress_;
  const std::function<void()> on_end_;
  std::thread thread_;
};

}  // namespace rotrocc
