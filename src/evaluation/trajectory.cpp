#include "rotrocc/trajectory.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <locale>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "evaluation/image_times.h"
#include "evaluation/text_file.h"

namespace rotrocc {
namespace {

constexpr std::size_t kKittiNumbers = 12;
constexpr std::size_t kTumNumbers = 8;
constexpr std::int64_t kKittiPeriod_ns = 100'000'000;

TrajectoryFormat formatOf(const TextLine& line) {
  if (line.words.size() == kKittiNumbers) return TrajectoryFormat::kKitti;
  if (line.words.size() == kTumNumbers) return TrajectoryFormat::kTum;
  line.fail(cv::format("%zu numbers, but a pose has 12 (KITTI) or 8 (TUM)", line.words.size()));
}

void requireCount(const TextLine& line, std::size_t count) {
  if (line.words.size() == count) return;
  line.fail(cv::format("%zu numbers, but %zu were expected", line.words.size(), count));
}

Eigen::Isometry3d kittiPose(const TextLine& line) {
  Eigen::Matrix<double, 3, 4> matrix;
  for (int i = 0; i < matrix.size(); ++i) matrix(i / 4, i % 4) = line.number(i);
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  if (const auto why = whyNoRotation(rotation)) {
    line.fail("the left 3x3 part is not a rotation: it is " + *why);
  }
  Eigen::Isometry3d pose(Eigen::Quaterniond(rotation).normalized());
  pose.translation() = matrix.col(3);
  return pose;
}

/// The first number of a line [s].
std::int64_t timeAfter(std::int64_t previous_ns, const TextLine& line) {
  const std::int64_t stamp_ns = line.nanoseconds(0, kSecond_ns);
  line.requireLater(stamp_ns, previous_ns);
  return stamp_ns;
}

}  // namespace

TrajectoryFormat trajectoryFormat(const std::string& name) {
  if (name == "kitti") return TrajectoryFormat::kKitti;
  if (name == "tum") return TrajectoryFormat::kTum;
  throw std::invalid_argument("trajectory format '" + name + "' is unknown: use kitti or tum");
}

TrajectoryFormat detectTrajectoryFormat(const std::string& path) {
  return formatOf(readTextLines(path).front());
}

Trajectory readTrajectory(const std::string& path) {
  const std::vector<TextLine> lines = readTextLines(path);
  const bool is_tum = formatOf(lines.front()) == TrajectoryFormat::kTum;
  Trajectory trajectory;
  trajectory.reserve(lines.size());
  std::int64_t stamp_ns = is_tum ? INT64_MIN : -kKittiPeriod_ns;
  for (const TextLine& line : lines) {
    requireCount(line, is_tum ? kTumNumbers : kKittiNumbers);
    stamp_ns = is_tum ? timeAfter(stamp_ns, line) : stamp_ns + kKittiPeriod_ns;
    trajectory.push_back({stamp_ns, is_tum ? line.quaternionPose(false) : kittiPose(line)});
  }
  return trajectory;
}

Trajectory::const_iterator firstFrom(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const auto is_before = [](const StampedPose& pose, std::int64_t ns) {
    return pose.stamp_ns < ns;
  };
  return std::lower_bound(trajectory.begin(), trajectory.end(), stamp_ns, is_before);
}

std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory,
                                        std::int64_t stamp_ns,
                                        std::int64_t max_gap_ns) {
  const auto after = firstFrom(trajectory, stamp_ns);
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->T_world_body;
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  if (after->stamp_ns - before.stamp_ns > max_gap_ns) return std::nullopt;

  const double share = static_cast<double>(stamp_ns - before.stamp_ns) /
                       static_cast<double>(after->stamp_ns - before.stamp_ns);
  const Eigen::Quaterniond from(before.T_world_body.linear());
  const Eigen::Quaterniond to(after->T_world_body.linear());
  Eigen::Isometry3d pose(from.slerp(share, to));
  pose.translation() =
      (1.0 - share) * before.T_world_body.translation() + share * after->T_world_body.translation();
  return pose;
}

Trajectory samplePoses(const Trajectory& trajectory, const std::vector<std::int64_t>& stamps_ns) {
  constexpr std::int64_t kMaxGap_ns = 100'000'000;
  Trajectory samples;
  for (const std::int64_t stamp_ns : stamps_ns) {
    if (const auto pose = poseAt(trajectory, stamp_ns, kMaxGap_ns)) {
      samples.push_back({stamp_ns, *pose});
    }
  }
  return samples;
}

TrajectoryWriter::TrajectoryWriter(const std::string& path, TrajectoryFormat format)
    : path_(path), format_(format), file_(path) {
  if (!file_) throw std::runtime_error("cannot write " + path_);
  file_.imbue(std::locale::classic());  // no decimal comma
  file_.precision(9);
}

void TrajectoryWriter::write(const StampedPose& pose) {
  static const Eigen::IOFormat kInOneLine(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", " ");
  if (format_ == TrajectoryFormat::kKitti) {
    file_ << std::scientific << pose.T_world_body.affine().format(kInOneLine) << std::endl;
  } else {
    Eigen::Quaterniond quaternion(pose.T_world_body.linear());
    quaternion.normalize();
    if (quaternion.w() < 0.0) quaternion.coeffs() *= -1.0;
    file_ << cv::format("%s%lld.%09lld ",
                        pose.stamp_ns < 0 ? "-" : "",
                        std::llabs(pose.stamp_ns / kSecond_ns),
                        std::llabs(pose.stamp_ns % kSecond_ns))
          << std::fixed << pose.T_world_body.translation().transpose().format(kInOneLine) << ' '
          << quaternion.coeffs().transpose().format(kInOneLine) << std::endl;  // x y z w
  }
  if (!file_) throw std::runtime_error("cannot write to " + path_ + ": is the disk full?");
}

}  // namespace rotrocc
