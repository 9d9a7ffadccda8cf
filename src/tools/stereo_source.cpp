#include "tools/stereo_source.h"

#include <filesystem>
#include <stdexcept>

#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "bags/bag_reading.h"
#include "bags/kitti_mount.h"
#include "bags/recorded_tf.h"
#include "input/gyro_conversion.h"
#include "rotrocc/kitti.h"

namespace rotrocc {
namespace {

GyroRecording readGyroTopic(const rosbag::Bag& bag,
                            const std::string& topic,
                            const std::string& base_frame,
                            const Eigen::Isometry3d& T_base_camera) {
  GyroRecording recording;
  std::string frame;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto message = readMessage<sensor_msgs::Imu>(instance);
    frame = message->header.frame_id;
    recording.samples.push_back(toGyroSample(*message));
  }
  if (recording.samples.empty()) {
    throw std::runtime_error("there is neither a file nor a topic " + topic + " with a gyroscope");
  }
  const RecordedTf tf(bag, base_frame, frame);
  if (tf.addedKittiMount()) {
    throw std::runtime_error("the bag has no tf from " + base_frame + " to '" + frame +
                             "', the frame of " + topic);
  }
  recording.R_camera_gyro = T_base_camera.linear().transpose() * tf.T_base_camera().linear();
  return recording;
}

class KittiSource : public StereoSource {
 public:
  explicit KittiSource(const std::string& directory)
      : directory_(directory), sequence_(directory) {}

  std::string description() const override { return "the pairs of " + directory_; }
  int size() const override { return sequence_.size(); }

  bool next(StereoPair& pair, StereoCamera& camera) override {
    if (next_ == sequence_.size()) return false;
    pair = {sequence_.stamp_ns(next_), sequence_.readLeft(next_), sequence_.readRight(next_)};
    camera = sequence_.camera();
    ++next_;
    return true;
  }

  Eigen::Isometry3d mount(const std::string&) const override { return kittiMount(); }
  GyroRecording gyroscope(const std::string& topic, const std::string&) const override {
    throw std::runtime_error("there is no file " + topic + " with a gyroscope");
  }
  std::int64_t start_ns() const override { return kKittiStart_s * 1'000'000'000; }

 private:
  std::string directory_;
  KittiSequence sequence_;
  int next_ = 0;
};

class BagSource : public StereoSource {
 public:
  BagSource(const std::string& path, const StereoBag::Options& options)
      : bag_(openBag(path)), pairs_(bag_, options) {}

  std::string description() const override {
    return pairs_.topics().left_image + " and " + pairs_.topics().right_image;
  }
  int size() const override { return pairs_.size(); }
  bool next(StereoPair& pair, StereoCamera& camera) override { return pairs_.next(pair, camera); }

  Eigen::Isometry3d mount(const std::string& base_frame) const override {
    const auto image = firstMessage<sensor_msgs::Image>(bag_, pairs_.topics().left_image);
    return RecordedTf(bag_, base_frame, image->header.frame_id).T_base_camera();
  }
  GyroRecording gyroscope(const std::string& topic, const std::string& base_frame) const override {
    return readGyroTopic(bag_, topic, base_frame, mount(base_frame));
  }
  std::int64_t start_ns() const override { return 0; }

 private:
  rosbag::Bag bag_;
  StereoBag pairs_;
};

}  // namespace

std::unique_ptr<StereoSource> openStereoSource(const std::string& path,
                                               const StereoBag::Options& bag_options) {
  if (std::filesystem::is_directory(path)) return std::make_unique<KittiSource>(path);
  return std::make_unique<BagSource>(path, bag_options);
}

}  // namespace rotrocc
