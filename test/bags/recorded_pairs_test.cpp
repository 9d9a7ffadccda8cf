#include "bags/recorded_pairs.h"

#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "bags/sequence_bag_writer.h"
#include "rotrocc/kitti.h"
#include "support/asl_folder.h"
#include "support/expect_error.h"
#include "support/kitti2bag_writer.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 20;

/// A recording that is read pair by pair.
struct Reader {
  explicit Reader(const std::string& path,
                  const NodeParameters& node = {},
                  const RecordingOptions& options = {},
                  Rectify rectify = Rectify::kIfRaw)
      : recording(openRecording(path, options)), pairs(*recording, node, rectify) {}

  bool next() { return pairs.next(pair, camera); }

  std::unique_ptr<Recording> recording;
  RecordedPairs pairs;
  StereoPair pair;
  StereoCamera camera;
};

/// Expects a camera whose baseline is rounded, as camera_info has its product with fx.
void expectCamera(StereoCamera camera, const StereoCamera& expected) {
  EXPECT_DOUBLE_EQ(camera.baseline_m, expected.baseline_m);
  camera.baseline_m = expected.baseline_m;
  EXPECT_EQ(camera, expected);
}

/// The sequence that the recordings of a test are made of.
class RecordedPairsTest : public ::testing::Test {
 protected:
  RecordedPairsTest() { writeSyntheticSequence(directory_ / "sequence", kPairs); }

  KittiSequence sequence() const { return KittiSequence(directory_ / "sequence"); }

  /// Expects every pair of the sequence, to the last one, with the camera that P describes.
  void expectAllPairs(Reader& reader) const {
    const KittiSequence expected = sequence();
    EXPECT_EQ(reader.recording->size(), kPairs);
    for (int i = 0; i < kPairs; ++i) {
      ASSERT_TRUE(reader.next()) << "pair " << i;
      EXPECT_EQ(cv::norm(reader.pair.left, expected.readLeft(i), cv::NORM_INF), 0.0) << i;
      EXPECT_EQ(cv::norm(reader.pair.right, expected.readRight(i), cv::NORM_INF), 0.0) << i;
      expectCamera(reader.camera, expected.camera());
    }
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.pairs.leftOut(), "");
  }

  /// A bag with the same for left and right.
  std::string writePair(const sensor_msgs::CameraInfo& info,
                        const sensor_msgs::Image& image) const {
    rosbag::Bag bag(directory_ / "pair.bag", rosbag::bagmode::Write);
    for (const std::string side : {"left", "right"}) {
      bag.write("/stereo/" + side + "/camera_info", image.header.stamp, info);
      bag.write("/stereo/" + side + "/image_rect", image.header.stamp, image);
    }
    return directory_ / "pair.bag";
  }

  TemporaryDirectory directory_;
};

TEST_F(RecordedPairsTest, AreThoseOfASequence) {
  Reader reader(directory_ / "sequence");
  expectAllPairs(reader);
  EXPECT_EQ(reader.pair.stamp_ns, sequence().stamp_ns(kPairs - 1));
}

