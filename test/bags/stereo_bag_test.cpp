#include "bags/stereo_bag.h"

#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "bags/bag_reading.h"
#include "bags/sequence_bag_writer.h"
#include "sequences/camera_info_calibration.h"
#include "support/asl_folder.h"
#include "support/expect_error.h"
#include "support/kitti2bag_writer.h"
#include "support/raw_rig.h"
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

/// A bag of unrectified images, and what is expected of them.
class RawBagTest : public ::testing::Test {
 protected:
  RawBagTest() : sequence_(openStereoSequence(folder_.path(), {})) {
    for (int i = 0; i < 3; ++i) {
      cv::Mat image(480, 752, CV_8UC1);
      cv::randu(image, 0, 255);
      cv::GaussianBlur(image, image, {}, 2.0);
      for (const char* camera : {"cam0", "cam1"}) {
        const std::string name = std::to_string(AslFolder::stamp_ns(i)) + ".png";
        cv::imwrite(folder_ / (camera + ("/data/" + name)), image);
      }
    }
    writeSequenceBag(path(), *sequence_);
  }

  std::string path() const { return directory_ / "raw.bag"; }

  AslFolder folder_;
  TemporaryDirectory directory_;
  std::unique_ptr<StereoSequence> sequence_;
};

TEST_F(RawBagTest, IsRectified) {
  const rosbag::Bag file = openBag(path());
  StereoBag bag(file, {});
  EXPECT_EQ(bag.topics().left_image, "/stereo/left/image_raw");
  EXPECT_TRUE(bag.rectifies());
  StereoRectifier rectifier(sequence_->calibration());
  StereoPair pair;
  StereoCamera camera;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(bag.next(pair, camera));
    const StereoPair expected = rectifier.rectify(sequence_->read(i));
    EXPECT_EQ(pair.stamp_ns, AslFolder::stamp_ns(i));
    EXPECT_EQ(cv::norm(pair.left, expected.left, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(pair.right, expected.right, cv::NORM_INF), 0.0);
    EXPECT_EQ(camera.fx, rectifier.camera().fx);
    EXPECT_EQ(camera.cy, rectifier.camera().cy);
  }
  EXPECT_FALSE(bag.next(pair, camera));
}

TEST_F(RawBagTest, IsLeftAsItIsOnRequest) {
  const rosbag::Bag file = openBag(path());
  StereoBag::Options options;
  options.rectify = rectifyOption("no");
  StereoBag bag(file, options);
  EXPECT_FALSE(bag.rectifies());
  StereoPair pair;
  StereoCamera camera;
  ASSERT_TRUE(bag.next(pair, camera));
  EXPECT_EQ(cv::norm(pair.left, sequence_->read(0).left, cv::NORM_INF), 0.0);
  expectError<std::invalid_argument>([] { rectifyOption("maybe"); },
                                     "'maybe', not auto, yes or no");
}

/// A bag of one pair with changed messages.
void writeRawPair(const std::string& path,
                  const std::function<void(sensor_msgs::CameraInfo&)>& change) {
  const RawRig rig = rawRig();
  const StereoCalibration calibration = chooseRectification(rig.left, rig.right, rig.T_left_right);
  const StereoCamera& camera = calibration.rectified;
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(12.5);
  image.encoding = "mono8";
  image.width = image.step = 752;
  image.height = 480;
  image.data.resize(752 * 480);
  for (const bool right : {false, true}) {
    sensor_msgs::CameraInfo info = toCameraInfo(right ? calibration.right : calibration.left,
                                                camera,
                                                camera.cx,
                                                right ? -camera.fx * camera.baseline_m : 0.0);
    change(info);
    const std::string topic = right ? "/stereo/right" : "/stereo/left";
    bag.write(topic + "/camera_info", image.header.stamp, info);
    bag.write(topic + "/image_raw", image.header.stamp, image);
  }
}

TEST_F(RawBagTest, NamesWhatIsWrongWithTheCalibration) {
  using Info = sensor_msgs::CameraInfo;
  const auto expectRefused = [&](const std::function<void(Info&)>& change,
                                 const std::string& part) {
    const std::string wrong = directory_ / "wrong.bag";
    writeRawPair(wrong, change);
    const rosbag::Bag file = openBag(wrong);
    StereoBag bag(file, {});
    StereoPair pair;
    StereoCamera camera;
    expectError<std::runtime_error>([&] { bag.next(pair, camera); }, part);
  };
  expectRefused([](Info& info) { info.P[3] = 0.0; }, "s: the baseline is zero");
  expectRefused([](Info& info) { info.R[0] = 0.5; },
                "the rectification matrix R is not a rotation");
  expectRefused([](Info& info) { info.D.resize(3); },
                "D of the left camera_info: the distortion plumb_bob has 3 coefficients");
  expectRefused([](Info& info) { info.distortion_model = "mirror"; }, "'mirror' is not supported");
  expectRefused([](Info& info) { info.K[4] = -1.0; },
                "K of the left camera_info has focal lengths");
  expectRefused([](Info& info) { info.width = 640; }, "640x480");
}

}  // namespace
}  // namespace rotrocc
