#include "seeds.h"

#include <fstream>
#include <regex>
#include <stdexcept>
#include <utility>

#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace rotrocc {
namespace {

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

/// Sections of the default parameters, without comments.
void addSections(Seeds& seeds) {
  std::ifstream file(ROTROCC_CONFIG_DIR "/default.yaml");
  if (!file) throw std::runtime_error("cannot read " ROTROCC_CONFIG_DIR "/default.yaml");
  std::string section;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() && !section.empty()) {
      seeds["section" + std::to_string(seeds.size())] = "p" + std::exchange(section, {});
    } else {
      section += std::regex_replace(line, std::regex(" *#.*"), "") + '\n';
    }
  }
  seeds["section" + std::to_string(seeds.size())] = "p" + section;
}

/// The first byte names the reader, see files_fuzzer.
Seeds fileSeeds() {
  Seeds seeds;
  seeds["camera_calibration"] =
      "cimage_width: 752\nimage_height: 480\ncamera_name: left\ncamera_matrix:\n  rows: 3\n"
      "  cols: 3\n  data: [458, 0, 367, 0, 457, 248, 0, 0, 1]\ndistortion_model: plumb_bob\n"
      "distortion_coefficients:\n  data: [-0.28, 0.07, 0, 0, 0]\nrectification_matrix:\n"
      "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nprojection_matrix:\n"
      "  data: [435, 0, 367, -47.9, 0, 435, 252, 0, 0, 0, 1, 0]\n";
  seeds["asl"] =
      "cT_BS:\n  data: [0, -1, 0, -0.02, 1, 0, 0, -0.06, 0, 0, 1, 0.01, 0, 0, 0, 1]\n"
      "resolution: [752, 480]\ncamera_model: pinhole\nintrinsics: [458, 457, 367, 248]\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [-0.28, 0.07, 0, 0]\n";
  seeds["calib"] = "kP0: 60 0 3 0 0 60 2 0 0 0 1 0\nP1: 60 0 3 -30 0 60 2 0 0 0 1 0\n";
  seeds["poses"] = "t1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0.1 0 0 -1 0 0 1 0 1e-3\n";
  seeds["tum"] = "t# t x y z\n0.5 0 0 0 0 0 0 1\n1.6e9 1 2 3 0 0.6 0 -0.8\n";
  seeds["times"] = "t0\n0.1\n";
  seeds["alias"] = "pmotion_check: &a {max_speed_mps: 20}\nmotion_estimator: *a\n";
  seeds["kinds"] = "pplanar: true\nqueue_size: 4\nsilence_s: 2.5 # s\nodom_frame: \"a b\"\n";
  seeds["choice"] = "ptrajectory_format: kitti\nmotion_check:\n  max_speed_mps: 1e-1\n";
  addSections(seeds);
  return seeds;
}

Seeds messageSeeds() {
  Seeds seeds;
  const struct {
    const char* encoding;
    std::uint32_t bytes;
  } kEncodings[] = {{"mono8", 1}, {"mono16", 2}, {"bgr8", 3}, {"rgba8", 4}, {"bayer_rggb8", 1}};
  for (const auto& [encoding, bytes] : kEncodings) {
    seeds[encoding] = serialized(
        makeInfo(0.0), makeInfo(0.5), makeImage(encoding, bytes, 0), makeImage(encoding, bytes, 3));
  }
  return seeds;
}

}  // namespace

Seeds seedsOf(const std::string& fuzzer) {
  if (fuzzer == "files") return fileSeeds();
  if (fuzzer == "odometry") return messageSeeds();
  throw std::invalid_argument("there is no fuzzer of the name " + fuzzer);
}

}  // namespace rotrocc
