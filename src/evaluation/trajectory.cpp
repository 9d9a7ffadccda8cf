#include "rotrocc/trajectory.h"

#include <stdexcept>

#include "evaluation/pose_text.h"
#include "evaluation/text_file.h"

namespace rotrocc {
namespace {

constexpr std::size_t kKittiNumbers = 12;
constexpr std::size_t kTumNumbers = 8;
constexpr std::int64_t kKittiPeriod_ns = 100'000'000;
constexpr double kMaxRoundingError = 1e-3;  // of a rotation printed with four digits or more

TrajectoryFormat formatOf(const TextLine& line) {
  if (line.words.size() == kKittiNumbers) return TrajectoryFormat::kKitti;
  if (line.words.size() == kTumNumbers) return TrajectoryFormat::kTum;
  throw std::runtime_error(line.where + ": " + std::to_string(line.words.size()) +
                           " numbers, but a pose has 12 (KITTI) or 8 (TUM)");
}

void requireCount(const TextLine& line, std::size_t count) {
  if (line.words.size() == count) return;
  throw std::runtime_error(line.where + ": " + std::to_string(line.words.size()) +
                           " numbers, but " + std::to_string(count) + " were expected");
}

Eigen::Isometry3d kittiPose(const TextLine& line) {
  Eigen::Matrix<double, 3, 4> matrix;
  for (int i = 0; i < matrix.size(); ++i) matrix(i / 4, i % 4) = line.number(i);
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const Eigen::Matrix3d deviation = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  const double error = deviation.cwiseAbs().maxCoeff();
  if (error > kMaxRoundingError || rotation.determinant() < 0.0) {
    throw std::runtime_error(line.where + ": the left 3x3 part is not a rotation: it is " +
                             (error > kMaxRoundingError
                                  ? "off orthonormality by " + std::to_string(error)
                                  : std::string("a reflection")));
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  pose.translation() = matrix.col(3);
  return pose;
}

Eigen::Isometry3d tumPose(const TextLine& line) {
  const Eigen::Quaterniond quaternion(
      line.number(7), line.number(4), line.number(5), line.number(6));
  if (!(std::abs(quaternion.norm() - 1.0) < kMaxRoundingError)) {
    throw std::runtime_error(line.where + ": the quaternion has the length " +
                             std::to_string(quaternion.norm()) + " instead of 1");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = quaternion.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(line.number(1), line.number(2), line.number(3));
  return pose;
}

void requireLater(const TextLine& line, std::int64_t stamp_ns, std::int64_t previous_ns) {
  if (stamp_ns > previous_ns) return;
  throw std::runtime_error(line.where + ": the time " + line.words.front() +
                           " s is not later than the one before it");
}

Trajectory readTum(const std::vector<TextLine>& lines) {
  Trajectory trajectory;
  trajectory.reserve(lines.size());
  for (const TextLine& line : lines) {
    requireCount(line, kTumNumbers);
    const std::int64_t stamp_ns = line.nanoseconds(0);
    if (!trajectory.empty()) requireLater(line, stamp_ns, trajectory.back().stamp_ns);
    trajectory.push_back({stamp_ns, tumPose(line)});
  }
  return trajectory;
}

Trajectory readKitti(const std::vector<TextLine>& lines) {
  Trajectory trajectory;
  trajectory.reserve(lines.size());
  for (const TextLine& line : lines) {
    requireCount(line, kKittiNumbers);
    const auto index = static_cast<std::int64_t>(trajectory.size());
    trajectory.push_back({index * kKittiPeriod_ns, kittiPose(line)});
  }
  return trajectory;
}

void setStamps(Trajectory& trajectory, const std::string& path, const std::string& times_path) {
  const std::vector<std::int64_t> stamps_ns = readTimes(times_path);
  if (stamps_ns.size() < trajectory.size()) {
    throw std::runtime_error(times_path + " has " + std::to_string(stamps_ns.size()) +
                             " times, but " + path + " has " + std::to_string(trajectory.size()) +
                             " poses");
  }
  for (std::size_t i = 0; i < trajectory.size(); ++i) trajectory[i].stamp_ns = stamps_ns[i];
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
  if (formatOf(lines.front()) == TrajectoryFormat::kKitti) {
    Trajectory trajectory = readKitti(lines);
    if (!times_path.empty()) setStamps(trajectory, path, times_path);
    return trajectory;
  }
  if (!times_path.empty()) {
    throw std::runtime_error(path + " has stamps (TUM format): the times of " + times_path +
                             " cannot be used with it");
  }
  return readTum(lines);
}

std::vector<std::int64_t> readTimes(const std::string& path) {
  std::vector<std::int64_t> stamps_ns;
  for (const TextLine& line : readTextLines(path)) {
    requireCount(line, 1);
    const std::int64_t stamp_ns = line.nanoseconds(0);
    if (!stamps_ns.empty()) requireLater(line, stamp_ns, stamps_ns.back());
    stamps_ns.push_back(stamp_ns);
  }
  return stamps_ns;
}

TrajectoryWriter::TrajectoryWriter(const std::string& path, TrajectoryFormat format)
    : path_(path), format_(format), file_(path) {
  if (!file_) throw std::runtime_error("cannot write " + path_);
  preparePoseText(file_);
}

void TrajectoryWriter::write(const StampedPose& pose) {
  writePose(pose, format_, file_);
  file_ << std::flush;
  if (!file_) throw std::runtime_error("cannot write to " + path_ + ": is the disk full?");
}

}  // namespace rotrocc
