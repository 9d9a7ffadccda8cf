#include "simulation/sequence_writer.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "common/to_seconds.h"
#include "rotrocc/trajectory.h"
#include "simulation/rows.h"

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

void writeTimes(const fs::path& path, const Simulator& simulator) {
  std::ofstream file(path);
  file << std::fixed << std::setprecision(9);
  for (int i = 0; i < simulator.size(); ++i) {
    file << toSeconds(simulator.stamp_ns(i)) << '\n';
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void writePoses(const fs::path& path, const Simulator& simulator) {
  TrajectoryWriter poses(path.string(), TrajectoryFormat::kKitti);
  for (int i = 0; i < simulator.size(); ++i) {
    poses.write({simulator.stamp_ns(i), simulator.pose(i)});
  }
}

std::vector<uchar> encode(const std::string& extension, const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

/// The file has its name when it is complete.
void writeFile(const fs::path& path, const std::vector<uchar>& bytes) {
  const fs::path unfinished = path.string() + ".part";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string() + ": is the disk full?");
  fs::rename(unfinished, path);
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
                               const Simulator& simulator,
                               bool with_truth)
    : directory_(makeDirectories(directory, with_truth)), with_truth_(with_truth) {
  const fs::path root(directory);
  writeCalibration(root / "calib.txt", simulator.camera());
  writeTimes(root / "times.txt", simulator);
  writePoses(root / "poses.txt", simulator);
}

std::string SequenceWriter::path(const char* folder, const char* extension) const {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << count_ << extension;
  return (fs::path(directory_) / folder / name.str()).string();
}

void SequenceWriter::write(const SimulatedFrame& frame) {
  const std::string names[] = {path("image_0", ".png"), path("image_1", ".png")};
  std::vector<uchar> images[2];
  forEachRow(2, [&](int side) {
    images[side] = encode(".png", side == 0 ? frame.pair.left : frame.pair.right);
  });
  for (const int side : {0, 1}) writeFile(names[side], images[side]);
  if (with_truth_) {
    writeFile(path("depth", ".tiff"), encode(".tiff", storableDepth(frame.depth)));
    if (!frame.flow.empty())
      writeFile(path("flow", ".png"), encode(".png", storableFlow(frame.flow)));
  }
  ++count_;
}

}  // namespace rotrocc
