#include "bags/stereo_topics.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

const char* const kImage = "sensor_msgs/Image";
const char* const kInfo = "sensor_msgs/CameraInfo";

void addCamera(TopicTypes& types, const std::string& camera, const std::string& image) {
  types[camera + "/" + image] = kImage;
  types[camera + "/camera_info"] = kInfo;
}

void addPair(TopicTypes& types, const std::string& prefix, const std::string& image) {
  addCamera(types, prefix + "left", image);
  addCamera(types, prefix + "right", image);
}

TEST(FindStereoTopics, FindsImagesAndInfosOfOwnBags) {
  TopicTypes types = {{"/tf_static", "tf2_msgs/TFMessage"}};
  addPair(types, "/stereo/", "image_rect");
  const StereoTopics topics = findStereoTopics(types);
  EXPECT_EQ(topics.left_image, "/stereo/left/image_rect");
  EXPECT_EQ(topics.right_image, "/stereo/right/image_rect");
  EXPECT_EQ(topics.left_info, "/stereo/left/camera_info");
  EXPECT_EQ(topics.right_info, "/stereo/right/camera_info");
}

TEST(FindStereoTopics, PrefersGrayToColour) {
  TopicTypes types;
  addPair(types, "/kitti/camera_color_", "image_raw");
  addPair(types, "/kitti/camera_gray_", "image_raw");
  EXPECT_EQ(findStereoTopics(types).left_image, "/kitti/camera_gray_left/image_raw");
}

TEST(FindStereoTopics, TakesColourIfThereIsNoGray) {
  TopicTypes types;
  addPair(types, "/kitti/camera_color_", "image_rect");
  EXPECT_EQ(findStereoTopics(types).right_image, "/kitti/camera_color_right/image_rect");
}

TEST(FindStereoTopics, PrefersRectifiedToRaw) {
  TopicTypes types;
  addPair(types, "/camera/", "image_raw");
  addPair(types, "/camera/", "image_rect");
  addPair(types, "/camera/", "image_rect_color");
  EXPECT_EQ(findStereoTopics(types).left_image, "/camera/left/image_rect");
}

TEST(FindStereoTopics, ChangesOnlyTheLastLeftOfAName) {
  TopicTypes types;
  addPair(types, "/left_arm/stereo/", "image_rect");
  EXPECT_EQ(findStereoTopics(types).right_image, "/left_arm/stereo/right/image_rect");
}

TEST(FindStereoTopics, ListsTopicsWhenItCannotChoose) {
  TopicTypes types;
  addPair(types, "/front/", "image_rect");
  addPair(types, "/rear/", "image_rect");
  expectError<std::runtime_error>([&] { findStereoTopics(types); }, "more than one stereo pair");
  expectError<std::runtime_error>([&] { findStereoTopics(types); }, "/rear/left/image_rect");
}

TEST(FindStereoTopics, ListsTopicsWhenThereIsNoPair) {
  TopicTypes types;
  addCamera(types, "/cam0", "image_rect");
  expectError<std::runtime_error>([&] { findStereoTopics(types); }, "no stereo pair");
  expectError<std::runtime_error>([&] { findStereoTopics(types); }, "/cam0/image_rect");
  expectError<std::runtime_error>([] { findStereoTopics({}); }, "image topics: none");
}

TEST(FindStereoTopics, WantsACameraInfoBesideEachImage) {
  TopicTypes types;
  addPair(types, "/stereo/", "image_rect");
  types.erase("/stereo/right/camera_info");
  expectError<std::runtime_error>([&] { findStereoTopics(types); }, "no stereo pair");
}

TEST(FindStereoTopics, TakesTheNamedPair) {
  TopicTypes types;
  addCamera(types, "/cam0", "image_rect");
  addCamera(types, "/cam1", "image_rect");
  const StereoTopics topics = findStereoTopics(types, "/cam1/image_rect", "/cam0/image_rect");
  EXPECT_EQ(topics.left_image, "/cam1/image_rect");
  EXPECT_EQ(topics.right_info, "/cam0/camera_info");
}

TEST(FindStereoTopics, RefusesNamesThatAreNoImages) {
  TopicTypes types;
  addPair(types, "/stereo/", "image_rect");
  expectError<std::runtime_error>(
      [&] { findStereoTopics(types, "/stereo/left/camera_info", "/stereo/right/image_rect"); },
      "no topic '/stereo/left/camera_info' of type sensor_msgs/Image");
  expectError<std::runtime_error>([&] { findStereoTopics(types, "/stereo/left/image_rect"); },
                                  "both");
}

}  // namespace
}  // namespace rotrocc