TEST_F(RecordedPairsTest, AreThoseOfOwnBags) {
  writeSequenceBag(directory_ / "own.bag", directory_ / "sequence", {1000, false});
  Reader reader(directory_ / "own.bag");
  expectAllPairs(reader);
  EXPECT_EQ(reader.pair.stamp_ns, 1000 * 1'000'000'000LL + sequence().stamp_ns(kPairs - 1));
}

TEST_F(RecordedPairsTest, AreThoseOfBagsOfKitti2bag) {
  writeKitti2bagRaw(sequence(), directory_ / "raw.bag");
  Reader raw(directory_ / "raw.bag");
  EXPECT_EQ(raw.recording->description().find("/kitti/camera_gray_left/image_raw and "), 0u);
  expectAllPairs(raw);

  RecordingOptions colour;
  colour.left_image = "/kitti/camera_color_left/image_raw";
  colour.right_image = "/kitti/camera_color_right/image_raw";
  Reader converted(directory_ / "raw.bag", {}, colour);
  expectAllPairs(converted);  // shades of gray, which the conversion keeps

  writeKitti2bagOdometry(sequence(), directory_ / "odometry.bag");
  Reader odometry(directory_ / "odometry.bag");
  EXPECT_EQ(odometry.recording->description().find("/kitti/camera_gray_left/image_rect and "), 0u);
  expectAllPairs(odometry);
}

TEST_F(RecordedPairsTest, ImagesWithoutAPartnerAreLeftOut) {
  writeKitti2bagRaw(sequence(), directory_ / "raw.bag");
  NodeParameters strict;
  strict.max_stamp_difference_s = 0.0035;  // half of the largest difference in the bag
  Reader reader(directory_ / "raw.bag", strict);
  int pairs = 0;
  while (reader.next()) ++pairs;
  EXPECT_GT(pairs, 0);
  EXPECT_LT(pairs, kPairs);
  EXPECT_EQ(reader.pairs.leftOut(),
            std::to_string(kPairs - pairs) + " left images without a partner");
}

TEST_F(RecordedPairsTest, TakeTheBaselineThatCameraInfoLacks) {
  sensor_msgs::CameraInfo info;
  info.width = info.height = 32;
  info.P = {40, 0, 16, 0, 0, 40, 16, 0, 0, 0, 1, 0};
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(12.5);
  image.encoding = "mono8";
  image.width = image.height = image.step = 32;
  image.data.resize(32 * 32);
  const std::string bag = writePair(info, image);
  Reader without(bag);
  expectError<std::runtime_error>([&] { without.next(); }, "set the parameter baseline_m");
  NodeParameters parameters;
  parameters.baseline_m = 0.37;
  Reader with(bag, parameters);
  ASSERT_TRUE(with.next());
  EXPECT_EQ(with.camera.baseline_m, 0.37);

  info.width = 16;
  Reader rectified(writePair(info, image), parameters, {}, Rectify::kAlways);
  expectError<std::runtime_error>([&] { rectified.next(); }, "s: the images are 32x32");
}

TEST_F(RecordedPairsTest, HaveNoMorePixelsThanTheLimit) {
  const StereoCamera size = sequence().camera();
  NodeParameters parameters;
  parameters.max_image_pixels = size.width * size.height - 1;
  Reader strict(directory_ / "sequence", parameters);
  expectError<std::runtime_error>([&] { strict.next(); }, "more than max_image_pixels = ");
  parameters.max_image_pixels = size.width * size.height;
  Reader reader(directory_ / "sequence", parameters);
  expectAllPairs(reader);
}

TEST_F(RecordedPairsTest, ThePairWhoseCameraIsWrongIsNamed) {
  sensor_msgs::CameraInfo uncalibrated;
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(12.5);
  Reader reader(writePair(uncalibrated, image));
  expectError<std::runtime_error>([&] { reader.next(); }, "pair of 12.5");
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
    writeSequenceBag(path(), folder_.path());
  }

  std::string path() const { return directory_ / "raw.bag"; }

  AslFolder folder_;
  TemporaryDirectory directory_;
  StereoSequence sequence_;
};

TEST_F(RawBagTest, IsRectified) {
  StereoRectifier rectifier;
  const auto calibration = std::make_shared<const StereoCalibration>(sequence_.calibration);
  for (const std::string& recording : {path(), folder_.path()}) {
    SCOPED_TRACE(recording);
    Reader reader(recording);
    EXPECT_EQ(reader.pairs.rectifies(), recording == path()) << "a sequence is, as it is read";
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(reader.next());
      const StereoPair expected = rectifier.rectify(sequence_.read(i), calibration);
      EXPECT_EQ(reader.pair.stamp_ns, AslFolder::stamp_ns(i));
      EXPECT_EQ(cv::norm(reader.pair.left, expected.left, cv::NORM_INF), 0.0);
      EXPECT_EQ(cv::norm(reader.pair.right, expected.right, cv::NORM_INF), 0.0);
      expectCamera(reader.camera, sequence_.calibration.rectified);
    }
    EXPECT_FALSE(reader.next());
  }
}

TEST_F(RawBagTest, IsLeftAsItIsOnRequest) {
  Reader reader(path(), {}, {}, rectifyOption("no"));
  EXPECT_FALSE(reader.pairs.rectifies());
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(cv::norm(reader.pair.left, sequence_.read(0).left, cv::NORM_INF), 0.0);
  expectError<std::invalid_argument>([] { rectifyOption("maybe"); },
                                     "'maybe', not auto, yes or no");
}

}  // namespace
}  // namespace rotrocc
