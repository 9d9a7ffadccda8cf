#pragma once

#include <filesystem>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "support/temporary_directory.h"

namespace rotrocc {

/// A small recording in ASL format with the calibration of EuRoC: three pairs of 752 x 480 px, 50
/// ms apart. Tests change its files.
class AslFolder {
 public:
  static constexpr std::int64_t kStart_ns = 1403636579763555584;
  static constexpr std::int64_t kPeriod_ns = 50'000'000;

  AslFolder() {
    for (const char* camera : {"cam0", "cam1"}) {
      std::filesystem::create_directories(directory_ / ("mav0/" + std::string(camera) + "/data"));
      std::string list = "#timestamp [ns],filename\r\n";  // as in EuRoC's files
      for (int i = 0; i < 3; ++i) {
        list += std::to_string(stamp_ns(i)) + "," + std::to_string(stamp_ns(i)) + ".png\r\n";
        writeImage(camera, stamp_ns(i), 50 * (i + 1));
      }
      write(std::string(camera) + "/data.csv", list);
    }
    write("cam0/sensor.yaml",
          sensor("[0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,\n"
                 "         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,\n"
                 "        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,\n"
                 "         0.0, 0.0, 0.0, 1.0]",
                 "[458.654, 457.296, 367.215, 248.375]",
                 "[-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]"));
    write("cam1/sensor.yaml",
          sensor("[0.0125552670891, -0.999755099723, 0.0182237714554, -0.0198435579556,\n"
                 "         0.999598781151, 0.0130119051815, 0.0251588363115, 0.0453689425024,\n"
                 "        -0.0253898008918, 0.0179005838253, 0.999517347078, 0.00786212447038,\n"
                 "         0.0, 0.0, 0.0, 1.0]",
                 "[457.587, 456.134, 379.999, 255.238]",
                 "[-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05]"));
  }

  static std::int64_t stamp_ns(int index) { return kStart_ns + index * kPeriod_ns; }

  std::string path() const { return directory_ / ""; }
  std::string operator/(const std::string& name) const { return directory_ / ("mav0/" + name); }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(*this / name).parent_path());
    directory_.write("mav0/" + name, text);
  }

  void writeImage(const std::string& camera,
                  std::int64_t stamp_ns,
                  int gray,
                  const cv::Size& size = {752, 480}) const {
    const std::string name = camera + "/data/" + std::to_string(stamp_ns) + ".png";
    cv::imwrite(*this / name, cv::Mat(size, CV_8UC1, cv::Scalar(gray)));
  }

  static std::string sensor(const std::string& pose,
                            const std::string& intrinsics,
                            const std::string& distortion,
                            const std::string& model = "radial-tangential") {
    return "# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor cam0 "
           "(MT9M034)\n\n"
           "# Sensor extrinsics wrt. the body-frame.\nT_BS:\n  cols: 4\n  rows: 4\n  data: " +
           pose +
           "\n\n# Camera specific definitions.\nrate_hz: 20\nresolution: [752, 480]\n"
           "camera_model: pinhole\nintrinsics: " +
           intrinsics + " #fu, fv, cu, cv\ndistortion_model: " + model +
           "\ndistortion_coefficients: " + distortion + "\n";
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace rotrocc
