// Serialized camera_info and images of both cameras: all parts of the odometry that need no ROS
// master.

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <vector>

#include <ros/console.h>
#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <boost/make_shared.hpp>
#include <opencv2/core/utility.hpp>

#include "input/input_error.h"
#include "input/message_conversion.h"
#include "input/stereo_intake.h"
#include "node/base/pair_processor.h"
#include "require.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {
namespace {

/// Reads serialized messages, one after the other, as roscpp receives them from a connection.
class MessageReader {
 public:
  MessageReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  /// None if no complete message is left.
  std::optional<sensor_msgs::Image> image() {
    return read<sensor_msgs::Image>({12, kBytes, 8, kBytes, 5, kBytes});
  }
  std::optional<sensor_msgs::CameraInfo> cameraInfo() {
    return read<sensor_msgs::CameraInfo>({12, kBytes, 8, kBytes, kDoubles, 265});
  }

 private:
  /// Fields of variable length: a 32-bit count, then that many elements.
  static constexpr int kBytes = -1;
  static constexpr int kDoubles = -8;

  /// `fields` are sizes in bytes. roscpp allocates the memory for a count, up to 32 GB, before it
  /// checks the size of the message. Therefore the counts are checked here first.
  template <class Message>
  std::optional<Message> read(std::initializer_list<int> fields) {
    std::uint64_t length = 0;
    for (const int field : fields) {
      std::uint64_t bytes = static_cast<std::uint64_t>(std::abs(field));
      if (field < 0) {
        std::uint32_t count = 0;
        if (length + sizeof(count) > size_) return std::nullopt;
        std::memcpy(&count, data_ + length, sizeof(count));
        bytes = sizeof(count) + bytes * count;
      }
      length += bytes;
      if (length > size_) return std::nullopt;
    }
    Message message;
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(data_),
                                       static_cast<std::uint32_t>(length));
    ros::serialization::deserialize(stream, message);
    data_ += length;
    size_ -= length;
    return message;
  }

  const std::uint8_t* data_;
  std::size_t size_;
};

using Side = StereoIntake::Side;

constexpr int kPairs = 3;  // the first one, one compared with it, and one with a motion before it

Parameters makeParameters() {
  Parameters parameters;
  return parameters;
}

/// Shifts all rows up by one, so that a motion is visible.
void moveUp(sensor_msgs::Image& image) {
  if (image.step >= image.data.size()) return;
  const auto second = image.data.begin() + image.step;
  const std::vector<std::uint8_t> first(image.data.begin(), second);
  std::copy(first.begin(), first.end(), std::copy(second, image.data.end(), image.data.begin()));
}

void drive(const sensor_msgs::CameraInfo& left_info,
           const sensor_msgs::CameraInfo& right_info,
           sensor_msgs::Image left,
           sensor_msgs::Image right) {
  const Parameters parameters = makeParameters();
  PairProcessor processor(parameters);
  DropLog drops;
  StereoIntake intake(parameters.node, drops, [&](const ReceivedPair& pair) {
    try {
      const PairInput in = {processor.convert(pair), pair.arrival, pair.camera, kittiMount()};
      const PairAnswer answer = processor.process(in);
      processor.inspect(in);
      require(answer.result.T_prev_cur.matrix().allFinite(), "the motion is finite");
      require(answer.result.covariance.allFinite(), "the covariance is finite");
      require(answer.state.T_odom_base.T.matrix().allFinite(), "the pose is finite");
    } catch (const InputError& error) {
      drops.add(error);
    }
  });
  const std::chrono::steady_clock::time_point start;
  intake.addInfo(Side::kLeft, boost::make_shared<sensor_msgs::CameraInfo>(left_info), {start, 0});
  intake.addInfo(Side::kRight, boost::make_shared<sensor_msgs::CameraInfo>(right_info), {start, 0});
  for (int i = 0; i < kPairs; ++i) {
    const Arrival arrival{start + std::chrono::milliseconds(100 * i), 0};
    intake.addImage(Side::kLeft, boost::make_shared<sensor_msgs::Image>(left), arrival);
    intake.addImage(Side::kRight, boost::make_shared<sensor_msgs::Image>(right), arrival);
    for (sensor_msgs::Image* image : {&left, &right}) {
      image->header.stamp =
          toRosTime(toNanoseconds(image->header.stamp) % 1'000'000'000'000 + 100'000'000);
      moveUp(*image);
    }
  }
  intake.report(start);
}

}  // namespace
}  // namespace rotrocc

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal);
  cv::setNumThreads(1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rotrocc::MessageReader reader(data, size);
  const auto left_info = reader.cameraInfo();
  if (!left_info) return -1;  // not added to the corpus
  const auto right_info = reader.cameraInfo();
  if (!right_info) return -1;
  const auto left = reader.image();
  if (!left) return -1;
  const auto right = reader.image();
  rotrocc::drive(*left_info, *right_info, *left, right.value_or(*left));
  return 0;
}
