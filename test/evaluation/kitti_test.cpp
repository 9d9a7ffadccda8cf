#include "rotrocc/kitti.h"

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
class KittiSequenceTest : public ::testing::Test {
 protected:
  KittiSequenceTest() {
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

  void writeImage(const std::string& name, int grey, const cv::Size& size = {8, 6}) {
    ASSERT_TRUE(cv::imwrite(directory_ / name, cv::Mat(size, CV_8UC1, cv::Scalar(grey))));
  }

  KittiSequence open() const { return KittiSequence(directory_ / ""); }

  void expectRefused(const std::string& part) const {
    expectError<std::runtime_error>([this] { open(); }, part);
  }

  TemporaryDirectory directory_;
};

TEST_F(KittiSequenceTest, ReadsCalibrationTimesPosesAndImages) {
  const KittiSequence sequence = open();
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
  EXPECT_EQ(sequence.camera().differenceTo(camera), 0.0);
  EXPECT_EQ(sequence.stamp_ns(1), 103'759'500);
  EXPECT_THROW(sequence.stamp_ns(2), std::out_of_range);
  ASSERT_FALSE(sequence.groundTruth().empty());
  ASSERT_EQ(sequence.groundTruth().size(), 2u);
  EXPECT_EQ(sequence.groundTruth()[1].stamp_ns, 103'759'500);
  EXPECT_EQ(sequence.groundTruth()[1].T_world_body.translation().z(), 1.5);
  const cv::Mat left = sequence.readLeft(1);
  EXPECT_EQ(left.type(), CV_8UC1);
  EXPECT_EQ(left.size(), cv::Size(8, 6));
  EXPECT_EQ(left.at<uchar>(0, 0), 20);
  EXPECT_EQ(sequence.readRight(0).at<uchar>(0, 0), 30);
}

TEST_F(KittiSequenceTest, BaselineIsTheDistanceBetweenTheTwoCameras) {
  // KITTI's colour pair: neither camera is the reference camera of the calibration.
  directory_.write("calib.txt",
                   "P0: 700 0 4 70 0 700 3 1 0 0 1 0\n"
                   "P1: 700 0 4 -280 0 700 3 2 0 0 1 0\n");
  EXPECT_DOUBLE_EQ(open().camera().baseline_m, 0.5);
}

TEST_F(KittiSequenceTest, TruthMayBeInTumFormatOrMissing) {
  directory_.write("poses.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 1 0 0 0 1\n0.2 0 0 2 0 0 0 1\n");
  const Trajectory truth = open().groundTruth();
  ASSERT_EQ(truth.size(), 2u) << "one for each pair";
  EXPECT_EQ(truth[1].stamp_ns, 103'759'500);
  EXPECT_NEAR(truth[1].T_world_body.translation().z(), 1.037595, 1e-9);
  directory_.write("poses.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 1 0 0 0 1\n");
  expectRefused("poses.txt, interpolated, has 1 entries, but times.txt has 2 times");
  std::filesystem::remove(directory_ / "poses.txt");
  EXPECT_TRUE(open().groundTruth().empty());
}

TEST_F(KittiSequenceTest, RefusesWrongFiles) {
  const std::string left = "P0: 700 0 4 0 0 700 3 0 0 0 1 0\n";
  const struct {
    std::string file, text, message;
  } rows[] = {
      {"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n", "has 1 entries, but times.txt has 2 times"},
      {"calib.txt", left, "calib.txt has no line 'P1: ...'"},
      {"calib.txt", "P0: 700 0 4 0\nP1: 7\n", "calib.txt:1: P0: has 4 numbers instead of 12"},
      {"calib.txt", left + "P1: 700 0 4 -350 0 700 4 0 0 0 1 0\n", "are not a rectified pair"},
      {"calib.txt", left + "P1: 700 0 4 350 0 700 3 0 0 0 1 0\n", "baseline_m is -0.5"},
      {"times.txt", "0.1\n0.1\n", "times.txt:2: the time 0.1"},
      {"image_1/000002.png", "", "image_1 has 3 entries, but times.txt has 2 times"}};
  for (const auto& row : rows) {
    const bool existed = std::filesystem::exists(directory_ / row.file);
    const std::string text = existed ? readFile(directory_ / row.file) : "";
    directory_.write(row.file, row.text);
    expectRefused(row.message);
    directory_.write(row.file, text);
  }
}

TEST_F(KittiSequenceTest, NamesTheFileThatIsMissing) {
  expectError<std::runtime_error>([this] { KittiSequence(directory_ / "none"); },
                                  "none is not a directory");
  std::filesystem::remove_all(directory_ / "image_1");
  expectRefused("image_1 is missing");
  std::filesystem::remove(directory_ / "times.txt");
  expectRefused("times.txt");
}

TEST_F(KittiSequenceTest, NamesTheImageThatIsMissingUnreadableOrOfAnotherSize) {
  const KittiSequence sequence = open();
  writeImage("image_1/000001.png", 40, {9, 6});
  expectError<std::runtime_error>(
      [&] { sequence.readRight(1); },
      "image_1/000001.png is 9 x 6 px, but the first image is 8 x 6 px");
  directory_.write("image_0/000001.png", "no picture");
  expectError<std::runtime_error>([&] { sequence.readLeft(1); },
                                  "image_0/000001.png is not a readable image");
  expectError<std::runtime_error>([&] { sequence.readLeft(2); }, "image_0/000002.png is missing");
}

}  // namespace
}  // namespace rotrocc
