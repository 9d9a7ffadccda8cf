#include "sequences/stereo_sequence.h"

#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "support/expect_error.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Writes a sequence of two pairs of 8 x 6 px. The tests then corrupt it.
class KittiLayoutTest : public ::testing::Test {
 protected:
  KittiLayoutTest() {
    for (const char* folder : {"image_0", "image_1"}) {
      std::filesystem::create_directory(directory_ / folder);
    }
    writeImage("image_0/000000.png", 10);
    writeImage("image_0/000001.png", 20);
    writeImage("image_1/000000.png", 30);
    writeImage("image_1/000001.png", 40);
    directory_.write("calib.txt",
                     "P0: 700 0 4.5 0 0 710 3 0 0 0 1 0\n"
                     "P1: 700 0 4 -350 0 710 3 0 0 0 1 0\n"
                     "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
    directory_.write("times.txt", "0.000000e+00\n1.037595e-01\n");
    directory_.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1.5\n");
  }

  void writeImage(const std::string& name, int gray, const cv::Size& size = {8, 6}) {
    ASSERT_TRUE(cv::imwrite(directory_ / name, cv::Mat(size, CV_8UC1, cv::Scalar(gray))));
  }

  StereoSequence open() const { return openStereoSequence(directory_ / "", {}); }

  void expectRejected(const std::string& part) const {
    expectError<std::runtime_error>([this] { open(); }, part);
  }

  TemporaryDirectory directory_;
};

TEST_F(KittiLayoutTest, ReadsCalibrationTimesPosesAndImages) {
  const StereoSequence sequence = open();
  EXPECT_EQ(sequence.size(), 2);
  StereoCamera camera;
  camera.width = 8;
  camera.height = 6;
  camera.fx = 700.0;
  camera.fy = 710.0;
  camera.cx = 4.5;
  camera.cy = 3.0;
  camera.cx_right = 4.0;
  camera.baseline_m = 0.5;
  EXPECT_EQ(sequence.calibration.rectified.differenceTo(camera), 0.0);
  EXPECT_EQ(sequence.stamp_ns(1), 103'759'500);
  EXPECT_THROW(sequence.stamp_ns(2), std::out_of_range);
  ASSERT_FALSE(sequence.ground_truth.empty());
  ASSERT_EQ(sequence.ground_truth.size(), 2u);
  EXPECT_EQ(sequence.ground_truth[1].stamp_ns, 103'759'500);
  EXPECT_EQ(sequence.ground_truth[1].T_world_body.translation().z(), 1.5);
  const cv::Mat left = sequence.read(1).left;
  EXPECT_EQ(left.type(), CV_8UC1);
  EXPECT_EQ(left.size(), cv::Size(8, 6));
  EXPECT_EQ(left.at<uchar>(0, 0), 20);
  EXPECT_EQ(sequence.read(0).right.at<uchar>(0, 0), 30);
}

TEST_F(KittiLayoutTest, BaselineIsTheDistanceBetweenTheTwoCameras) {
  // KITTI's color pair: neither camera is the reference camera of the calibration.
  directory_.write("calib.txt",
                   "P0: 700 0 4 70 0 700 3 1 0 0 1 0\n"
                   "P1: 700 0 4 -280 0 700 3 2 0 0 1 0\n");
  EXPECT_DOUBLE_EQ(open().calibration.rectified.baseline_m, 0.5);
}

TEST_F(KittiLayoutTest, TruthMayBeInTumFormatOrMissing) {
  directory_.write("poses.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 1 0 0 0 1\n0.2 0 0 2 0 0 0 1\n");
  const Trajectory truth = open().ground_truth;
  ASSERT_EQ(truth.size(), 2u) << "one for each pair";
  EXPECT_EQ(truth[1].stamp_ns, 103'759'500);
  EXPECT_NEAR(truth[1].T_world_body.translation().z(), 1.037595, 1e-9);
  directory_.write("poses.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 1 0 0 0 1\n");
  EXPECT_EQ(open().ground_truth.size(), 1u);
  std::filesystem::remove(directory_ / "poses.txt");
  EXPECT_TRUE(open().ground_truth.empty());
}

TEST_F(KittiLayoutTest, RejectsWrongFiles) {
  const std::string left = "P0: 700 0 4 0 0 700 3 0 0 0 1 0\n";
  const struct {
    std::string file, text, message;
  } rows[] = {
      {"poses.txt",
       "1 0 0 0 0 1 0 0 0 0 1 0\n",
       "poses.txt has 1 entries, but times.txt has 2 times"},
      {"calib.txt", left, "calib.txt has no line 'P1: ...'"},
      {"calib.txt", "P0: 700 0 4 0\nP1: 7\n", "calib.txt:1: P0: has 4 numbers instead of 12"},
      {"calib.txt",
       left + "P1: 700 0 4 -350 0 700 4 0 0 0 1 0\n",
       "P0: and P1: are not a rectified"},
      {"calib.txt", left + "P1: 700 0 4 350 0 700 3 0 0 0 1 0\n", "baseline_m is -0.5"},
      {"times.txt", "0.1\n0.1\n", "times.txt:2: the time 0.1"},
      {"times.txt",
       "0\n103\n",
       "images are 103 s apart, which is not the rate of a camera: they look like times in "
       "ms, with 0.103 s from one to the next: convert them to s"},
      {"times.txt", "0\n0.1\n0.2\n0.3\n0.4x\n", "times.txt:5: '0.4x' is not"}};
  for (const auto& row : rows) {
    const bool existed = std::filesystem::exists(directory_ / row.file);
    const std::string text = existed ? readFile(directory_ / row.file) : "";
    directory_.write(row.file, row.text);
    expectRejected(row.message);
    directory_.write(row.file, text);
  }
}

TEST_F(KittiLayoutTest, ReadsColorImagesIfThereAreNoOthers) {
  for (const char* folder : {"2", "3"}) {
    std::filesystem::create_directory(directory_ / (std::string("image_") + folder));
  }
  writeImage("image_2/000000.png", 50);
  EXPECT_EQ(open().read(0).left.at<uchar>(0, 0), 10);
  for (const char* name : {"image_2/000001.png", "image_3/000000.png", "image_3/000001.png"}) {
    writeImage(name, 60);
  }
  std::filesystem::remove_all(directory_ / "image_0");
  std::filesystem::remove_all(directory_ / "image_1");
  expectRejected("calib.txt has no line 'P2: ...'");
  directory_.write("calib.txt",
                   "P2: 700 0 4 70 0 700 3 1 0 0 1 0\nP3: 700 0 4 -280 0 700 3 2 0 0 1 0\n");
  EXPECT_DOUBLE_EQ(open().calibration.rectified.baseline_m, 0.5);
  EXPECT_EQ(open().read(0).left.at<uchar>(0, 0), 50);
}

TEST_F(KittiLayoutTest, ReadsRawDrives) {
  for (const std::string camera : {"drive/image_00/", "drive/image_01/"}) {
    std::filesystem::create_directories(directory_ / (camera + "data"));
    writeImage(camera + "data/0000000001.png", 10);
    writeImage(camera + "data/0000000002.png", 20);
  }
  directory_.write("drive/image_00/timestamps.txt",
                   "2011-09-26 13:02:25.594360375\n2011-09-26 13:02:25.697959960\n");
  directory_.write("calib_cam_to_cam.txt",
                   "calib_time: 09-Jan-2012 13:57:47\n"
                   "S_rect_00: 8.000000e+00 6.000000e+00\n"
                   "P_rect_00: 700 0 4 0 0 700 3 0 0 0 1 0\n"
                   "P_rect_01: 700 0 4 -350 0 700 3 0 0 0 1 0\n");
  const StereoSequence sequence = openStereoSequence(directory_ / "drive", {});
  ASSERT_EQ(sequence.size(), 2);
  EXPECT_EQ(sequence.stamp_ns(0), 1317042145'594360375);
  EXPECT_EQ(sequence.stamp_ns(1) - sequence.stamp_ns(0), 103'599'585);
  EXPECT_DOUBLE_EQ(sequence.calibration.rectified.baseline_m, 0.5);
  EXPECT_EQ(sequence.read(1).right.at<uchar>(0, 0), 20);
  directory_.write("drive/image_00/timestamps.txt", "2011-09-26 13.02\n2011-09-26 14.02\n");
  expectError<std::runtime_error>([&] { openStereoSequence(directory_ / "drive", {}); },
                                  "timestamps.txt:1: is not a time");
}

TEST_F(KittiLayoutTest, APairWithoutAFileIsLeftOut) {
  std::filesystem::remove(directory_ / "image_1/000000.png");
  const StereoSequence sequence = open();
  ASSERT_EQ(sequence.size(), 1);
  EXPECT_EQ(sequence.pairs.leftOut(), "1 left image and 0 right images without a partner");
  EXPECT_EQ(sequence.ground_truth[0].T_world_body.translation().z(), 1.5);
  std::filesystem::remove(directory_ / "image_0/000000.png");
  EXPECT_EQ(open().pairs.leftOut(), "1 listed image without a file");
}

TEST_F(KittiLayoutTest, NamesTheFileThatIsMissing) {
  expectError<std::runtime_error>([this] { openStereoSequence(directory_ / "none", {}); },
                                  "none is not a directory");
  std::filesystem::remove_all(directory_ / "image_1");
  expectRejected("image_1 is missing");
  std::filesystem::remove(directory_ / "times.txt");
  expectRejected("times.txt");
}

TEST_F(KittiLayoutTest, NamesTheImageThatIsMissingUnreadableOrOfAnotherSize) {
  const StereoSequence sequence = open();
  writeImage("image_1/000001.png", 40, {9, 6});
  expectError<std::runtime_error>(
      [&] { sequence.read(1).right; },
      "image_1/000001.png is 9 x 6 px, but the calibrated image is 8 x 6 px");
  directory_.write("image_0/000001.png", "no picture");
  expectError<std::runtime_error>([&] { sequence.read(1).left; },
                                  "image_0/000001.png is not a readable image");
}

}  // namespace
}  // namespace rotrocc
