#include "tools/run_statistics.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <numeric>

#include "common/median.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

struct Stage {
  const char* name;
  double StageTimes::*time_ms;
};

constexpr Stage kStages[] = {{"  pyramids", &StageTimes::pyramids_ms},
                             {"  corners", &StageTimes::corners_ms},
                             {"  disparity", &StageTimes::disparity_ms},
                             {"  tracking", &StageTimes::tracking_ms},
                             {"  estimation", &StageTimes::estimation_ms}};

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
  char line[80];
  std::snprintf(line,
                sizeof(line),
                "%-16s %8.2f %8.2f %8.2f %8.2f\n",
                name,
                mean,
                quantile(values, 0.5),
                quantile(values, 0.95),
                quantile(values, 0.99));
  out << line;
}

/// The columns of a file of statistics.
std::string columns() {
  std::string names =
      "stamp_ns,state,dt_s,tries,corners,with_depth,tracked,consistent,rotation_inliers,"
      "translation_inliers,pyramids_ms,corners_ms,disparity_ms,tracking_ms,estimation_ms,"
      "prepared_ms,wall_ms,cpu_ms,keyframe_stamp_ns,bias_estimated_px,bias_sigma_px,"
      "bias_applied_px,row_offset_px,row_offset_sigma_px,row_difference_px,"
      "row_offset_applied_px,exposure_gain,shared_error_ratio,"
      "flow_noise_px,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad";
  constexpr const char* kAxes[] = {"x", "y", "z", "rx", "ry", "rz"};
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) names += std::string(",covariance_") + kAxes[i] + '_' + kAxes[j];
  }
  return names;
}

}  // namespace

StatisticsFile::StatisticsFile(const std::string& path) : file_(path, columns()) {}

void StatisticsFile::write(const PairRecord& record) {
  const OdometryResult& result = record.result;
  const StageCounts& counts = result.counts;
  const StageTimes& times = result.times;
  file_ << result.stamp_ns << toString(result.state) << result.dt_s << counts.tries
        << counts.corners << counts.with_depth << counts.tracked << counts.consistent
        << counts.rotation_inliers << counts.translation_inliers << times.pyramids_ms
        << times.corners_ms << times.disparity_ms << times.tracking_ms << times.estimation_ms
        << times.prepared_ms << record.wall_ms << record.cpu_ms << result.keyframe_stamp_ns
        << result.disparity_bias.estimated_px << result.disparity_bias.sigma_px
        << result.disparity_bias.applied_px << result.row_offset.median_px
        << result.row_offset.sigma_px << result.row_offset.typical_px
        << result.row_offset.applied_px << result.exposure_gain << result.shared_error_ratio
        << result.flow_noise_px;
  const Eigen::Vector3d rotation = logRotation(result.T_prev_cur.linear());
  for (const double value : result.T_prev_cur.translation()) file_ << value;
  for (const double value : rotation) file_ << value;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) file_ << result.covariance(i, j);
  }
  file_.endRow();
}

void printSummary(std::ostream& out, const std::vector<PairRecord>& records) {
  out << records.size() << " pairs: " << countState(records, State::kOk) << " ok, "
      << countState(records, State::kDegraded) << " degraded, " << countState(records, State::kLost)
      << " lost, " << countState(records, State::kInitialising) << " initialising\n";
  if (records.empty()) return;
  out << "ms per pair          mean   median      p95      p99\n";
  printTimes(out, "wall", records, [](const PairRecord& record) { return record.wall_ms; });
  printTimes(out, "cpu", records, [](const PairRecord& record) { return record.cpu_ms; });
  printTimes(out, "latency", records, [](const PairRecord& record) {
    return record.result.times.total_ms;
  });
  for (const Stage& stage : kStages) {
    printTimes(out, stage.name, records, [&stage](const PairRecord& record) {
      return record.result.times.*stage.time_ms;
    });
  }
}

}  // namespace rotrocc
