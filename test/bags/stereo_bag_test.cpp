#include "bags/stereo_bag.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "bags/bag_reading.h"
#include "support/expect_error.h"
#include "support/kitti2bag_writer.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 20;

/// The sequence that the bags of a test are made of.
class StereoBagTest : public ::testing::Test {
 protected:
  StereoBagTest() { writeSyntheticSequence(directory_ / "sequence", kPairs); }

  KittiSequence sequence() const { return KittiSequence(directory_ / "sequence"); }

  /// Expects every pair of the sequence, with the camera that P describes.
  void expectAllPairs(StereoBag& bag) const {
    const KittiSequence expected = sequence();
    StereoPair pair;
    StereoCamera camera;
    for (int i = 0; i < kPairs; ++i) {
      ASSERT_TRUE(bag.next(pair, camera)) << "pair " << i;
      EXPECT_EQ(cv::norm(pair.left, expected.readLeft(i), cv::NORM_INF), 0.0) << "pair " << i;
      EXPECT_EQ(cv::norm(pair.right, expected.readRight(i), cv::NORM_INF), 0.0) << "pair " << i;
      EXPECT_EQ(camera.fx, expected.camera().fx);
      EXPECT_DOUBLE_EQ(camera.baseline_m, expected.camera().baseline_m);
    }
    EXPECT_FALSE(bag.next(pair, camera));
  }

  /// A bag with the same for left and right.
  void writePair(const std::string& name,
                 const sensor_msgs::CameraInfo& info,
                 const sensor_msgs::Image& image) const {
    rosbag::Bag bag(directory_ / name, rosbag::bagmode::Write);
    for (const std::string side : {"left", "right"}) {
      bag.write("/stereo/" + side + "/camera_info", image.header.stamp, info);
      bag.write("/stereo/" + side + "/image_rect", image.header.stamp, image);
    }
  }

  TemporaryDirectory directory_;
};

TEST_F(StereoBagTest, ReadsRawDrivesOfKitti2bag) {
  writeKitti2bagRaw(sequence(), directory_ / "raw.bag");
  const rosbag::Bag file = openBag(directory_ / "raw.bag");
  StereoBag bag(file, {});
  EXPECT_EQ(bag.topics().left_image, "/kitti/camera_gray_left/image_raw");
  EXPECT_EQ(bag.size(), kPairs);
  expectAllPairs(bag);
}

TEST_F(StereoBagTest, ReadsOdometrySequencesOfKitti2bag) {
  writeKitti2bagOdometry(sequence(), directory_ / "odometry.bag");
  const rosbag::Bag file = openBag(directory_ / "odometry.bag");
  StereoBag bag(file, {});
  EXPECT_EQ(bag.topics().right_image, "/kitti/camera_gray_right/image_rect");
  expectAllPairs(bag);
}

TEST_F(StereoBagTest, ConvertsColour) {
  writeKitti2bagRaw(sequence(), directory_ / "raw.bag");
  StereoBag::Options colour;
  colour.left_image = "/kitti/camera_color_left/image_raw";
  colour.right_image = "/kitti/camera_color_right/image_raw";
  const rosbag::Bag file = openBag(directory_ / "raw.bag");
  StereoBag bag(file, colour);
  expectAllPairs(bag);  // shades of gray, which the conversion keeps
}

TEST_F(StereoBagTest, LeavesOutImagesWithoutAPartner) {
  writeKitti2bagRaw(sequence(), directory_ / "raw.bag");
  StereoBag::Options strict;
  strict.max_stamp_difference_s = 0.0035;  // half of the largest difference in the bag
  const rosbag::Bag file = openBag(directory_ / "raw.bag");
  StereoBag bag(file, strict);
  StereoPair pair;
  StereoCamera camera;
  int pairs = 0;
  while (bag.next(pair, camera)) ++pairs;
  EXPECT_GT(pairs, 0);
  EXPECT_LT(pairs, kPairs);
}

TEST_F(StereoBagTest, TakesTheBaselineThatCameraInfoLacks) {
  sensor_msgs::CameraInfo info;
  info.width = info.height = 32;
  info.P = {40, 0, 16, 0, 0, 40, 16, 0, 0, 0, 1, 0};
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(12.5);
  image.encoding = "mono8";
  image.width = image.height = image.step = 32;
  image.data.resize(32 * 32);
  writePair("no_baseline.bag", info, image);
  const rosbag::Bag file = openBag(directory_ / "no_baseline.bag");
  StereoPair pair;
  StereoCamera camera;
  StereoBag without(file, {});
  expectError<std::runtime_error>([&] { without.next(pair, camera); },
                                  "set the parameter baseline_m");
  NodeParameters parameters;
  parameters.baseline_m = 0.37;
  StereoBag with(file, bagOptions(parameters));
  ASSERT_TRUE(with.next(pair, camera));
  EXPECT_EQ(camera.baseline_m, 0.37);
}

TEST_F(StereoBagTest, RefusesImagesOfMorePixelsThanTheLimit) {
  writeKitti2bagOdometry(sequence(), directory_ / "odometry.bag");
  const rosbag::Bag file = openBag(directory_ / "odometry.bag");
  const StereoCamera size = sequence().camera();
  StereoPair pair;
  StereoCamera camera;
  NodeParameters parameters;
  parameters.max_image_pixels = size.width * size.height - 1;
  StereoBag strict(file, bagOptions(parameters));
  expectError<std::runtime_error>([&] { strict.next(pair, camera); },
                                  "more than max_image_pixels = ");
  parameters.max_image_pixels = size.width * size.height;
  StereoBag bag(file, bagOptions(parameters));
  expectAllPairs(bag);
}

TEST_F(StereoBagTest, RefusesWhatIsNoBag) {
  expectError<std::runtime_error>([&] { openBag(directory_ / "missing.bag"); },
                                  "missing.bag is not readable as a bag");
  const std::string text = directory_.write("text.bag", "no bag\n");
  expectError<std::runtime_error>([&] { openBag(text); }, "text.bag is not readable");
}

TEST_F(StereoBagTest, NamesThePairWhoseCameraIsWrong) {
  sensor_msgs::CameraInfo uncalibrated;
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(12.5);
  writePair("uncalibrated.bag", uncalibrated, image);
  const rosbag::Bag file = openBag(directory_ / "uncalibrated.bag");
  StereoBag bag(file, {});
  StereoPair pair;
  StereoCamera camera;
  expectError<std::runtime_error>([&] { bag.next(pair, camera); }, "pair of 12.5");
}

}  // namespace
}  // namespace rotrocc
