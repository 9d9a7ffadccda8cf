#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <std_srvs/SetBool.h>

#include "bags/recording.h"
#include "input/stereo_synchronizer.h"
#include "player/odometry_monitor.h"
#include "player/playback_clock.h"
#include "player/player_options.h"
#include "player/recording_publisher.h"

namespace rotrocc {

/// Replays a stereo recording to an odometry, with /clock. See RecordingPublisher for its topics
/// and PlayerOptions for its private parameters; the service ~pause (std_srvs/SetBool) pauses. In
/// lockstep it waits for the odometry of each pair, so no pair is dropped on a slow machine. It
/// also waits for the pairs of a sequence that is being written.
class KittiPlayer {
 public:
  /// Plays in its own thread, which calls `on_end` at the end or on failure. Throws std::exception
  /// on invalid parameters or an unusable recording.
  KittiPlayer(ros::NodeHandle& nh, ros::NodeHandle& private_nh, std::function<void()> on_end);

  /// Stops playing.
  ~KittiPlayer();

  void setPaused(bool paused);

 private:
  using WallClock = std::chrono::steady_clock;

  void run();
  bool stopped() const;
  void waitForSubscribers();
  void playOnce();
  bool waitForRecording() const;
  bool readMessage(RecordedMessage& message) const;
  void play(const RecordedMessage& message);
  void waitForOdometry(const ros::Time& stamp);
  void showProgress(const ros::Time& time);
  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);

  const PlayerOptions options_;
  const std::unique_ptr<Recording> recording_;
  ros::Time begin_, end_;  // of what is played

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
