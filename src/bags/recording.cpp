#include "bags/recording.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_eigen/tf2_eigen.h>
#include <boost/make_shared.hpp>
#include <opencv2/imgcodecs.hpp>

#include "bags/bag_reading.h"
#include "bags/recorded_tf.h"
#include "bags/sequence_recording.h"
#include "bags/stereo_topics.h"
#include "input/camera_calibration.h"
#include "input/input_error.h"
#include "input/message_conversion.h"
#include "sequences/calibration_file.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void rejectEmpty(const std::string& topic) {
  throw std::runtime_error("the bag has no messages of " + topic);
}

bool isCompressed(const rosbag::MessageInstance& instance) {
  return instance.getDataType() == "sensor_msgs/CompressedImage";
}

/// The image that image_transport makes of a compressed one, but colors as bgr or bgra.
sensor_msgs::Image::ConstPtr decode(const sensor_msgs::CompressedImage& message) {
  cv::Mat pixels;
  try {
    if (!message.data.empty()) pixels = cv::imdecode(message.data, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // too many pixels
  }
  if (pixels.empty() || (pixels.depth() != CV_8U && pixels.depth() != CV_16U)) {
    throw InputError(DropReason::kImageData,
                     "a compressed image with " + std::to_string(message.data.size()) +
                         " bytes and the format \"" + message.format +
                         "\" cannot be decoded as gray or color image: is it damaged, or a depth "
                         "image?");
  }
  // "ENCODING; jpeg compressed ..."; older drivers omit it.
  const std::string recorded = message.format.substr(0, message.format.find(';'));
  const std::string bits = pixels.depth() == CV_8U ? "8" : "16";
  std::string encoding = (pixels.channels() == 3 ? "bgr" : "bgra") + bits;
  if (pixels.channels() == 1) {
    encoding = sensor_msgs::image_encodings::isBayer(recorded) ? recorded : "mono" + bits;
  }
  return cv_bridge::CvImage(message.header, encoding, pixels).toImageMsg();
}

sensor_msgs::Image::ConstPtr readImage(const rosbag::MessageInstance& instance) {
  if (isCompressed(instance)) return decode(*readMessage<sensor_msgs::CompressedImage>(instance));
  return readMessage<sensor_msgs::Image>(instance);
}

/// The frame of the first image.
std::string frameOf(const Bags& bags, const std::string& topic) {
  BagView view(bags, {topic});
  if (view.size() == 0) rejectEmpty(topic);
  const rosbag::MessageInstance first = *view.begin();
  return isCompressed(first) ? readMessage<sensor_msgs::CompressedImage>(first)->header.frame_id
                             : readMessage<sensor_msgs::Image>(first)->header.frame_id;
}

sensor_msgs::CameraInfo firstInfo(const Bags& bags, const std::string& topic) {
  const auto message = firstMessage<sensor_msgs::CameraInfo>(bags, topic);
  if (!message) rejectEmpty(topic);
  return *message;
}

sensor_msgs::CameraInfo::Ptr withHeader(sensor_msgs::CameraInfo info,
                                        const std_msgs::Header& header) {
  info.header = header;
  return boost::make_shared<sensor_msgs::CameraInfo>(std::move(info));
}

class BagRecording : public Recording {
 public:
  BagRecording(const std::vector<std::string>& paths, const RecordingOptions& options)
      : name_(paths.front() + (paths.size() > 1 ? " to " + paths.back() : "")),
        bags_(openBags(paths)),
        options_(options),
        topics_(findStereoTopics(topicTypes(bags_), options.topics, usesInfos())),
        camera_frame_(frameOf(bags_, topics_.left_image)) {
    if (usesInfos()) {
      left_info_ = firstInfo(bags_, topics_.left_info);
      right_info_ = firstInfo(bags_, topics_.right_info);
    } else {
      std::tie(left_info_, right_info_) = toCameraInfos(
          readStereoCalibration(options.sequence.calibration,
                                {options.sequence.baseline_m, [this] { return sizeOfImages(); }}));
      left_info_.header.frame_id = right_info_.header.frame_id = camera_frame_;
      topics_.left_info = topics_.right_info = "";
    }
    BagView view(bags_, topics_.all());
    begin_ = view.getBeginTime();
    end_ = view.getEndTime();
  }

  std::string description() const override {
    return topics_.left_image + " and " + topics_.right_image + " of " + name_;
  }

  int size() const override {
    return static_cast<int>(BagView(bags_, {topics_.left_image}).size());
  }

  bool isRaw() const override {
    if (isRectifiedByName(topics_.left_image) && !hasFilesOfItsImages()) return false;
    return hasRawCalibration();
  }

  bool hasRawCalibration() const override {
    return describeRawImages(left_info_, right_info_, options_.sequence.baseline_m);
  }

  std::string mountNote() const override { return tf().note(); }

  std::string truthNote() const override {
    if (tf().trajectory_name.empty()) return "";
    return "the bag's tf " + tf().trajectory_name +
           " is published as ground truth, not as tf: the odometry publishes the pose of the base";
  }

  ros::Time begin() const override { return begin_; }
  ros::Time end() const override { return end_; }
  RecordedMessage firstInfos() const override {
    RecordedMessage infos;
    infos.time = begin_;
    infos.left_info = boost::make_shared<sensor_msgs::CameraInfo>(left_info_);
    infos.right_info = boost::make_shared<sensor_msgs::CameraInfo>(right_info_);
    return infos;
  }
  tf2_msgs::TFMessage staticTransforms() const override { return tf().static_transforms; }
  Eigen::Isometry3d T_base_camera() const override { return tf().T_base_camera; }

  nav_msgs::Path truth() const override {
    const auto path = firstMessage<nav_msgs::Path>(bags_, "/ground_truth/path");
    return path ? *path : tf().trajectory;
  }

  GyroRecording gyroscope(const std::string& topic) const override {
    GyroRecording recording;
    std::string frame;
    for (const rosbag::MessageInstance& instance : BagView(bags_, {topic})) {
      const auto message = readMessage<sensor_msgs::Imu>(instance);
      frame = message->header.frame_id;
      recording.samples.push_back(toGyroSample(*message));
    }
    if (recording.samples.empty()) {
      throw std::runtime_error("there is neither a file nor a topic " + topic +
                               " with a gyroscope");
    }
    const RecordedTf tf_of_gyroscope = readTf(bags_, options_.base_frame, frame);
    for (const RecordedTf* sensor : {&tf_of_gyroscope, &tf()}) {
      if (!sensor->assumes_mount) continue;
      throw std::runtime_error("the bag has no tf from " + options_.base_frame + " to '" +
                               sensor->camera_frame +
                               "': how gyroscope and camera are turned is not known");
    }
    recording.R_camera_gyro =
        T_base_camera().linear().transpose() * tf_of_gyroscope.T_base_camera.linear();
    return recording;
  }

  void select(const ros::Time& from, const ros::Time& to, bool with_tf) override {
    std::vector<std::string> topics = topics_.all();
    if (with_tf) topics.insert(topics.end(), {"/tf", "tf"});
    selected_.emplace(bags_, topics, from, to);
    next_ = selected_->begin();
  }

  bool next(RecordedMessage& message) override {
    while (next_ != selected_->end()) {
      const rosbag::MessageInstance instance = *next_;
      ++next_;
      message = {};
      message.time = instance.getTime();
      const std::string& topic = instance.getTopic();
      if (topic == topics_.left_image) {
        message.left_image = readImage(instance);
        if (!usesInfos()) message.left_info = withHeader(left_info_, message.left_image->header);
      } else if (topic == topics_.right_image) {
        message.right_image = readImage(instance);
        if (!usesInfos()) message.right_info = withHeader(right_info_, message.right_image->header);
      } else if (topic == topics_.left_info) {
        message.left_info = readMessage<sensor_msgs::CameraInfo>(instance);
      } else if (topic == topics_.right_info) {
        message.right_info = readMessage<sensor_msgs::CameraInfo>(instance);
      } else {
        const auto recorded = readMessage<tf2_msgs::TFMessage>(instance);
        const auto kept = boost::make_shared<tf2_msgs::TFMessage>(tf().transformsToPlay(*recorded));
        if (kept->transforms.empty()) continue;
        message.tf = kept;
      }
      return true;
    }
    return false;
  }

 private:
  cv::Size sizeOfImages() const {
    BagView view(bags_, {topics_.left_image});
    const auto first = readImage(*view.begin());
    return {static_cast<int>(first->width), static_cast<int>(first->height)};
  }

  bool usesInfos() const { return options_.sequence.calibration.empty(); }

  /// Whether files describe the images of the topic, be they rectified or not: a camchain, or the
  /// files by which check_rig corrects rectified images, whose left one changes nothing.
  bool hasFilesOfItsImages() const {
    if (usesInfos()) return false;
    return options_.sequence.calibration.size() == 1 ||
           toStereoCalibration(left_info_, right_info_, options_.sequence.baseline_m)
               .isLeftRectified();
  }

  const RecordedTf& tf() const {
    if (!tf_) tf_ = readTf(bags_, options_.base_frame, camera_frame_);
    return *tf_;
  }

  std::string name_;
  Bags bags_;
  RecordingOptions options_;
  StereoTopics topics_;
  std::string camera_frame_;
  mutable std::optional<RecordedTf> tf_;  // read when it is needed: there may be much of it
  sensor_msgs::CameraInfo left_info_, right_info_;  // the first ones, or those of the calibration
  ros::Time begin_;
  ros::Time end_;
  std::optional<BagView> selected_;
  rosbag::View::iterator next_;
};

/// What is easily taken for a recording of ROS 1.
void rejectOtherThings(const std::string& path) {
  if (!fs::exists(path)) {
    // Programs of a launch file have their own working directory.
    throw std::runtime_error(fs::absolute(path).string() + " does not exist");
  }
  const std::string extension = fs::path(path).extension().string();
  std::string metadata;
  std::ifstream file(fs::path(path) / "metadata.yaml");
  std::getline(file, metadata);
  if (extension == ".db3" || extension == ".mcap" || metadata.rfind("rosbag2", 0) == 0) {
    throw std::runtime_error(path +
                             " is a bag of ROS 2: convert it with rosbags-convert (pip install "
                             "rosbags), or play it through ros1_bridge");
  }
  if (extension == ".active") {
    throw std::runtime_error(path +
                             " is still being recorded, or its recorder has died: end the "
                             "recorder, or run 'rosbag reindex' on it");
  }
}

/// Of a directory with nothing but files.
std::vector<std::string> bagsIn(const std::string& directory) {
  std::vector<std::string> bags;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    if (entry.is_directory()) return {};
    if (entry.path().extension() == ".bag") bags.push_back(entry.path().string());
  }
  std::sort(bags.begin(), bags.end());
  return bags;
}

}  // namespace

