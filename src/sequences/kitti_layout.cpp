#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "files/text_file.h"
#include "sequences/image_folders.h"
#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;
using Projection = Eigen::Matrix<double, 3, 4>;

/// Names of the images of one pair of cameras, and of their projection matrices.
struct Cameras {
  std::string left, right;
  std::string left_matrix, right_matrix;
};

const Cameras kSequenceCameras[] = {{"image_0", "image_1", "P0:", "P1:"},
                                    {"image_2", "image_3", "P2:", "P3:"}};
const Cameras kRawCameras[] = {{"image_00/data", "image_01/data", "P_rect_00:", "P_rect_01:"},
                               {"image_02/data", "image_03/data", "P_rect_02:", "P_rect_03:"}};

/// The gray cameras, unless there are only the color ones.
template <std::size_t kPairs>
const Cameras& camerasIn(const std::string& directory, const Cameras (&cameras)[kPairs]) {
  for (const Cameras& pair : cameras) {
    if (fs::exists(directory + "/" + pair.left) || fs::exists(directory + "/" + pair.right)) {
      return pair;
    }
  }
  return cameras[0];
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

/// Cameras are rectified as a pair if they share focal lengths and rows.
StereoCamera readCalibration(const std::string& path, const Cameras& names, const cv::Size& size) {
  const std::vector<TextLine> lines = readTextLines(path);
  const Projection left = findProjection(lines, names.left_matrix, path);
  const Projection right = findProjection(lines, names.right_matrix, path);
  const double difference = (left.middleCols<2>(0) - right.middleCols<2>(0)).cwiseAbs().maxCoeff() +
                            (left.col(2) - right.col(2)).tail<2>().cwiseAbs().maxCoeff();
  if (difference > 1e-6 * std::abs(left(0, 0))) {
    throw std::runtime_error(path + ": " + names.left_matrix + " and " + names.right_matrix +
                             cv::format(" are not a rectified pair: they differ by %.2g in fx, fy "
                                        "or cy",
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

/// The size is that of the first left image.
StereoCalibration calibrationFrom(const std::string& path,
                                  const Cameras& names,
                                  const ImagePairs& pairs,
                                  const SequenceOptions& options) {
  return calibrationOf(options, pairs, [&] {
    return rectifiedCalibration(readCalibration(path, names, sizeOf(pairs)));
  });
}

/// Raw drives that are not rectified have larger images.
void requireRectified(const std::string& path, const cv::Size& size) {
  for (const TextLine& line : readTextLines(path)) {
    if (line.words.front().rfind("S_rect_", 0) != 0 || line.words.size() != 3) continue;
    if (line.number(1) == size.width && line.number(2) == size.height) return;
    line.fail(
        cv::format("rectified images are %g x %g px, but these are %d x %d px: take the drive "
                   "that is synced and rectified",
                   line.number(1),
                   line.number(2),
                   size.width,
                   size.height));
  }
}

/// With stamps around those of the pairs, or one pose for each time.
Trajectory readGroundTruth(const std::string& path,
                           const std::vector<std::int64_t>& times_ns,
                           const ImagePairs& pairs) {
  if (!fs::exists(path)) return {};
  const bool has_stamps = detectTrajectoryFormat(path) == TrajectoryFormat::kTum;
  Trajectory poses = readTrajectory(path);
  if (!has_stamps) {
    if (poses.size() != times_ns.size()) {
      throw std::runtime_error(path + cv::format(" has %zu entries, but times.txt has %zu times",
                                                 poses.size(),
                                                 times_ns.size()));
    }
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].stamp_ns = times_ns[i];
  }
  return samplePoses(poses, pairs.stamps_ns());
}

/// As another program writes them, the right one last.
ImagePairs pairsByNumber(const std::string& directory,
                         const Cameras& names,
                         const std::vector<std::int64_t>& times_ns) {
  std::vector<ImagePairs::Pair> pairs;
  for (const std::int64_t stamp_ns : times_ns) {
    const std::string name = cv::format("/%06zu.png", pairs.size());
    pairs.push_back({{stamp_ns, directory + "/" + names.left + name},
                     {stamp_ns, directory + "/" + names.right + name}});
  }
  return {std::move(pairs), times_ns.size(), times_ns.size()};
}

}  // namespace

std::optional<StereoSequence> readKittiLayout(const std::string& directory,
                                              const SequenceOptions& options) {
  const Cameras& names = camerasIn(directory, kSequenceCameras);
  const auto has = [&](const std::string& part) { return fs::exists(directory + "/" + part); };
  if (!(has(names.left) || has(names.right) || has("calib.txt") || has("times.txt"))) {
    return std::nullopt;
  }
  const std::string times = directory + "/times.txt";
  const std::vector<std::int64_t> times_ns = readTimes(times);
  ImagePairs pairs = pairsByNumber(directory, names, times_ns);
  const bool is_incomplete =
      fs::exists(pairs.pair(0).left.path) && !pairs.hasFiles(pairs.size() - 1);
  if (!(options.being_written && is_incomplete)) {
    pairs = pairFolders(directory + "/" + names.left,
                        directory + "/" + names.right,
                        times,
                        options.max_stamp_difference_s);
  }
  const StereoCalibration calibration =
      calibrationFrom(directory + "/calib.txt", names, pairs, options);
  const Trajectory truth = readGroundTruth(directory + "/poses.txt", times_ns, pairs);
  return StereoSequence{directory, std::move(pairs), calibration, truth, kittiMount()};
}

std::optional<StereoSequence> readKittiRawLayout(const std::string& directory,
                                                 const SequenceOptions& options) {
  const Cameras& names = camerasIn(directory, kRawCameras);
  if (!fs::exists(directory + "/" + names.left)) return std::nullopt;
  const std::string file = "calib_cam_to_cam.txt";
  const std::string beside = (fs::path(directory) / file).string();
  const std::string above = (fs::path(directory) / ".." / file).string();
  const std::string times = (fs::path(directory) / names.left).parent_path() / "timestamps.txt";
  if (!fs::exists(times)) throw std::runtime_error(times + " is missing: it has a time per image");
  ImagePairs pairs = pairFolders(directory + "/" + names.left,
                                 directory + "/" + names.right,
                                 times,
                                 options.max_stamp_difference_s);
  const std::string calibration_path = fs::exists(beside) ? beside : above;
  if (options.calibration.empty()) requireRectified(calibration_path, sizeOf(pairs));
  const StereoCalibration calibration = calibrationFrom(calibration_path, names, pairs, options);
  return StereoSequence{directory, std::move(pairs), calibration, {}, kittiMount()};
}

}  // namespace rotrocc
