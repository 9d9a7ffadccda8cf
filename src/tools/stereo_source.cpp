#include "tools/stereo_source.h"

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "bags/bag_reading.h"
#include "bags/recorded_tf.h"
#include "input/message_conversion.h"
#include "rectification/stereo_rectifier.h"
#include "sequences/stereo_sequence.h"

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

class SequenceSource : public StereoSource {
 public:
  explicit SequenceSource(std::unique_ptr<StereoSequence> sequence)
      : sequence_(std::move(sequence)) {
    const StereoCalibration& calibration = sequence_->calibration();
    if (!calibration.isRectified()) rectifier_.emplace(calibration);
  }

  std::string description() const override {
    return "the pairs of " + sequence_->directory() + (rectifier_ ? ", rectified" : "");
  }
  int size() const override { return sequence_->size(); }

  bool next(StereoPair& pair, StereoCamera& camera) override {
    if (next_ == sequence_->size()) return false;
    const StereoPair raw = sequence_->read(next_);
    pair = rectifier_ ? rectifier_->rectify(raw) : raw;
    camera = sequence_->calibration().rectified;
    ++next_;
    return true;
  }

  Eigen::Isometry3d mount(const std::string&) const override { return sequence_->T_base_camera(); }
  GyroRecording gyroscope(const std::string& name, const std::string&) const override {
    return sequence_->gyroscope(name);
  }
  std::int64_t start_ns() const override { return rosTimeOffset_ns(*sequence_); }
  std::string leftOut() const override { return sequence_->leftOut(); }

 private:
  std::unique_ptr<StereoSequence> sequence_;
  std::optional<StereoRectifier> rectifier_;
  int next_ = 0;
};

class BagSource : public StereoSource {
 public:
  BagSource(const std::string& path, const StereoBag::Options& options)
      : bag_(openBag(path)), pairs_(bag_, options) {}

  std::string description() const override {
    return pairs_.topics().left_image + " and " + pairs_.topics().right_image +
           (pairs_.rectifies() ? ", rectified by camera_info" : "");
  }
  int size() const override { return pairs_.size(); }
  bool next(StereoPair& pair, StereoCamera& camera) override {
    const bool is_pair = pairs_.next(pair, camera);
    if (is_pair) ++paired_;
    return is_pair;
  }

  Eigen::Isometry3d mount(const std::string& base_frame) const override {
    const auto image = firstMessage<sensor_msgs::Image>(bag_, pairs_.topics().left_image);
    return RecordedTf(bag_, base_frame, image->header.frame_id).T_base_camera();
  }
  GyroRecording gyroscope(const std::string& topic, const std::string& base_frame) const override {
    return readGyroTopic(bag_, topic, base_frame, mount(base_frame));
  }
  std::int64_t start_ns() const override { return 0; }
  std::string leftOut() const override {
    const int alone = pairs_.size() - paired_;
    return alone == 0 ? "" : std::to_string(alone) + " left images without a partner";
  }

 private:
  rosbag::Bag bag_;
  StereoBag pairs_;
  int paired_ = 0;
};

}  // namespace

std::unique_ptr<StereoSource> openStereoSource(const std::string& path,
                                               const StereoBag::Options& bag_options) {
  if (std::filesystem::is_directory(path)) {
    return std::make_unique<SequenceSource>(
        openStereoSequence(path, {bag_options.max_stamp_difference_s, bag_options.baseline_m}));
  }
  return std::make_unique<BagSource>(path, bag_options);
}

}  // namespace rotrocc
