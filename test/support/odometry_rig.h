#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "input/input_error.h"
#include "input/stereo_intake.h"
#include "node/base/pair_processor.h"
#include "rotrocc/parameters.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {

/// The part of the odometry that needs no ROS master, on a robot that drives along the street of
/// SyntheticScene, 0.4 m per pair at 10 Hz.
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

  /// Of the next pair.
  ros::Time stamp{1000.0};
  /// ROS time at arrival; `stamp` if not set.
  std::optional<ros::Time> clock;

  /// The mount at the next pair.
  Eigen::Isometry3d T_base_camera = kittiMount();

  /// The motion of the base between the stamps of two pairs by another sensor.
  std::function<std::optional<Eigen::Isometry3d>(std::int64_t prev_ns, std::int64_t cur_ns)>
      expected;

  /// See PairInput.
  bool is_simulated = false;

  /// Of the last pair that was processed since the last call of forget().
  const std::optional<PairAnswer>& answer() const { return answer_; }
  const std::string& hint() const { return hint_; }
  /// The left image of the last pair, as the estimator got it; valid until the next one.
  const cv::Mat& left() const { return left_; }
  void forget();

  /// Of the last pair since the last call of forget(): its state, as "ok", the error of its motion,
  /// or without a motion the change of the pose since then, and the hint. Without such a pair
  /// "dropped (<reason>): <sentence>" for each drop since then, or "no odometry".
  std::string observed() const;

  /// The state that a node reports after some seconds without odometry, as "NO_CALIBRATION".
  std::string stateWithoutAnswers() const;

  /// Of now, with the names of the topics.
  InputReport report() const;

  /// Pairs that were processed.
  int answers() const { return answers_; }

  PairProcessor& processor() { return processor_; }
  const DropLog& drops() const { return drops_; }

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
  std::string hint_;  // with answer_
  cv::Mat left_;
  BaseState state_, state_before_;  // of the last answer, and when forget() was called last
  double way_m_ = 0.0;              // between the last two pairs that were processed
  double last_place_m_ = 0.0;       // of the last one
  std::optional<std::int64_t> last_stamp_ns_;  // of the last one
  int answers_ = 0;
  std::map<DropReason, std::uint64_t> drops_before_;
};

}  // namespace rotrocc