std::unique_ptr<Recording> openRecording(const std::vector<std::string>& paths,
                                         const RecordingOptions& options) {
  for (const std::string& path : paths) rejectOtherThings(path);
  if (paths.size() != 1 || !fs::is_directory(paths[0])) {
    return std::make_unique<BagRecording>(paths, options);
  }
  const std::string& directory = paths[0];
  if (const auto bags = bagsIn(directory); !bags.empty()) {
    return std::make_unique<BagRecording>(bags, options);
  }
  return std::make_unique<SequenceRecording>(directory, options);
}

nav_msgs::Path pathOfBase(const Trajectory& recorded, const Eigen::Isometry3d& T_base_body) {
  nav_msgs::Path path;
  path.header.frame_id = "odom";
  if (recorded.empty()) return path;

  const Eigen::Isometry3d T_first_world = recorded.front().T_world_body.inverse();
  for (const StampedPose& pose : recorded) {
    const Eigen::Isometry3d T_first_body = T_first_world * pose.T_world_body;
    geometry_msgs::PoseStamped message;
    message.header.frame_id = path.header.frame_id;
    message.header.stamp = toRosTime(pose.stamp_ns);
    message.pose = tf2::toMsg(T_base_body * T_first_body * T_base_body.inverse());
    path.poses.push_back(message);
  }
  path.header.stamp = path.poses.front().header.stamp;
  return path;
}

}  // namespace rotrocc
