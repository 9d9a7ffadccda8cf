#include "rotrocc/trajectory.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <locale>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "files/image_times.h"
#include "files/text_file.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kKittiPeriod_ns = 100'000'000;

/// Numbers of a pose: KITTI, a 4x4 matrix, KITTI with a time, ASL, TUM.
constexpr std::size_t kColumns[] = {12, 16, 13, 17, 8};

std::size_t columnsOf(const TextLine& line) {
  const auto* found = std::find(std::begin(kColumns), std::end(kColumns), line.words.size());
  if (found != std::end(kColumns)) return *found;
  line.fail(
      cv::format("%zu numbers, but a pose has 12 or 16 (KITTI), 13 (with a time), 8 (TUM) or "
                 "17 (ASL)",
                 line.words.size()));
}

bool hasTime(std::size_t columns) {
  return columns != 12 && columns != 16;
}

/// The lines without a header.
std::vector<TextLine> readPoseLines(const std::string& path) {
  std::vector<TextLine> lines = readTextLines(path);
  const std::string& first = lines.front().words.front();
  const bool is_header = first.find_first_of("0123456789") == std::string::npos;
  if (is_header) lines.erase(lines.begin());
  if (lines.empty()) throw std::runtime_error(path + " has no poses");
  return lines;
}

Eigen::Isometry3d matrixPose(const TextLine& line, std::size_t first) {
  Eigen::Matrix<double, 3, 4> matrix;
  for (int i = 0; i < matrix.size(); ++i) {
    matrix(i / 4, i % 4) = line.number(first + static_cast<std::size_t>(i));
  }
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  if (const auto why = whyNoRotation(rotation)) {
    line.fail("the left 3x3 part is not a rotation: it is " + *why);
  }
  Eigen::Isometry3d pose(Eigen::Quaterniond(rotation).normalized());
  pose.translation() = matrix.col(3);
  return pose;
}

/// Files of ASL have commas and times in nanoseconds, and quaternions begin with w.
Eigen::Isometry3d poseOf(const TextLine& line, std::size_t columns, std::int64_t unit_ns) {
  if (columns == 8 || columns == 17) {
    return line.quaternionPose(columns == 17 || (line.has_commas && unit_ns == 1));
  }
  return matrixPose(line, columns == 13 ? 1 : 0);
}

}  // namespace

TrajectoryFormat trajectoryFormat(const std::string& name) {
  if (name == "kitti") return TrajectoryFormat::kKitti;
  if (name == "tum") return TrajectoryFormat::kTum;
  throw std::invalid_argument("trajectory format '" + name + "' is unknown: use kitti or tum");
}

TrajectoryFormat detectTrajectoryFormat(const std::string& path) {
  const bool has_time = hasTime(columnsOf(readPoseLines(path).front()));
  return has_time ? TrajectoryFormat::kTum : TrajectoryFormat::kKitti;
}

Trajectory readTrajectory(const std::string& path) {
  const std::vector<TextLine> lines = readPoseLines(path);
  const std::size_t columns = columnsOf(lines.front());
  Trajectory trajectory;
  trajectory.reserve(lines.size());
  const std::int64_t unit_ns = timeUnit_ns(lines, columns == 17 ? 1 : kSecond_ns);
  for (const TextLine& line : lines) {
    if (line.words.size() != columns) {
      line.fail(cv::format("%zu numbers, but %zu were expected", line.words.size(), columns));
    }
    auto stamp_ns = static_cast<std::int64_t>(trajectory.size()) * kKittiPeriod_ns;
    if (hasTime(columns)) {
      stamp_ns = line.nanoseconds(0, unit_ns);
      if (!trajectory.empty()) line.requireLater(stamp_ns, trajectory.back().stamp_ns);
    }
    trajectory.push_back({stamp_ns, poseOf(line, columns, unit_ns)});
  }
  return trajectory;
}

TrajectoryWriter::TrajectoryWriter(const std::string& path,
                                   TrajectoryFormat format,
                                   const std::string& body)
    : path_(path), format_(format), file_(path) {
  if (!file_) throw std::runtime_error("cannot write " + path_);
  file_.imbue(std::locale::classic());  // no decimal comma
  file_.precision(9);
  if (body.empty() || format_ == TrajectoryFormat::kKitti) return;
  file_ << "# poses of " << body << ": time [s], position [m], quaternion x y z w" << std::endl;
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
