#include "rotrocc/kitti.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <Eigen/Core>

#include "evaluation/image_file.h"
#include "evaluation/text_file.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;
using Projection = Eigen::Matrix<double, 3, 4>;

std::size_t countImages(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw std::runtime_error(folder.string() + " is missing: is this a KITTI odometry sequence?");
  }
  const auto is_image = [](const auto& entry) { return entry.path().extension() == ".png"; };
  return std::count_if(fs::directory_iterator(folder), {}, is_image);
}

void requireSameCount(const std::string& what, std::size_t count, std::size_t times) {
  if (count == times) return;
  throw std::runtime_error(
      what + cv::format(" has %zu entries, but times.txt has %zu times", count, times));
}

Projection findProjection(const std::vector<TextLine>& lines,
                          const std::string& name,
                          const std::string& path) {
  for (const TextLine& line : lines) {
    if (line.words.front() != name) continue;
    if (line.words.size() != 13) {
      line.fail(name + cv::format(" has %zu numbers instead of 12", line.words.size() - 1));
    }
    Projection projection;
    for (int i = 0; i < 12; ++i) projection(i / 4, i % 4) = line.number(i + 1);
    return projection;
  }
  throw std::runtime_error(path + " has no line '" + name + " ...'");
}

// Cameras are rectified as a pair if they share focal lengths and rows.
StereoCamera readCalibration(const std::string& path, const cv::Size& size) {
  const std::vector<TextLine> lines = readTextLines(path);
  const Projection left = findProjection(lines, "P0:", path);
  const Projection right = findProjection(lines, "P1:", path);
  const double difference = (left.middleCols<2>(0) - right.middleCols<2>(0)).cwiseAbs().maxCoeff() +
                            (left.col(2) - right.col(2)).tail<2>().cwiseAbs().maxCoeff();
  if (difference > 1e-6 * std::abs(left(0, 0))) {
    throw std::runtime_error(
        path +
        cv::format(": P0 and P1 are not a rectified pair: they differ by %.2g in fx, fy or cy",
                   difference));
  }
  StereoCamera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = left(0, 0);
  camera.fy = left(1, 1);
  camera.cx = left(0, 2);
  camera.cy = left(1, 2);
  camera.cx_right = right(0, 2);
  camera.baseline_m = (left(0, 3) - right(0, 3)) / camera.fx;
  try {
    camera.check();
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  return camera;
}

/// One pose for each stamp.
Trajectory readGroundTruth(const std::string& path, const std::vector<std::int64_t>& stamps_ns) {
  const bool has_stamps = detectTrajectoryFormat(path) == TrajectoryFormat::kTum;
  Trajectory poses = readTrajectory(path);
  if (has_stamps) poses = samplePoses(poses, stamps_ns);
  requireSameCount(path + (has_stamps ? ", interpolated," : ""), poses.size(), stamps_ns.size());
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].stamp_ns = stamps_ns[i];
  return poses;
}

}  // namespace

KittiSequence::KittiSequence(const std::string& directory, bool being_written)
    : directory_(directory) {
  const fs::path root(directory);
  if (!fs::is_directory(root)) throw std::runtime_error(directory + " is not a directory");
  stamps_ns_ = readTimes((root / "times.txt").string());
  for (const char* folder : {"image_0", "image_1"}) {
    const std::size_t count = countImages(root / folder);
    if (being_written && count < stamps_ns_.size()) continue;
    requireSameCount((root / folder).string(), count, stamps_ns_.size());
  }
  const cv::Mat first = readGreyImage(leftPath(0));
  camera_ = readCalibration((root / "calib.txt").string(), first.size());
  const std::string poses_path = (root / "poses.txt").string();
  if (!fs::exists(poses_path)) return;
  ground_truth_ = readGroundTruth(poses_path, stamps_ns_);
}

std::string KittiSequence::imagePath(const char* folder, int index) const {
  return (fs::path(directory_) / folder / cv::format("%06d.png", index)).string();
}

cv::Mat KittiSequence::read(const std::string& path) const {
  cv::Mat image = readGreyImage(path);
  requireImageSize(path, image, {camera_.width, camera_.height}, "the first image");
  return image;
}

}  // namespace rotrocc
