#include "tools/odometry_outputs.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <numeric>
#include <stdexcept>

#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/median.h"
#include "evaluation/image_file.h"
#include "input/message_conversion.h"
#include "node/base/base_odometry.h"
#include "node/odometry_messages.h"
#include "rotrocc/flow_picture.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

std::size_t countState(const std::vector<PairRecord>& records, State state) {
  return std::count_if(records.begin(), records.end(), [state](const PairRecord& record) {
    return record.result.state == state;
  });
}

void printTimes(std::ostream& out,
                const char* name,
                const std::vector<PairRecord>& records,
                const std::function<double(const PairRecord&)>& time_ms) {
  std::vector<double> values;
  for (const PairRecord& record : records) values.push_back(time_ms(record));
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  out << cv::format("%-16s %8.2f %8.2f %8.2f %8.2f\n",
                    name,
                    mean,
                    quantile(values, 0.5),
                    quantile(values, 0.95),
                    quantile(values, 0.99));
}

std::string statisticsColumns() {
  std::string names =
      "stamp_ns,state,dt_s,tries,corners,with_depth,tracked,consistent,rotation_inliers,"
      "translation_inliers,pyramids_ms,corners_ms,disparity_ms,tracking_ms,estimation_ms,"
      "prepared_ms,wall_ms,cpu_ms,keyframe_stamp_ns,bias_estimated_px,bias_sigma_px,"
      "bias_applied_px,row_offset_px,row_offset_sigma_px,row_difference_px,"
      "row_offset_applied_px,exposure_gain,"
      "flow_noise_px,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad";
  constexpr const char* kAxes[] = {"x", "y", "z", "rx", "ry", "rz"};
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) names += std::string(",covariance_") + kAxes[i] + '_' + kAxes[j];
  }
  return names;
}

/// The motion has its rotation as axis times angle, and the upper triangle of its covariance, row
/// by row.
void writeStatistics(const PairRecord& record, CsvFile& file) {
  const OdometryResult& result = record.result;
  const StageCounts& counts = result.counts;
  const StageTimes& times = result.times;
  file << result.stamp_ns << toString(result.state) << result.dt_s() << counts.tries
       << counts.corners << counts.with_depth << counts.tracked << counts.consistent
       << counts.rotation_inliers << counts.translation_inliers << times.pyramids_ms
       << times.corners_ms << times.disparity_ms << times.tracking_ms << times.estimation_ms
       << times.prepared_ms << record.wall_ms << record.cpu_ms << result.keyframe_stamp_ns
       << result.disparity_bias.estimated_px << result.disparity_bias.sigma_px
       << result.disparity_bias.applied_px << result.row_offset.median_px
       << result.row_offset.sigma_px << result.row_offset.typical_px << result.row_offset.applied_px
       << result.exposure_gain << result.flow_noise_px;
  Vector6d motion;
  motion << result.T_prev_cur.translation(), logRotation(result.T_prev_cur.linear());
  for (int i = 0; i < 6; ++i) file << motion[i];
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) file << result.covariance(i, j);
  }
  file.endRow();
}

}  // namespace

