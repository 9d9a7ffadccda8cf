#include "bags/recorded_pairs.h"

#include <functional>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "bags/bag_reading.h"
#include "bags/sequence_bag_writer.h"
#include "check/calibration_correction.h"
#include "sequences/calibration_file.h"
#include "support/asl_folder.h"
#include "support/expect_error.h"
#include "support/kitti2bag_writer.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 20;

/// A recording that is read pair by pair.
struct Reader {
  explicit Reader(const std::string& path,
                  const NodeParameters& node = {},
                  const RecordingOptions& options = {},
                  const std::string& rectify = "auto")
      : recording(openRecording({path}, options)), pairs(*recording, node, rectify) {}

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
  EXPECT_EQ(camera.differenceTo(expected), 0.0);
}

/// The sequence that the recordings of a test are made of.
class RecordedPairsTest : public ::testing::Test {
 protected:
  RecordedPairsTest() { writeSyntheticSequence(directory_ / "sequence", kPairs); }

  StereoSequence sequence() const { return openStereoSequence(directory_ / "sequence", {}); }

  /// Expects every pair of the sequence, to the last one, with the camera that P describes.
  void expectAllPairs(Reader& reader) const {
    const StereoSequence expected = sequence();
    EXPECT_EQ(reader.recording->size(), kPairs);
    for (int i = 0; i < kPairs; ++i) {
      ASSERT_TRUE(reader.next()) << "pair " << i;
      EXPECT_EQ(cv::norm(reader.pair.left, expected.read(i).left, cv::NORM_INF), 0.0) << i;
      EXPECT_EQ(cv::norm(reader.pair.right, expected.read(i).right, cv::NORM_INF), 0.0) << i;
      expectCamera(reader.camera, expected.calibration.rectified);
    }
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.pairs.leftOut(), "");
  }

  /// Writes what is left of a message, and returns true; or false: it stays as it is.
  using Change = std::function<bool(const rosbag::MessageInstance& message, rosbag::Bag& bag)>;

  /// A bag of the sequence, after a change.
  std::string writeChanged(const std::string& name, const Change& change) const {
    writeSequenceBag(directory_ / "own.bag", directory_ / "sequence");
    const Bags own = openBags({directory_ / "own.bag"});
    rosbag::Bag changed(directory_ / name, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : BagView(own)) {
      if (change(message, changed)) continue;
      changed.write(message.getTopic(), message.getTime(), message);
    }
    return directory_ / name;
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

TEST_F(RecordedPairsTest, AreThoseOfASequenceAndOfItsBag) {
  writeSequenceBag(directory_ / "own.bag", directory_ / "sequence");
  const std::int64_t last_ns = sequence().stamp_ns(kPairs - 1);
  for (const auto& [path, last] :
       {std::pair{"sequence", last_ns}, {"own.bag", 1'317'600'000'000'000'000 + last_ns}}) {
    Reader reader(directory_ / path);
    expectAllPairs(reader);
    EXPECT_EQ(reader.pair.stamp_ns, last);
  }
}

TEST_F(RecordedPairsTest, AreThoseOfBagsOfKitti2bag) {
  writeKitti2bagRaw(sequence(), directory_ / "raw.bag");
  Reader raw(directory_ / "raw.bag");
  EXPECT_EQ(raw.recording->description().find("/kitti/camera_gray_left/image_raw and "), 0u);
  expectAllPairs(raw);

  RecordingOptions color;
  color.topics.left_image = "/kitti/camera_color_left/image_raw";
  color.topics.right_image = "/kitti/camera_color_right/image_raw";
  Reader converted(directory_ / "raw.bag", {}, color);
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
  const std::string left_out = std::to_string(kPairs - pairs);
  EXPECT_EQ(reader.pairs.leftOut().find(left_out + " of 20 pairs ("), 0u);
  EXPECT_NE(reader.pairs.leftOut().find(" no_partner)"), std::string::npos);
}

TEST_F(RecordedPairsTest, BadImagesAreDroppedAndCounted) {
  int left = 0;
  const auto damage = [&](const rosbag::MessageInstance& message, rosbag::Bag& bag) {
    if (message.getTopic() != "/stereo/left/image_rect") return false;
    const auto image = readMessage<sensor_msgs::Image>(message);
    ++left;
    if (left == 3) image->data.resize(100);
    if (left == 6) image->header.stamp = ros::Time();
    if (left == 9) image->header.stamp += ros::Duration(50.0);
    bag.write(message.getTopic(), message.getTime(), image);
    return true;
  };
  Reader reader(writeChanged("damaged.bag", damage));
  std::vector<std::int64_t> expected, stamps;
  for (int i = 0; i < kPairs; ++i) {
    const bool is_bad = i == 2 || i == 5 || i == 8;
    if (!is_bad) expected.push_back(1'317'600'000'000'000'000 + sequence().stamp_ns(i));
  }
  while (reader.next()) stamps.push_back(reader.pair.stamp_ns);
  EXPECT_EQ(stamps, expected);
  EXPECT_EQ(reader.pairs.leftOut(),
            "3 of 20 pairs (1 image_data, 1 stamp_zero, 1 stamp_glitch, 2 partner_dropped)");
}

TEST(RecordedSequenceTest, ImagesOf16BitsAreScaledToTheirRange) {
  const AslFolder folder;
  for (int i = 0; i < 3; ++i) {
    const std::string name = std::to_string(AslFolder::stamp_ns(i)) + ".png";
    for (const char* camera : {"cam0/data/", "cam1/data/"}) {
      cv::imwrite(folder / (camera + name), cv::Mat(480, 752, CV_16UC1, cv::Scalar(2495)));
    }
  }
  for (const bool is_raw : {true, false}) {
    RecordingOptions options;
    options.raw_sequence = is_raw;
    Reader reader(folder.path(), {}, options);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(reader.pair.left.at<uchar>(240, 376), 2495 >> 4) << is_raw;
  }
}

TEST_F(RecordedPairsTest, CompressedImagesAreDecoded) {
  bool damaged = false;
  const auto compress = [&](const rosbag::MessageInstance& message, rosbag::Bag& bag) {
    if (message.getDataType() != "sensor_msgs/Image") return false;
    const auto image = readMessage<sensor_msgs::Image>(message);
    sensor_msgs::CompressedImage compressed;
    compressed.header = image->header;
    compressed.format = "mono8; png compressed ";
    const cv::Mat pixels(static_cast<int>(image->height),
                         static_cast<int>(image->width),
                         CV_8UC1,
                         image->data.data());
    cv::imencode(".png", pixels, compressed.data);
    if (std::exchange(damaged, false)) compressed.data.resize(50);
    bag.write(message.getTopic() + "/compressed", message.getTime(), compressed);
    return true;
  };
  Reader reader(writeChanged("compressed.bag", compress));
  EXPECT_EQ(reader.recording->description().find("/stereo/left/image_rect/compressed and "), 0u);
  expectAllPairs(reader);
  damaged = true;
  Reader without(writeChanged("damaged.bag", compress));
  while (without.next()) {
  }
  EXPECT_EQ(without.pairs.leftOut(), "1 of 20 pairs (1 image_data, 1 no_partner)");
}

TEST_F(RecordedPairsTest, BagsOfADirectoryAreOneRecording) {
  std::filesystem::create_directory(directory_ / "split");
  for (const bool is_first : {true, false}) {
    const auto keepHalf = [&](const rosbag::MessageInstance& message, rosbag::Bag&) {
      return (message.getTime() < ros::Time(1317600001.0)) != is_first;
    };
    writeChanged(is_first ? "split/drive_0.bag" : "split/drive_1.bag", keepHalf);
  }
  Reader reader(directory_ / "split");
  expectAllPairs(reader);
  EXPECT_FALSE(reader.recording->truth().poses.empty()) << "of the first bag";
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

  /// Whether its pairs are those of the sequence, rectified by its calibration, or by the files of
  /// the options.
  void expectRectified(const std::string& recording, const RecordingOptions& options = {}) {
    const bool is_rectified_as_read = recording == folder_.path() && !options.raw_sequence;
    SCOPED_TRACE(recording + (is_rectified_as_read ? ", rectified" : ", raw"));
    Reader reader(recording, {}, options);
    EXPECT_EQ(reader.pairs.rectifies(), !is_rectified_as_read);
    const auto calibration = std::make_shared<const StereoCalibration>(
        options.sequence.calibration.empty() ? sequence_.calibration
                                             : readStereoCalibration(options.sequence.calibration));
    StereoRectifier rectifier;
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(reader.next());
      const StereoPair expected = rectifier.rectify(sequence_.read(i), calibration);
      EXPECT_EQ(reader.pair.stamp_ns, AslFolder::stamp_ns(i));
      EXPECT_EQ(cv::norm(reader.pair.left, expected.left, cv::NORM_INF), 0.0);
      EXPECT_EQ(cv::norm(reader.pair.right, expected.right, cv::NORM_INF), 0.0);
      expectCamera(reader.camera, calibration->rectified);
    }
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.pairs.leftOut(), "");
    EXPECT_NEAR(reader.camera.baseline_m, sequence_.calibration.rectified.baseline_m, 1e-4);
  }

  /// A bag of its images alone, on topics of that name.
  std::string withoutInfos(const std::string& topic) {
    const Bags bags = openBags({path()});
    rosbag::Bag without(directory_ / "images.bag", rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : BagView(bags)) {
      if (message.getDataType() != "sensor_msgs/Image") continue;
      const bool is_left = message.getTopic().find("left") != std::string::npos;
      without.write((is_left ? "/cam0/" : "/cam1/") + topic, message.getTime(), message);
    }
    return without.getFileName();
  }

  AslFolder folder_;
  TemporaryDirectory directory_;
  StereoSequence sequence_;
};

