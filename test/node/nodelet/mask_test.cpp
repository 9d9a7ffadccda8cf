// A part of the images that has no features.

#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <opencv2/imgcodecs.hpp>

#include "nodelet_drive.h"
#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

const StereoCamera camera = SyntheticScene::defaultCamera();
constexpr int kMaskedRow = 90;  // and all below it

/// A mask of both images, or with "%s" in its name one of each.
std::string writeMask(const std::string& path, const cv::Size& size) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(0));
  mask.rowRange(kMaskedRow, mask.rows).setTo(255);
  EXPECT_TRUE(cv::imwrite(path, mask));
  return path;
}

TEST(MaskTest, MaskedPartsOfTheImagesHaveNoFeatures) {
  const TemporaryDirectory directory;
  writeMask(directory / "left.png", {camera.width, camera.height});
  writeMask(directory / "right.png", {camera.width, camera.height});
  NodeletDrive drive({{"mask", directory / "%s.png"}});
  Received<sensor_msgs::PointCloud2> inliers("inliers");
  Received<sensor_msgs::Image> flow("flow");
  drive.setUp();
  EXPECT_TRUE(waitUntil([&] {
    drive.statusOf(drive.robot.drive());
    return inliers.last() && inliers.last()->width > 20 && flow.last();
  }));
  const auto cloud = inliers.last();
  const auto picture = flow.last();
  ASSERT_TRUE(cloud && picture);
  for (sensor_msgs::PointCloud2ConstIterator<float> point(*cloud, "x"); point != point.end();
       ++point) {
    EXPECT_LT(camera.fy * point[1] / point[2] + camera.cy, kMaskedRow);
  }
  const auto colorAt = [&](int row) { return &picture->data.at(row * picture->step); };
  EXPECT_EQ(colorAt(kMaskedRow - 1)[2], colorAt(kMaskedRow - 1)[0]) << "gray";
  EXPECT_GT(colorAt(kMaskedRow)[2], colorAt(kMaskedRow)[0]) << "tinted red";
}

TEST(MaskTest, MasksThatCannotBeUsedAreNamed) {
  const TemporaryDirectory directory;
  const auto start = [&](const std::string& mask) { NodeletDrive({{"mask", mask}}); };
  directory.write("text.png", "no image");
  expectError([&] { start(directory / "none_%s.png"); },
              "none_left.png is missing; check the parameter mask");
  expectError([&] { start(directory / "text.png"); }, "text.png is not a readable image");

  NodeletDrive drive({{"mask", writeMask(directory / "small.png", {320, 240})}});
  drive.setUp();
  drive.robot.drive();
  const auto isDropped = [](const OdometryStatus& status) {
    return !status.drops.empty() && status.drops.front().reason == "image_size";
  };
  EXPECT_TRUE(drive.robot.statusThat(isDropped));
  EXPECT_FALSE(drive.log.with("small.png is 320x240 px: make it from an image").empty());
}

}  // namespace
}  // namespace rotrocc
