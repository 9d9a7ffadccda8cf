#include "sequences/calibration_file.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Two cameras, the right one 0.11 m beside the left one, in the formats that people have.
class CalibrationFileTest : public ::testing::Test {
 protected:
  struct File {
    const char* name;
    std::string text;
  };

  StereoCalibration read(const std::vector<File>& files, const StereoFileOptions& options = {}) {
    std::vector<std::string> paths;
    for (const File& file : files) paths.push_back(directory_.write(file.name, file.text));
    return readStereoCalibration(paths, options);
  }

  /// Of raw images with a lens.
  void expectRaw(const std::vector<File>& files) {
    SCOPED_TRACE(files.front().text);
    const StereoCalibration calibration = read(files);
    EXPECT_EQ(calibration.left.width, 752);
    EXPECT_EQ(calibration.left.fx, 458.0);
    EXPECT_EQ(calibration.right.cy, 255.0);
    EXPECT_EQ(calibration.left.distortion.coefficients()[0], -0.28);
    EXPECT_NEAR(calibration.rectified.baseline_m, 0.11, 1e-9);
  }

  /// Of projection matrices.
  static void expectProjections(const StereoCalibration& calibration) {
    EXPECT_EQ(calibration.rectified.fx, 440.0);
    EXPECT_EQ(calibration.rectified.cx, 370.0);
    EXPECT_NEAR(calibration.rectified.baseline_m, 0.11, 1e-9);
    EXPECT_EQ(calibration.left.distortion.coefficients()[1], 0.07);
  }

  TemporaryDirectory directory_;
};

const std::string kLeft = "[458, 457, 367, 248]";
const std::string kRight = "[457, 456, 380, 255]";
const std::string kLens = "[-0.28, 0.07, 0.0, 0.0]";
const std::string kIdentity = "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
const std::string kBeside = "[1, 0, 0, 0.11, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
const std::string kOpposite = "[1, 0, 0, -0.11, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
const std::string kK = "[458, 0, 367, 0, 457, 248, 0, 0, 1]";
const std::string kR = "[1, 0, 0, 0, 1, 0, 0, 0, 1]";
const std::string kP1 = "[440, 0, 370, 0, 0, 440, 250, 0, 0, 0, 1, 0]";
const std::string kP2 = "[440, 0, 370, -48.4, 0, 440, 250, 0, 0, 0, 1, 0]";

std::string chainCamera(const std::string& intrinsics, const std::string& pose) {
  return "  camera_model: pinhole\n  intrinsics: " + intrinsics +
         "\n  distortion_model: radtan\n  distortion_coeffs: " + kLens +
         "\n  resolution: [752, 480]\n" + pose;
}

std::string chain(const std::string& left_pose, const std::string& right_pose) {
  return "%YAML:1.0\ncam0:\n" + chainCamera(kLeft, left_pose) + "cam1:\n" +
         chainCamera(kRight, right_pose);
}

std::string sensor(const std::string& intrinsics, const std::string& pose) {
  return "%YAML:1.0\nT_BS:\n  cols: 4\n  rows: 4\n  data: " + pose +
         "\nresolution: [752, 480]\ncamera_model: pinhole\nintrinsics: " + intrinsics +
         "\ndistortion_model: radial-tangential\ndistortion_coefficients: " + kLens + "\n";
}

/// A matrix as OpenCV writes it.
std::string cvMatrix(const std::string& name, int rows, int columns, const std::string& data) {
  return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: " + data + "\n";
}

TEST_F(CalibrationFileTest, ReadsCamerasThatAreNotRectified) {
  expectRaw({{"camchain.yaml", chain("", "  T_cn_cnm1: " + kOpposite + "\n")}});
  expectRaw({{"openvins.yaml",
              chain("  T_imu_cam: " + kIdentity + "\n", "  T_imu_cam: " + kBeside + "\n")}});
  expectRaw({{"openvins.yaml",
              chain("  T_cam_imu: " + kIdentity + "\n", "  T_cam_imu: " + kOpposite + "\n")}});
  expectRaw({{"LeftCameraParams.yaml", sensor(kLeft, kIdentity)},
             {"RightCameraParams.yaml", sensor(kRight, kBeside)}});
  std::string orb = "%YAML:1.0\nCamera.type: \"PinHole\"\nCamera.width: 752\nCamera.height: 480\n";
  for (const std::string camera : {"Camera1.", "Camera2."}) {
    const bool is_left = camera == "Camera1.";
    orb += camera + "fx: " + (is_left ? "458.0" : "457.0") + "\n" + camera + "fy: 457.0\n" +
           camera + "cx: 367.0\n" + camera + "cy: " + (is_left ? "248.0" : "255.0") + "\n" +
           camera + "k1: -0.28\n" + camera + "k2: 0.07\n" + camera + "p1: 0.0\n" + camera +
           "p2: 0.0\n";
  }
  expectRaw({{"orb3.yaml", orb + cvMatrix("Stereo.T_c1_c2", 4, 4, kBeside)}});
}