TEST_F(RawBagTest, IsRectified) {
  expectRectified(path());
  expectRectified(folder_.path());
  RecordingOptions raw;
  raw.raw_sequence = true;
  expectRectified(folder_.path(), raw);
}

/// Of the rig.
const char* const kKalibrChain =
    "cam0:\n"
    "  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n"
    "  intrinsics: [458.654, 457.296, 367.215, 248.375]\n"
    "  resolution: [752, 480]\n"
    "cam1:\n"
    "  T_cn_cnm1:\n"
    "  - [0.999997256, 0.002312067, 0.000376008, -0.110073808]\n"
    "  - [-0.002317136, 0.999898049, 0.014089836, 0.000399122]\n"
    "  - [-0.000343393, -0.014090669, 0.999900663, -0.000853703]\n"
    "  - [0.0, 0.0, 0.0, 1.0]\n"
    "  camera_model: pinhole\n"
    "  distortion_model: radtan\n"
    "  distortion_coeffs: [-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05]\n"
    "  intrinsics: [457.587, 456.134, 379.999, 255.238]\n"
    "  resolution: [752, 480]\n";

TEST_F(RawBagTest, IsRectifiedByFilesInPlaceOfItsCalibration) {
  const std::string bag = withoutInfos("image_raw");
  expectError<std::runtime_error>(
      [&] { Reader{bag}; },
      "name its topics (left_info, right_info), or the files of a calibration");
  directory_.write("camchain.yaml", kKalibrChain);
  const std::string cameras = std::string(CAMERAS) + "/euroc_";
  using Files = std::vector<std::string>;
  for (const Files& files : {Files{directory_ / "camchain.yaml"},
                             Files{cameras + "left.yaml", cameras + "right.yaml"}}) {
    RecordingOptions options;
    options.sequence.calibration = files;
    expectRectified(bag, options);
    expectRectified(folder_.path(), options);
  }
}

