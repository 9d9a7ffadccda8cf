#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "sequences/stereo_sequence.h"
#include "support/expect_error.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// Two pairs with the calibration of EuRoC's cameras in config/cameras.
class CalibratedFolderTest : public ::testing::Test {
 protected:
  CalibratedFolderTest() {
    for (const std::string side : {"left", "right"}) {
      fs::create_directory(directory_ / side);
      fs::copy_file(std::string(CAMERAS) + "/euroc_" + side + ".yaml",
                    directory_ / (side + ".yaml"));
      writeImage(side + "/1403636579763555584.png", 10);
      writeImage(side + "/1403636579813555456.png", 20);
    }
  }

  void writeImage(const std::string& name, int gray) const {
    cv::imwrite(directory_ / name, cv::Mat(480, 752, CV_8UC1, cv::Scalar(gray)));
  }

  StereoSequence open(const SequenceOptions& options = {}) const {
    return openStereoSequence(directory_ / "", options);
  }

  void expectRejected(const std::string& part) const {
    expectError<std::runtime_error>([this] { open(); }, part);
  }

  void change(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = readFile(directory_ / name);
    const std::size_t position = text.find(from);
    ASSERT_NE(position, std::string::npos) << name << " has no " << from;
    directory_.write(name, text.replace(position, from.size(), to));
  }

  TemporaryDirectory directory_;
};

TEST_F(CalibratedFolderTest, ReadsPairsNamedByTheirTimes) {
  StereoSequence sequence = open();
  ASSERT_EQ(sequence.size(), 2);
  EXPECT_EQ(sequence.stamp_ns(0), 1403636579763555584);
  EXPECT_EQ(sequence.read(1).right.at<uchar>(0, 0), 20);
  fs::rename(directory_ / "left/1403636579813555456.png",
             directory_ / "left/1403636579.813555.png");
  EXPECT_EQ(open().stamp_ns(1), 1403636579813555000) << "in seconds, 456 ns earlier";
}

TEST_F(CalibratedFolderTest, CalibrationIsThatOfTheFiles) {
  const StereoCalibration calibration = open().calibration;
  EXPECT_EQ(calibration.left.fx, 458.654);
  EXPECT_EQ(calibration.right.cy, 255.238);
  EXPECT_EQ(calibration.right.distortion.coefficients()[0], -0.28368365);
  EXPECT_EQ(calibration.left.R_rectified_raw(0, 1), -0.001422739138719227);
  EXPECT_EQ(calibration.rectified.fx, 436.2345864026956);
  EXPECT_NEAR(calibration.rectified.baseline_m, 0.110078, 1e-6);
  EXPECT_FALSE(calibration.isRectified());
}

TEST_F(CalibratedFolderTest, TakesTheTimesOfAFile) {
  for (const std::string side : {"left", "right"}) {
    fs::rename(directory_ / (side + "/1403636579763555584.png"), directory_ / (side + "/z.png"));
    fs::rename(directory_ / (side + "/1403636579813555456.png"), directory_ / (side + "/a.png"));
  }
  expectRejected("a.png is not named by its time, e.g. 1403636579763555584.png [ns]");
  directory_.write("times.txt", "0.5\n0.6\n");
  StereoSequence sequence = open();
  EXPECT_EQ(sequence.stamp_ns(1), 600'000'000);
  EXPECT_EQ(sequence.read(0).left.at<uchar>(0, 0), 20) << "in the order of their names";
  EXPECT_EQ(rosTimeOffset_ns(sequence), 1'317'600'000'000'000'000);
  directory_.write("times.txt", "0.5\n");
  expectRejected("times.txt has 1 times, but there are 2 left and 2 right images");
}

TEST_F(CalibratedFolderTest, ReadsTruthInTumFormat) {
  directory_.write("groundtruth.txt",
                   "# timestamp tx ty tz qx qy qz qw\n"
                   "1403636579.70 0 0 0 0 0 0 1\n1403636579.80 0 0 1 0 0 0 1\n");
  const Trajectory truth = open().ground_truth;
  ASSERT_EQ(truth.size(), 1u) << "the second pair is later";
  EXPECT_EQ(truth[0].stamp_ns, 1403636579763555584);
  EXPECT_NEAR(truth[0].T_world_body.translation().z(), 0.63555584, 1e-6);
  directory_.write("groundtruth.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expectRejected("groundtruth.txt has no stamps: TUM format is expected");
}

TEST_F(CalibratedFolderTest, NamesWhatIsWrong) {
  change("right.yaml", "-48.01976196062409", "0");
  expectRejected("the baseline is zero: P[3] of camera_info");
  EXPECT_EQ(open({0.01, 0.2}).calibration.rectified.baseline_m, 0.2);
  change("right.yaml", "364.441234588623, 0,", "364.441234588623, -48.0,");
  change("right.yaml", "plumb_bob", "mirror");
  expectRejected("the distortion model 'mirror' is not supported");
  change("right.yaml", "image_width: 752", "image_width: -752");
  expectRejected("right.yaml: image_width is -752, not a number of pixels");
  change("left.yaml", "camera_matrix", "matrix");
  expectRejected("left.yaml: camera_matrix is missing");
  fs::remove(directory_ / "left.yaml");
  expectRejected("cannot read");
  fs::remove_all(directory_ / "right");
  expectRejected("right is missing");
}

}  // namespace
}  // namespace rotrocc