class OdometryOutputs::OdometryBag {
 public:
  OdometryBag(const std::string& path, const Recording& recording, const Parameters& parameters)
      : parameters_(parameters.node),
        offset_ns_(recording.offset_ns()),
        T_base_camera_(recording.T_base_camera()),
        systematic_error_(parameters.odometry.systematic_error) {
    restart();
    if (const std::string note = recording.mountNote(); !note.empty()) {
      std::cerr << "offline_odometry: " << note << '\n';
    }
    try {
      bag_.open(path, rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error(path + " cannot be written: " + error.what());
    }
  }

  void restart() { odometry_.emplace(parameters_, systematic_error_); }

  void write(const OdometryResult& result) {
    BaseState state = odometry_->add(result, {T_base_camera_});
    state.stamp_ns += offset_ns_;
    const ros::Time stamp = toRosTime(state.stamp_ns);
    const std::string& odom = parameters_.odom_frame;
    const std::string& base = parameters_.base_frame;
    tf2_msgs::TFMessage tf;
    const Eigen::Isometry3d& T = state.T_odom_base.T;
    tf.transforms.push_back(parameters_.invert_tf
                                ? toTransform(T.inverse(), state.stamp_ns, base, odom)
                                : toTransform(T, state.stamp_ns, odom, base));
    bag_.write("/tf", stamp, tf);
    bag_.write("/stereo/odom", stamp, toOdometry(state, odom, base));
  }

 private:
  NodeParameters parameters_;
  std::int64_t offset_ns_;
  Eigen::Isometry3d T_base_camera_;
  SystematicErrorConfig systematic_error_;
  std::optional<BaseOdometry> odometry_;
  rosbag::Bag bag_;
};

OdometryOutputs::OdometryOutputs(const OutputFiles& files,
                                 const Recording& recording,
                                 const Parameters& parameters)
    : trajectory_(files.trajectory, trajectoryFormat(files.format)) {
  if (!files.statistics.empty()) statistics_.emplace(files.statistics, statisticsColumns());
  if (!files.bag.empty()) bag_ = std::make_unique<OdometryBag>(files.bag, recording, parameters);
  if (!files.pictures.empty()) pictures_.emplace(files.pictures);
}

OdometryOutputs::~OdometryOutputs() = default;

void OdometryOutputs::restart() {
  accumulator_ = {};
  if (bag_) bag_->restart();
}

void OdometryOutputs::write(const PairRecord& record,
                            const StereoPair& pair,
                            const StereoCamera& camera,
                            const VisualOdometry& odometry) {
  trajectory_.write({pair.stamp_ns, accumulator_.add(record.result.T_prev_cur)});
  if (statistics_) writeStatistics(record, *statistics_);
  if (bag_) bag_->write(record.result);
  if (pictures_) {
    drawFlowPicture({pair,
                     camera,
                     odometry.correspondences(),
                     odometry.rotationInliers(),
                     odometry.translationInliers(),
                     record.result},
                    picture_);
    writeImage(pictures_->path(cv::format("%06zu.png", records_.size())), picture_);
  }
  records_.push_back(record);
}

void OdometryOutputs::printSummary(std::ostream& out) const {
  out << records_.size() << " pairs: " << countState(records_, State::kOk) << " ok, "
      << countState(records_, State::kDegraded) << " degraded, "
      << countState(records_, State::kLost) << " lost, "
      << countState(records_, State::kInitialising) << " initialising\n";
  if (records_.empty()) return;
  for (const State state : {State::kLost, State::kDegraded, State::kInitialising}) {
    const auto first = std::find_if(records_.begin() + 1, records_.end(), [&](const auto& record) {
      return record.result.state == state;
    });
    if (first == records_.end()) continue;
    out << "first " << toString(state) << ", pair " << first - records_.begin() << ": "
        << first->result.reason << '\n';
  }
  out << "ms per pair          mean   median      p95      p99\n";
  printTimes(out, "wall", records_, [](const PairRecord& record) { return record.wall_ms; });
  printTimes(out, "cpu", records_, [](const PairRecord& record) { return record.cpu_ms; });
  for (const auto& [name, time_ms] : {std::pair{"latency", &StageTimes::total_ms},
                                      {"  pyramids", &StageTimes::pyramids_ms},
                                      {"  corners", &StageTimes::corners_ms},
                                      {"  disparity", &StageTimes::disparity_ms},
                                      {"  tracking", &StageTimes::tracking_ms},
                                      {"  estimation", &StageTimes::estimation_ms}}) {
    printTimes(out, name, records_, [stage = time_ms](const PairRecord& record) {
      return record.result.times.*stage;
    });
  }
}

}  // namespace rotrocc
