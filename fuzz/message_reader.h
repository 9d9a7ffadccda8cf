#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <optional>

#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace rotrocc {

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

}  // namespace rotrocc