/// A calibration of raw images says nothing of those that were rectified by it. One of the
/// rectified images, as check_rig corrects them, does.
TEST_F(RawBagTest, RectifiedImagesAreRectifiedByFilesOfTheirOwn) {
  const std::string bag = withoutInfos("image_rect");
  StereoCalibration corrected = rectifiedCalibration(sequence_.calibration.rectified);
  const auto rectifies = [&](const StereoCalibration& calibration) {
    writeCalibration(calibration, directory_ / "files");
    RecordingOptions options;
    options.sequence.calibration = {directory_ / "files/left.yaml",
                                    directory_ / "files/right.yaml"};
    return Reader(bag, {}, options).pairs.rectifies();
  };
  EXPECT_FALSE(rectifies(sequence_.calibration));
  EXPECT_FALSE(rectifies(corrected));
  corrected.right.cx += 0.5;
  EXPECT_TRUE(rectifies(corrected));
}

TEST_F(RawBagTest, MasksAreThoseOfTheRawImages) {
  cv::Mat mask(480, 752, CV_8UC1, cv::Scalar(0));
  mask.rowRange(400, 480).setTo(255);
  cv::imwrite(directory_ / "mask.png", mask);
  NodeParameters node;
  node.mask = directory_ / "mask.png";
  RecordingOptions raw;
  raw.raw_sequence = true;
  StereoRectifier rectifier;
  StereoPair expected = sequence_.read(0);
  expected.left_mask = mask;
  expected =
      rectifier.rectify(expected, std::make_shared<const StereoCalibration>(sequence_.calibration));
  for (const std::string& recording : {path(), folder_.path()}) {
    Reader reader(recording, node, raw);
    ASSERT_TRUE(reader.next());
    EXPECT_EQ(cv::norm(reader.pair.left_mask, expected.left_mask, cv::NORM_INF), 0.0);
  }
}

TEST_F(RawBagTest, IsLeftAsItIsOnRequest) {
  Reader reader(path(), {}, {}, "no");
  EXPECT_FALSE(reader.pairs.rectifies());
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(cv::norm(reader.pair.left, sequence_.read(0).left, cv::NORM_INF), 0.0);
  expectError<std::invalid_argument>([this] { Reader(path(), {}, {}, "maybe"); },
                                     "'maybe', not auto, yes or no");
}

}  // namespace
}  // namespace rotrocc
