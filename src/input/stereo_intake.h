#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "input/camera_calibration.h"
#include "input/input_error.h"
#include "input/input_report.h"
#include "input/log.h"
#include "input/stereo_synchronizer.h"
#include "rotrocc/parameters.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Pairs that are kept to find out why a later one has no motion.
constexpr std::size_t kPairsBefore = 3;

/// A received pair, with the camera known at that time.
struct ReceivedPair {
  StereoImages images;
  StereoCamera camera;                                   ///< of the rectified images
  std::chrono::steady_clock::time_point arrival;         ///< of the second image
  std::chrono::steady_clock::time_point taken;           ///< by who processes it
  double stamp_age_s = 0.0;                              ///< then; 0 if ROS time is not known
  std::int64_t clock_set_ns = 0;                         ///< see CameraClock::set_ns()
  double stamp_sigma_s = 0.0;                            ///< see CameraClock::stampScatter_s()
  bool follows_held = false;                             ///< at once, see CameraClock::Verdict
  std::shared_ptr<const StereoCalibration> calibration;  ///< of raw images; null: rectified ones
  std::vector<std::shared_ptr<const ReceivedPair>> before = {};  ///< the last ones, without theirs
};

/// Matches the messages of four topics to pairs, and keeps statistics. An image with a doubtful
/// stamp waits for the next one of its side, see CameraClock. A pair gets the camera of the infos
/// with its stamps if these are there, or else that of the newest ones: of the newest stamp that
/// both sides have, if any. Independent of ROS communication; not thread-safe.
class StereoIntake {
 public:
  using PairHandler = std::function<void(ReceivedPair)>;

  using Side = StereoSynchronizer::Side;

  /// Passes each pair to `on_pair` as soon as it is complete. The latest one waits while there is
  /// no valid camera_info. `drops` must outlive this.
  StereoIntake(const NodeParameters& parameters,
               DropLog& drops,
               PairHandler on_pair,
               Log log = Log());

  /// These do not throw: invalid input goes to the drop log.
  void addImage(Side side, const sensor_msgs::Image::ConstPtr& image, const Arrival& arrival);
  void addInfo(Side side, const sensor_msgs::CameraInfo::ConstPtr& info, const Arrival& arrival);

  /// Recent input. The caller adds names and publishers of topics, and the clock.
  InputReport report(std::chrono::steady_clock::time_point now) const;

 private:
  using Info = sensor_msgs::CameraInfo::ConstPtr;

  /// Messages of one side.
  struct Stream {
    sensor_msgs::Image::ConstPtr held;
    std::deque<Info> infos;  // the last ones
    TopicStatistics image_statistics, info_statistics;
  };

  Stream& stream(Side side) { return side == Side::kLeft ? left_ : right_; }
  void drop(Side side, const InputError& error);
  void match(Side side, const sensor_msgs::Image::ConstPtr& image, const Arrival& arrival);
  void useNewestInfos();
  void use(const Info& left, const Info& right);
  void handOver();
  void logCamera(const StereoCamera& camera);
  void logClock();

  NodeParameters parameters_;
  DropLog& drops_;
  PairHandler on_pair_;
  Log log_;

  Stream left_, right_;
  StereoSynchronizer synchronizer_;
  std::optional<ReceivedPair> waiting_;
  std::vector<std::shared_ptr<const ReceivedPair>> before_;  // see ReceivedPair
  bool follows_held_ = false;                                // the image that is matched now

  Info left_info_, right_info_;  // that the camera is from
  std::optional<StereoCamera> camera_;
  std::int64_t logged_set_ns_ = 0;                        // of the left clock, by the log
  StereoCamera logged_camera_;                            // by the log
  bool has_raw_infos_ = false;                            // that are not used to rectify
  std::shared_ptr<const StereoCalibration> calibration_;  // null if the images are rectified
  Info calibrated_left_, calibrated_right_;               // that it is from
  std::string camera_error_;
  TopicStatistics pairs_;
};

}  // namespace rotrocc
