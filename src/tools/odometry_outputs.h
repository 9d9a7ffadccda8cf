#pragma once

#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "bags/recording.h"
#include "files/csv_file.h"
#include "files/report_directory.h"
#include "rotrocc/parameters.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

struct PairRecord {
  OdometryResult result;
  double wall_ms = 0.0;  ///< of VisualOdometry::prepare() and process()
  double cpu_ms = 0.0;   ///< all threads of the process
};

/// Those that are empty are not written, but for the trajectory.
struct OutputFiles {
  std::string trajectory;        ///< poses of the left camera, or of the base
  std::string format = "kitti";  ///< of the trajectory: kitti or tum
  std::string frame = "camera";  ///< or base: whose poses these are, relative to the first one
  std::string mount;             ///< of the camera on the base: x y z qx qy qz qw; empty: recorded
  std::string statistics;        ///< CSV table with one row per pair
  std::string bag;       ///< with the messages that the node would publish for each pair, by
                         ///< stamp: /stereo/odom, /tf odom_frame -> base_frame
  std::string pictures;  ///< folder for flow pictures: 000000.png, 000001.png and so on
};

/// Writes the results of a run, pair by pair.
class OdometryOutputs {
 public:
  /// Throws std::runtime_error if a file or folder cannot be written, and std::invalid_argument on
  /// an unknown format.
  OdometryOutputs(const OutputFiles& files,
                  const Recording& recording,
                  const Parameters& parameters);
  ~OdometryOutputs();

  /// The next pair is at the initial pose.
  void restart();

  /// `record` is of the last call of odometry.process(), with input `pair` and `camera`. Throws
  /// std::runtime_error if writing fails.
  void write(const PairRecord& record,
             const StereoPair& pair,
             const StereoCamera& camera,
             const VisualOdometry& odometry);

  /// Pairs by state, and mean, median, 95th and 99th percentile of the times.
  void printSummary(std::ostream& out) const;

  /// Throws std::runtime_error with the commonest reason if no pair has a motion.
  void requireMotion() const;

 private:
  class OdometryBag;

  PoseAccumulator accumulator_;
  std::optional<Eigen::Isometry3d> T_body_camera_;  // unless the trajectory is of the camera
  TrajectoryWriter trajectory_;
  std::vector<PairRecord> records_;
  std::optional<CsvFile> statistics_;
  std::unique_ptr<OdometryBag> bag_;
  std::optional<ReportDirectory> pictures_;
  cv::Mat picture_;
};

}  // namespace rotrocc
