#include "check/faulty_recording.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <cv_bridge/cv_bridge.h>
#include <boost/make_shared.hpp>

#include "input/camera_calibration.h"
#include "input/message_conversion.h"
#include "rectification/stereo_calibration.h"

namespace rotrocc {
namespace {

/// ROS has no stamp 0.
constexpr std::int64_t kStart_ns = 1'000'000'000'000;

std::string textOf(const CameraFaults& rig) {
  std::ostringstream text;
  text << rig.right_rotation_rad.transpose() << ' ' << rig.row_offset_px << ' '
       << rig.disparity_bias_px << ' ' << rig.time_skew_s << ' ' << rig.right_focal_ratio;
  return text.str();
}

}  // namespace

FaultyRecording::FaultyRecording(const std::string& scenario,
                                 const SimulationOptions& options,
                                 Faults faults)
    : camera_(options.camera), faults_(std::move(faults)), size_(options.frames) {
  static std::map<std::string, Drive> drives;
  Drive& drive = drives[scenario + " " + options.lens];
  std::vector<cv::Mat>& right = drive.right[textOf(options.faults)];
  const auto simulate = [&](const CameraFaults& rig) {
    SimulationOptions with_faults = options;
    with_faults.faults = rig;
    return Simulator(rotrocc::scenario(scenario, options.seed), with_faults);
  };
  if (static_cast<int>(drive.pairs.size()) < size_) {
    const Simulator simulator = simulate({});
    for (int i = static_cast<int>(drive.pairs.size()); i < size_; ++i) {
      drive.pairs.push_back(simulator.render(i).pair);
      drive.pairs.back().stamp_ns += kStart_ns;
      drive.poses.push_back(simulator.pose(i));
      drive.right[textOf({})].push_back(drive.pairs.back().right);
    }
  }
  if (static_cast<int>(right.size()) < size_) {
    const Simulator simulator = simulate(options.faults);
    for (int i = static_cast<int>(right.size()); i < size_; ++i) {
      right.push_back(simulator.renderRight(i));
    }
  }
  drive_ = &drive;
  right_ = &right;
}

FaultyRecording::FaultyRecording(const KittiSequence& sequence, Faults faults)
    : camera_(sequence.camera), faults_(std::move(faults)), size_(sequence.size()) {
  static std::map<std::string, Drive> drives;
  Drive& drive = drives[sequence.directory];
  std::vector<cv::Mat>& right = drive.right[""];
  for (int i = static_cast<int>(drive.pairs.size()); i < size_; ++i) {
    drive.pairs.push_back(sequence.pair(i));
    drive.pairs.back().stamp_ns += kStart_ns;
    right.push_back(drive.pairs.back().right);
  }
  drive_ = &drive;
  right_ = &right;
}

ros::Time FaultyRecording::begin() const {
  return toRosTime(pair(0).stamp_ns);
}

ros::Time FaultyRecording::end() const {
  return toRosTime(pair(size_ - 1).stamp_ns);
}

RecordedMessage FaultyRecording::infos(const ros::Time& stamp) const {
  auto [left, right] = toCameraInfos(rectifiedCalibration(camera_));
  faults_.info(right);
  left.header.stamp = right.header.stamp = stamp;
  left.header.frame_id = right.header.frame_id = "left";
  RecordedMessage message;
  message.time = stamp;
  message.left_info = boost::make_shared<sensor_msgs::CameraInfo>(left);
  message.right_info = boost::make_shared<sensor_msgs::CameraInfo>(right);
  return message;
}

RecordedMessage FaultyRecording::firstInfos() const {
  return infos(begin());
}

GyroRecording FaultyRecording::gyroscope(const std::string& name) const {
  throw std::runtime_error("there is no gyroscope " + name);
}

void FaultyRecording::select(const ros::Time&, const ros::Time&, bool) {
  next_ = 0;
}

bool FaultyRecording::next(RecordedMessage& message) {
  if (next_ == size_) return false;
  const int index = next_++;
  message = infos(toRosTime(pair(index).stamp_ns));
  const auto frame = [&](int shown) { return std::clamp(shown, 0, size_ - 1); };
  const auto [left_frame, right_frame] = faults_.frames(index);
  cv::Mat left = pair(frame(left_frame)).left.clone();
  cv::Mat right = right_->at(frame(right_frame)).clone();
  faults_.images(left, right, index);
  message.left_image = cv_bridge::CvImage(message.left_info->header, "mono8", left).toImageMsg();
  message.right_image = cv_bridge::CvImage(message.right_info->header, "mono8", right).toImageMsg();
  return true;
}

}  // namespace rotrocc
