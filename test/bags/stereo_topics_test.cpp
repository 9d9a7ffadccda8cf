#include "bags/stereo_topics.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

const char* const kImage = "sensor_msgs/Image";
const char* const kInfo = "sensor_msgs/CameraInfo";

/// Image topics, each with its camera_info.
TopicTypes withInfos(const std::vector<std::string>& images) {
  TopicTypes types = {{"/tf_static", "tf2_msgs/TFMessage"}};
  for (const std::string& image : images) {
    types[image] = kImage;
    const std::string name = image.substr(0, image.rfind("/compressed"));
    if (name != image) types[image] = "sensor_msgs/CompressedImage";
    types[name.substr(0, name.rfind('/')) + "/camera_info"] = kInfo;
  }
  return types;
}

/// The topic of a side, for the star of a name.
std::string topic(std::string name, const char* side) {
  return name.replace(name.find('*'), 1, side);
}

/// The left and right topics of these names.
std::vector<std::string> pairs(const std::vector<std::string>& names) {
  std::vector<std::string> images;
  for (const std::string& name : names) {
    for (const char* side : {"left", "right"}) images.push_back(topic(name, side));
  }
  return images;
}

TEST(FindStereoTopics, FindsThePairOfRealsenseViewer) {
  const std::string device = "/device_0/sensor_0/Infrared_";
  TopicTypes types;
  for (const std::string side : {"1", "2"}) {
    types[device + side + "/image/data"] = "sensor_msgs/Image";
    types[device + side + "/info/camera_info"] = "sensor_msgs/CameraInfo";
  }
  const StereoTopics topics = findStereoTopics(types);
  EXPECT_EQ(topics.left_image, device + "1/image/data");
  EXPECT_EQ(topics.right_info, device + "2/info/camera_info");
}

TEST(FindStereoTopics, FindsThePair) {
  const struct {
    const char* why;
    std::vector<std::string> pairs;
    std::string folder, image;
  } rows[] = {
      {"own bags", {"/stereo/*/image_rect"}, "/stereo/*", "/image_rect"},
      {"gray rather than color",
       {"/kitti/camera_color_*/image_raw", "/kitti/camera_gray_*/image_raw"},
       "/kitti/camera_gray_*",
       "/image_raw"},
      {"color if there is no gray",
       {"/kitti/camera_color_*/image_rect"},
       "/kitti/camera_color_*",
       "/image_rect"},
      {"rectified rather than raw",
       {"/camera/*/image_raw", "/camera/*/image_rect", "/camera/*/image_rect_color"},
       "/camera/*",
       "/image_rect"},
      {"images rather than compressed ones",
       {"/camera/*/image_raw", "/camera/*/image_raw/compressed"},
       "/camera/*",
       "/image_raw"},
      {"compressed ones if there are no others",
       {"/camera/*/image_raw/compressed", "/camera/*/image_raw/compressedDepth"},
       "/camera/*",
       "/image_raw/compressed"},
      {"the last left of a name",
       {"/left_arm/stereo/*/image_rect"},
       "/left_arm/stereo/*",
       "/image_rect"},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.why);
    const StereoTopics topics = findStereoTopics(withInfos(pairs(row.pairs)));
    EXPECT_EQ(topics.left_image, topic(row.folder, "left") + row.image);
    EXPECT_EQ(topics.right_image, topic(row.folder, "right") + row.image);
    EXPECT_EQ(topics.left_info, topic(row.folder, "left") + "/camera_info");
    EXPECT_EQ(topics.right_info, topic(row.folder, "right") + "/camera_info");
  }
}

TEST(FindStereoTopics, ListsTopicsWhenItCannotChoose) {
  const auto expectRejected = [](const TopicTypes& types, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
      expectError<std::runtime_error>([&] { findStereoTopics(types); }, part);
    }
  };
  expectRejected(withInfos(pairs({"/front/*/image_rect", "/rear/*/image_rect"})),
                 {"more than one stereo pair", "/rear/left/image_rect"});
  expectRejected(withInfos({"/cam0/image_rect"}), {"no stereo pair", "/cam0/image_rect"});
  expectRejected({}, {"image topics: none"});
  TopicTypes without_info = withInfos(pairs({"/stereo/*/image_rect"}));
  without_info.erase("/stereo/right/camera_info");
  expectRejected(without_info, {"no stereo pair"});
}

TEST(FindStereoTopics, KnowsOtherNamesOfTheCameras) {
  for (const std::string left : {"/cam0", "/camera/infra1"}) {
    const std::string right = left == "/cam0" ? "/cam1" : "/camera/infra2";
    TopicTypes types = withInfos({left + "/image_raw", right + "/image_raw"});
    EXPECT_EQ(findStereoTopics(types).right_info, right + "/camera_info");
    types.erase(right + "/camera_info");
    expectError<std::runtime_error>([&] { findStereoTopics(types); },
                                    "no stereo pair with camera_info: name its topics (left_info,");
    types["/calibration/left"] = types["/calibration/right"] = "sensor_msgs/CameraInfo";
    const StereoTopics elsewhere =
        findStereoTopics(types, {"", "", "/calibration/left", "/calibration/right"});
    EXPECT_EQ(elsewhere.right_image, right + "/image_raw");
    EXPECT_EQ(elsewhere.right_info, "/calibration/right");
    expectError<std::runtime_error>(
        [&] {
          findStereoTopics(types, {"", "", "/calibration/left", "/no"});
        },
        "no topic '/no'");
    EXPECT_EQ(findStereoTopics(types, {}, false).right_image, right + "/image_raw");
  }
}

TEST(FindStereoTopics, TakesTheNamedPair) {
  const TopicTypes types = withInfos({"/cam0/image_rect", "/cam1/image_rect"});
  const StereoTopics topics =
      findStereoTopics(types, {"/cam1/image_rect", "/cam0/image_rect", "", ""});
  EXPECT_EQ(topics.left_image, "/cam1/image_rect");
  EXPECT_EQ(topics.right_info, "/cam0/camera_info");
  expectError<std::runtime_error>(
      [&] {
        findStereoTopics(types, {"/cam0/camera_info", "/cam1/image_rect", "", ""});
      },
      "no topic '/cam0/camera_info' of type sensor_msgs/Image");
  expectError<std::runtime_error>(
      [&] {
        findStereoTopics(types, {"/cam0/image_rect", "", "", ""});
      },
      "both");
}

}  // namespace
}  // namespace rotrocc