TEST_F(CalibrationFileTest, ReadsProjectionMatrices) {
  std::string sides = "%YAML:1.0\n";
  for (const std::string side : {"LEFT", "RIGHT"}) {
    sides += side + ".height: 480\n" + side + ".width: 752\n" + cvMatrix(side + ".D", 1, 5, kLens) +
             cvMatrix(side + ".K", 3, 3, kK) + cvMatrix(side + ".R", 3, 3, kR) +
             cvMatrix(side + ".P", 3, 4, side == "LEFT" ? kP1 : kP2);
  }
  expectProjections(read({{"orb2.yaml", sides}}));

  const auto dump = [](const std::string& P) {
    return "header: \n  seq: 12\n  stamp: \n    secs: 1\n    nsecs: 2\n  frame_id: "
           "\"cam\"\nheight: "
           "480\nwidth: 752\ndistortion_model: \"plumb_bob\"\nD: " +
           kLens + "\nK: " + kK + "\nR: " + kR + "\nP: " + P +
           "\nbinning_x: 0\nbinning_y: 0\nroi: \n  x_offset: 0\n  y_offset: 0\n  height: 0\n  "
           "width: "
           "0\n  do_rectify: False\n---\n";
  };
  expectProjections(read({{"left.txt", dump(kP1) + dump(kP1)}, {"right.txt", dump(kP2)}}));
  EXPECT_EQ(readCameraInfo(directory_ / "left.txt").P[0], 440.0);

  const std::string intrinsics = cvMatrix("M1", 3, 3, kK) + cvMatrix("D1", 1, 4, kLens) +
                                 cvMatrix("M2", 3, 3, kK) + cvMatrix("D2", 1, 4, kLens);
  const std::string extrinsics = cvMatrix("R1", 3, 3, kR) + cvMatrix("R2", 3, 3, kR) +
                                 cvMatrix("P1", 3, 4, kP1) + cvMatrix("P2", 3, 4, kP2);
  const std::vector<File> opencv = {{"intrinsics.yml", "%YAML:1.0\n---\n" + intrinsics},
                                    {"extrinsics.yml", "%YAML:1.0\n---\n" + extrinsics}};
  expectProjections(read(opencv, {0.0, [] { return cv::Size(752, 480); }}));
  expectError<std::runtime_error>([&] { read(opencv); }, "lack the size of the images");
}

TEST_F(CalibrationFileTest, ReadsRectifiedCamerasOfOrbSlam) {
  const std::string common = "%YAML:1.0\nCamera.width: 1226\nCamera.height: 370\n";
  const std::string numbers = "fx: 707.0\n$fy: 707.0\n$cx: 602.0\n$cy: 183.0\n";
  const auto named = [&](const std::string& camera) {
    std::string text = camera + numbers;
    for (std::size_t i; (i = text.find('$')) != std::string::npos;) text.replace(i, 1, camera);
    return text;
  };
  for (const std::string& text : {common + named("Camera.") + "Camera.bf: 353.5\n",
                                  common + named("Camera1.") + "Stereo.b: 0.5\n"}) {
    const StereoCalibration calibration = read({{"kitti.yaml", text}});
    EXPECT_TRUE(calibration.isRectified());
    EXPECT_EQ(calibration.rectified.cx, 602.0);
    EXPECT_NEAR(calibration.rectified.baseline_m, 0.5, 1e-12);
  }
}

TEST_F(CalibrationFileTest, NamesWhatItReads) {
  expectError<std::runtime_error>(
      [&] {
        read({{"a.yaml", "max_features: 300\n"}});
      },
      "is not a stereo calibration in a format that is read, which are: two "
      "files of camera_calibration, two dumps of camera_info, a camchain");
  expectError<std::runtime_error>(
      [&] {
        read({{"a.yaml", sensor(kLeft, kIdentity)}, {"b.yaml", sensor(kRight, kOpposite)}});
      },
      "are left and right swapped");
  expectError<std::runtime_error>(
      [&] {
        read({{"a.yaml", chain("", "")}});
      },
      "T_cn_cnm1 is missing, and so are T_imu_cam and T_cam_imu");
}

}  // namespace
}  // namespace rotrocc
