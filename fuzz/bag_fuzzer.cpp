// Bags with arbitrary messages: seven numbers of a transform, then camera_info and images of both
// cameras. The file itself is always intact: a damaged one would crash rosbag before our code reads
// it, because ros::Header::parse() reads beyond its buffer.

#include <dlfcn.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include <console_bridge/console.h>
#include <rosbag/bag.h>
#include <std_msgs/Empty.h>
#include <tf2_msgs/TFMessage.h>

#include "bags/recorded_tf.h"
#include "bags/stereo_bag.h"
#include "message_reader.h"

namespace rotrocc {
namespace {

constexpr char kPath[] = "in memory";
const ros::Time kTime(1000.0);

tf2_msgs::TFMessage toTf(const std::array<double, 7>& numbers) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message.transforms[0];
  transform.header.frame_id = "base_link";
  transform.child_frame_id = "camera";
  transform.transform.translation.x = numbers[0];
  transform.transform.translation.y = numbers[1];
  transform.transform.translation.z = numbers[2];
  transform.transform.rotation.x = numbers[3];
  transform.transform.rotation.y = numbers[4];
  transform.transform.rotation.z = numbers[5];
  transform.transform.rotation.w = numbers[6];
  return message;
}

void writeMessages(rosbag::Bag& bag, const std::array<double, 7>& mount, MessageReader reader) {
  tf2_msgs::TFMessage tf = toTf(mount);
  bag.write("/tf_static", kTime, tf);
  std::swap(tf.transforms[0].header.frame_id, tf.transforms[0].child_frame_id);
  bag.write("/tf", kTime, tf);  // a trajectory of the base
  const char* const sides[] = {"/camera_left", "/camera_right"};
  for (const std::string side : sides) {
    if (const auto info = reader.cameraInfo()) bag.write(side + "/camera_info", kTime, *info);
  }
  for (const std::string side : sides) {
    if (const auto image = reader.image()) bag.write(side + "/image_rect", kTime, *image);
  }
}

/// A bag keeps a chunk in memory until it is full, even if the bag is closed and reopened. This
/// makes it full.
void forgetChunk(rosbag::Bag& bag) {
  bag.setChunkThreshold(0);
  bag.write("/end", kTime, std_msgs::Empty());
}

void readPairs(const rosbag::Bag& bag) {
  StereoBag pairs(bag, {});
  StereoPair pair;
  StereoCamera camera;
  while (pairs.next(pair, camera)) cv::sum(pair.left + pair.right);
}

}  // namespace
}  // namespace rotrocc

/// Replaces the function of the C library, so that the bag is written to memory. With a file, the
/// system calls for each record would take as much time as everything else.
extern "C" std::FILE* fopen64(const char* path, const char* mode) {
  static std::array<char, 100'000> memory;
  if (std::strcmp(path, rotrocc::kPath) == 0) return fmemopen(memory.data(), memory.size(), mode);
  static const auto open =
      reinterpret_cast<std::FILE* (*)(const char*, const char*)>(dlsym(RTLD_NEXT, "fopen64"));
  return open(path, mode);
}

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);  // log messages of tf2
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  // Reuse one bag: creating one searches for all ROS plugins, which takes longer than everything
  // else.
  static rosbag::Bag bag;
  std::array<double, 7> mount;
  if (size < sizeof(mount)) return -1;  // not added to the corpus
  std::memcpy(mount.data(), data, sizeof(mount));
  // The messages are read back from the chunk in memory.
  bag.open(kPath, rosbag::bagmode::Write | rosbag::bagmode::Read);
  writeMessages(bag, mount, MessageReader(data + sizeof(mount), size - sizeof(mount)));
  try {
    readPairs(bag);
  } catch (const std::runtime_error&) {  // programs print the message and exit
  }
  try {
    RecordedTf(bag, "base_link", "camera").trajectory();
  } catch (const std::runtime_error&) {
  }
  forgetChunk(bag);
  bag.close();
  return 0;
}
