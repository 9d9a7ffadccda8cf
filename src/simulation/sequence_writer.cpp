#include "simulation/sequence_writer.h"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <opencv2/imgcodecs.hpp>

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

std::string makeDirectories(const std::string& directory, bool with_truth) {
  std::vector<std::string> folders = {"image_0", "image_1"};
  if (with_truth) folders.insert(folders.end(), {"depth", "flow"});
  for (const std::string& folder : folders) {
    const fs::path path = fs::path(directory) / folder;
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw std::runtime_error("cannot create " + path.string() + ": " + error.message());
    if (!fs::is_empty(path)) {
      throw std::runtime_error(path.string() + " is not empty: choose a new directory");
    }
  }
  return directory;
}

void writeCalibration(const fs::path& path, const StereoCamera& camera) {
  std::ofstream file(path);
  file << std::scientific << std::setprecision(12);
  for (const bool right : {false, true}) {
    const double cx = right ? camera.cx_right : camera.cx;
    const double shift = right ? -camera.fx * camera.baseline_m : 0.0;
    file << (right ? "P1: " : "P0: ") << camera.fx << " 0 " << cx << ' ' << shift << " 0 "
         << camera.fy << ' ' << camera.cy << " 0 0 0 1 0\n";
  }
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

void writeImage(const std::string& path, const cv::Mat& image) {
  if (!cv::imwrite(path, image)) throw std::runtime_error("cannot write " + path);
}

cv::Mat storableDepth(const cv::Mat& depth) {
  cv::Mat stored;
  depth.convertTo(stored, CV_32F);
  stored.setTo(0.0F, depth > 1e30);
  return stored;
}

cv::Mat storableFlow(const cv::Mat& flow) {
  cv::Mat stored(flow.size(), CV_16UC3, cv::Scalar::all(0));
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      const cv::Vec2d& shift = flow.at<cv::Vec2d>(y, x);
      if (!(std::abs(shift[0]) < 511.0 && std::abs(shift[1]) < 511.0)) continue;  // also not NaN
      const auto code = [](double value) {
        return static_cast<ushort>(std::lround(64.0 * value) + 32768);
      };
      stored.at<cv::Vec3w>(y, x) = {1, code(shift[1]), code(shift[0])};  // blue, green, red
    }
  }
  return stored;
}

}  // namespace

SequenceWriter::SequenceWriter(const std::string& directory,
                               const StereoCamera& camera,
                               bool with_truth)
    : directory_(makeDirectories(directory, with_truth)),
      with_truth_(with_truth),
      times_(fs::path(directory) / "times.txt"),
      poses_((fs::path(directory) / "poses.txt").string(), TrajectoryFormat::kKitti) {
  writeCalibration(fs::path(directory) / "calib.txt", camera);
}

std::string SequenceWriter::path(const char* folder, const char* extension) const {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << count_ << extension;
  return (fs::path(directory_) / folder / name.str()).string();
}

void SequenceWriter::write(const SimulatedFrame& frame, const Eigen::Isometry3d& T_first_left) {
  writeImage(path("image_0", ".png"), frame.pair.left);
  writeImage(path("image_1", ".png"), frame.pair.right);
  if (with_truth_) {
    writeImage(path("depth", ".tiff"), storableDepth(frame.depth));
    if (!frame.flow.empty()) writeImage(path("flow", ".png"), storableFlow(frame.flow));
  }
  times_ << std::fixed << std::setprecision(9) << 1e-9 * static_cast<double>(frame.pair.stamp_ns)
         << '\n'
         << std::flush;
  if (!times_) throw std::runtime_error("cannot write times.txt: is the disk full?");
  poses_.write({frame.pair.stamp_ns, T_first_left});
  ++count_;
}

}  // namespace rotrocc
