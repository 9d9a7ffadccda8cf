// Valid seed inputs for the fuzzers: `fuzz_seeds DIRECTORY` creates a subdirectory for each fuzzer.

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

// Of the images [px]: large enough to track features.
constexpr std::uint32_t kWidth = 48;
constexpr std::uint32_t kHeight = 36;

template <class... Messages>
std::string serialized(const Messages&... messages) {
  std::string text(std::size_t{(0 + ... + ros::serialization::serializationLength(messages))},
                   '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(text.data()),
                                     static_cast<std::uint32_t>(text.size()));
  (ros::serialization::serialize(stream, messages), ...);
  return text;
}

/// A pattern with corners, shifted to the left by `offset_px`.
sensor_msgs::Image makeImage(const std::string& encoding,
                             std::uint32_t bytes,
                             std::uint32_t offset_px) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(1000.0);
  image.header.frame_id = "camera_gray_left";
  image.encoding = encoding;
  image.width = kWidth;
  image.height = kHeight;
  image.step = kWidth * bytes;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = offset_px; x < kWidth + offset_px; ++x) {
      const std::uint32_t tile = (x / 5 * 7919 + y / 5 * 104729) % 251;
      image.data.insert(image.data.end(), bytes, static_cast<std::uint8_t>(tile));
    }
  }
  return image;
}

sensor_msgs::CameraInfo makeInfo(double baseline_m) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = ros::Time(1000.0);
  info.width = kWidth;
  info.height = kHeight;
  const double cx = 0.5 * (kWidth - 1.0);
  const double cy = 0.5 * (kHeight - 1.0);
  info.P = {60, 0, cx, -60 * baseline_m, 0, 60, cy, 0, 0, 0, 1, 0};
  return info;
}

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  if (!(std::ofstream(path, std::ios::binary) << text)) {
    throw std::runtime_error("cannot write " + path.string());
  }
}

/// The first byte names the reader, see files_fuzzer.
void writeFiles(const fs::path& folder) {
  write(folder / "camera_calibration",
        "cimage_width: 752\nimage_height: 480\ncamera_name: left\ncamera_matrix:\n  rows: 3\n"
        "  cols: 3\n  data: [458, 0, 367, 0, 457, 248, 0, 0, 1]\ndistortion_model: plumb_bob\n"
        "distortion_coefficients:\n  data: [-0.28, 0.07, 0, 0, 0]\nrectification_matrix:\n"
        "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nprojection_matrix:\n"
        "  data: [435, 0, 367, -47.9, 0, 435, 252, 0, 0, 0, 1, 0]\n");
  write(folder / "asl",
        "cT_BS:\n  data: [0, -1, 0, -0.02, 1, 0, 0, -0.06, 0, 0, 1, 0.01, 0, 0, 0, 1]\n"
        "resolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [458, 457, 367, 248]\n"
        "distortion_model: radial-tangential\ndistortion_coefficients: [-0.28, 0.07, 0, 0]\n");
  write(folder / "calib", "kP0: 60 0 3 0 0 60 2 0 0 0 1 0\nP1: 60 0 3 -30 0 60 2 0 0 0 1 0\n");
  write(folder / "poses", "t1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0.1 0 0 -1 0 0 1 0 1e-3\n");
  write(folder / "tum", "t# t x y z\n0.5 0 0 0 0 0 0 1\n1.6e9 1 2 3 0 0.6 0 -0.8\n");
  write(folder / "times", "t0\n0.1\n");
  write(folder / "alias", "pmotion_check: &a {min_inliers: 20}\nmotion_estimator: *a\n");
  write(folder / "kinds",
        "pplanar: true\nqueue_size: 4\nsilence_s: 2.5 # s\nodom_frame: \"a b\"\n");
  write(folder / "choice", "ptrajectory_format: kitti\nvisual_odometry:\n  max_gap_s: 1e-1\n");
}

void writeMessages(const fs::path& folder) {
  const struct {
    const char* encoding;
    std::uint32_t bytes;
  } kEncodings[] = {{"mono8", 1}, {"mono16", 2}, {"bgr8", 3}, {"rgba8", 4}, {"bayer_rggb8", 1}};
  for (const auto& [encoding, bytes] : kEncodings) {
    write(folder / encoding,
          serialized(makeInfo(0.0),
                     makeInfo(0.5),
                     makeImage(encoding, bytes, 0),
                     makeImage(encoding, bytes, 3)));
  }
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds DIRECTORY\n";
    return 2;
  }
  try {
    const std::filesystem::path root = argv[1];
    rotrocc::writeFiles(root / "files");
    rotrocc::writeMessages(root / "odometry");
  } catch (const std::exception& error) {
    std::cerr << "fuzz_seeds: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
