#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "input/drop_log.h"
#include "input/stereo_intake.h"
#include "node/pair_processor.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// All of the odometry that needs no ROS master: messages in, answers out. A robot with it drives
/// along the street of SyntheticScene, 0.4 m a pair at 10 Hz.
class OdometryRig {
 public:
  using ImageChange = std::function<void(sensor_msgs::Image& left, sensor_msgs::Image& right)>;
  using InfoChange =
      std::function<void(sensor_msgs::CameraInfo& left, sensor_msgs::CameraInfo& right)>;

  explicit OdometryRig(const Parameters& parameters = {});

  /// Both infos, and the next pair of the drive, after a change.
  void sendInfos(const InfoChange& change = {});
  void drive(const ImageChange& change = {});
  void drivePairs(int count);

  /// One image of the next pair; drive() sends both.
  sensor_msgs::Image nextImage(StereoIntake::Side side) const;
  void sendImage(StereoIntake::Side side, const sensor_msgs::Image& image);
  void advance();

  /// The stamp of the next pair, and ROS time.
  ros::Time stamp{1000.0};
  /// What comes with the images; as the stamp if it is none.
  std::optional<ros::Time> clock;

  /// What another sensor says of the motion.
  PairProcessor::MotionSource expected;

  /// To the last pair that was processed; none since the last call of forget().
  const std::optional<PairAnswer>& answer() const { return answer_; }
  void forget();

  /// Of the last pair since the last call of forget(): its state, as "ok", what is wrong with its
  /// motion, or without one what has become of the pose since then, and the hint. Else "dropped
  /// (<reason>): <sentence>" of what was dropped since then, or "no odometry".
  std::string observed() const;

  /// The state that a node would tell that has not answered for some seconds, as "NO_CALIBRATION".
  std::string stateWithoutAnswers() const;

  /// With the names of the topics.
  InputReport report(std::chrono::steady_clock::time_point now) const;

  /// Pairs that were processed.
  int answers() const { return answers_; }

  StereoIntake& intake() { return intake_; }
  PairProcessor& processor() { return processor_; }
  const DropLog& drops() const { return drops_; }
  std::chrono::steady_clock::time_point now() const { return now_; }

 private:
  void process(const ReceivedPair& pair);
  std::string describeAnswer() const;
  std::string describeDrops() const;

  DropLog drops_;
  PairProcessor processor_;
  StereoIntake intake_;
  int next_ = 0;
  std::chrono::steady_clock::time_point now_ = std::chrono::steady_clock::now();
  std::optional<PairAnswer> answer_;
  BaseState state_, state_before_;  // of the last answer, and when forget() was called last
  double way_m_ = 0.0;              // between the last two pairs that were processed
  double last_place_m_ = 0.0;       // of the last one
  int answers_ = 0;
  std::map<DropReason, std::uint64_t> drops_before_;
};

}  // namespace rotrocc
