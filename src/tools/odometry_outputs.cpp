#include "tools/odometry_outputs.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "common/median.h"
#include "files/image_file.h"
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
      "row_offset_applied_px,right_delay_s,right_delay_sigma_s,"
      "right_delay_applied_s,contrast_gain,"
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
       << result.right_delay.estimated_s << result.right_delay.sigma_s
       << result.right_delay.applied_s << result.contrast_gain << result.flow_noise_px;
  Vector6d motion;
  motion << result.T_prev_cur.translation(), logRotation(result.T_prev_cur.linear());
  for (int i = 0; i < 6; ++i) file << motion[i];
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) file << result.covariance(i, j);
  }
  file.endRow();
}

}  // namespace

namespace {

/// The camera on the base.
Eigen::Isometry3d mountOf(const OutputFiles& files, const Recording& recording) {
  if (files.mount.empty()) {
    if (const std::string note = recording.mountNote(); !note.empty()) {
      std::cerr << "offline_odometry: " << note << '\n';
    }
    return recording.T_base_camera();
  }
  std::istringstream text(files.mount);
  using Numbers = std::istream_iterator<double>;
  const std::vector<double> m{Numbers(text), Numbers()};
  const Eigen::Quaterniond rotation = m.size() == 7 && text.eof()
                                          ? Eigen::Quaterniond(m[6], m[3], m[4], m[5])
                                          : Eigen::Quaterniond(0, 0, 0, 0);
  if (!(std::abs(rotation.norm() - 1.0) < 0.01)) {
    throw std::invalid_argument(
        "--mount is not \"x y z qx qy qz qw\" with a quaternion of length 1");
  }
  return Eigen::Translation3d(m[0], m[1], m[2]) * rotation.normalized();
}

/// The camera on the base whose poses are written; nothing if these are its own.
std::optional<Eigen::Isometry3d> bodyOf(const OutputFiles& files, const Recording& recording) {
  if (files.frame == "base") return mountOf(files, recording);
  if (files.frame != "camera") {
    throw std::invalid_argument("--frame is '" + files.frame + "', not camera or base");
  }
  if (!files.mount.empty() && files.bag.empty()) {
    throw std::invalid_argument("--mount is for --frame base or --bag");
  }
  return std::nullopt;
}

}  // namespace

class OdometryOutputs::OdometryBag {
 public:
  OdometryBag(const OutputFiles& files, const Recording& recording, const Parameters& parameters)
      : parameters_(parameters.node),
        offset_ns_(recording.offset_ns()),
        T_base_camera_(mountOf(files, recording)),
        systematic_error_(parameters.odometry.systematic_error) {
    restart();
    try {
      bag_.open(files.bag, rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error(files.bag + " cannot be written: " + error.what());
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
    : T_body_camera_(bodyOf(files, recording)),
      trajectory_(files.trajectory,
                  trajectoryFormat(files.format),
                  files.frame == "base" ? parameters.node.base_frame : "the left camera") {
  if (!files.statistics.empty()) statistics_.emplace(files.statistics, statisticsColumns());
  if (!files.bag.empty()) bag_ = std::make_unique<OdometryBag>(files, recording, parameters);
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
  const Eigen::Isometry3d& T_first_cur = accumulator_.add(record.result.T_prev_cur);
  trajectory_.write(
      {pair.stamp_ns,
       T_body_camera_ ? *T_body_camera_ * T_first_cur * T_body_camera_->inverse() : T_first_cur});
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
      << countState(records_, State::kInitializing) << " initializing\n";
  if (records_.empty()) return;
  for (const State state : {State::kLost, State::kDegraded, State::kInitializing}) {
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

void OdometryOutputs::requireMotion() const {
  // Reasons that differ in numbers only are one; the first of each is reported.
  std::map<std::string, std::pair<std::size_t, std::string>> reasons;
  const std::pair<std::size_t, std::string>* commonest = nullptr;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const OdometryResult& result = records_[i].result;
    if (result.hasMotion()) return;
    if (i == 0 && records_.size() > 1) continue;  // there is none from the first pair
    std::string kind = result.reason;
    kind.erase(
        std::remove_if(kind.begin(),
                       kind.end(),
                       [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }),
        kind.end());
    auto& [count, reason] = reasons.try_emplace(kind, 0, result.reason).first->second;
    if (++count; commonest == nullptr || count > commonest->first) commonest = &reasons[kind];
  }
  if (commonest == nullptr) return;
  throw std::runtime_error("no pair has a motion: " + commonest->second +
                           cv::format(" (%zu of %zu pairs)", commonest->first, records_.size()));
}

}  // namespace rotrocc
