#include "rotrocc/trajectory.h"

#include <cstdint>
#include <cstdlib>
#include <locale>
#include <stdexcept>

#include <opencv2/core.hpp>

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
  const std::int64_t stamp_ns = line.nanoseconds(0);
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

Trajectory readTrajectory(const std::string& path, const std::string& times_path) {
  const std::vector<TextLine> lines = readTextLines(path);
  const bool is_tum = formatOf(lines.front()) == TrajectoryFormat::kTum;
  if (is_tum && !times_path.empty()) {
    throw std::runtime_error(path + " has stamps (TUM format): the times of " + times_path +
                             " cannot be used with it");
  }
  Trajectory trajectory;
  trajectory.reserve(lines.size());
  std::int64_t stamp_ns = is_tum ? INT64_MIN : -kKittiPeriod_ns;
  for (const TextLine& line : lines) {
    requireCount(line, is_tum ? kTumNumbers : kKittiNumbers);
    stamp_ns = is_tum ? timeAfter(stamp_ns, line) : stamp_ns + kKittiPeriod_ns;
    trajectory.push_back({stamp_ns, is_tum ? line.quaternionPose(false) : kittiPose(line)});
  }
  if (times_path.empty()) return trajectory;
  const std::vector<std::int64_t> stamps_ns = readTimes(times_path);
  if (stamps_ns.size() < trajectory.size()) {
    throw std::runtime_error(times_path + cv::format(" has %zu times, but ", stamps_ns.size()) +
                             path + cv::format(" has %zu poses", trajectory.size()));
  }
  for (std::size_t i = 0; i < trajectory.size(); ++i) trajectory[i].stamp_ns = stamps_ns[i];
  return trajectory;
}

std::vector<std::int64_t> readTimes(const std::string& path) {
  std::vector<std::int64_t> stamps_ns;
  for (const TextLine& line : readTextLines(path)) {
    requireCount(line, 1);
    stamps_ns.push_back(timeAfter(stamps_ns.empty() ? INT64_MIN : stamps_ns.back(), line));
  }
  return stamps_ns;
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
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
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
