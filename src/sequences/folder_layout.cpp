#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/text_file.h"
#include "sequences/calibration_file.h"
#include "sequences/kitti_mount.h"
#include "sequences/layouts.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> listImages(const fs::path& folder) {
  static const std::set<std::string> kExtensions = {
      ".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm", ".ppm"};
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + " is missing");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (kExtensions.count(entry.path().extension()) > 0) files.push_back(entry.path());
  }
  if (files.empty()) throw std::runtime_error(folder.string() + " has no images");
  std::sort(files.begin(), files.end());
  return files;
}

/// The time that is the name of an image.
std::int64_t stampOf(const fs::path& file) {
  const std::string name = file.stem().string();
  const TextLine line = {file.string(), {name}};
  constexpr std::size_t kDigitsOfNanoseconds = 16;  // since 1970, after three months
  const bool is_number = name.find_first_not_of("0123456789.") == std::string::npos;
  const bool has_dot = name.find('.') != std::string::npos;
  if (!is_number || (!has_dot && name.size() < kDigitsOfNanoseconds)) {
    throw std::runtime_error(file.string() +
                             " is not named by its time, e.g. 1403636579763555584.png [ns] or "
                             "1403636579.763556.png [s]: "
                             "rename the images, or add times.txt with the time [s] of each pair");
  }
  return has_dot ? line.nanoseconds(0) : line.integer(0);
}

std::vector<StampedImage> readImageList(const fs::path& root, const char* side) {
  const std::vector<fs::path> files = listImages(root / side);
  const std::string times_path = (root / "times.txt").string();
  std::vector<std::int64_t> stamps_ns;
  if (fs::exists(times_path)) {
    stamps_ns = readTimes(times_path);
  } else {
    std::transform(files.begin(), files.end(), std::back_inserter(stamps_ns), stampOf);
  }
  if (stamps_ns.size() != files.size()) {
    throw std::runtime_error(times_path + " has " + std::to_string(stamps_ns.size()) +
                             " times, but " + (root / side).string() + " has " +
                             std::to_string(files.size()) + " images");
  }
  std::vector<StampedImage> images;
  for (std::size_t i = 0; i < files.size(); ++i) {
    images.push_back({stamps_ns[i], files[i].string()});
  }
  std::sort(images.begin(), images.end(), [](const StampedImage& a, const StampedImage& b) {
    return a.stamp_ns < b.stamp_ns;
  });
  return images;
}

Trajectory readGroundTruth(const std::string& path, const std::vector<std::int64_t>& stamps_ns) {
  if (!fs::exists(path)) return {};
  if (detectTrajectoryFormat(path) != TrajectoryFormat::kTum) {
    throw std::runtime_error(path +
                             " has no stamps: TUM format is expected, stamp [s], position "
                             "and quaternion x y z w");
  }
  return samplePoses(readTrajectory(path), stamps_ns);
}

}  // namespace

std::optional<StereoSequence> readFolderLayout(const std::string& directory,
                                               const SequenceOptions& options) {
  if (!fs::exists(directory + "/left.yaml") && !fs::is_directory(directory + "/left")) {
    return std::nullopt;
  }
  ImagePairs pairs(readImageList(directory, "left"),
                   readImageList(directory, "right"),
                   options.max_stamp_difference_s);
  const StereoCalibration calibration = readStereoCalibration(
      {directory + "/left.yaml", directory + "/right.yaml"}, options.baseline_m);
  const Trajectory truth = readGroundTruth(directory + "/groundtruth.txt", pairs.stamps_ns());
  return StereoSequence{directory, std::move(pairs), calibration, truth, mountAtCamera()};
}

}  // namespace rotrocc
