#include "check/rendered_recording.h"

#include <algorithm>
#include <map>
#include <memory>
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

struct RenderedDrive {
  std::shared_ptr<std::vector<StereoPair>> pairs = std::make_shared<std::vector<StereoPair>>();
  std::shared_ptr<std::vector<Eigen::Isometry3d>> poses =
      std::make_shared<std::vector<Eigen::Isometry3d>>();
};

RenderedDrive render(const std::string& name, const SimulationOptions& options) {
  Simulator simulator(scenario(name, options.seed), options);
  RenderedDrive drive;
  for (int i = 0; i < simulator.size(); ++i) {
    drive.pairs->push_back(simulator.render(i).pair);
    drive.pairs->back().stamp_ns += kStart_ns;
    drive.poses->push_back(simulator.pose(i));
  }
  return drive;
}

}  // namespace

RenderedRecording::RenderedRecording(const std::string& key,
                                     const std::string& scenario,
                                     const SimulationOptions& options,
                                     Faults faults)
    : camera_(options.camera), faults_(std::move(faults)) {
  static std::map<std::string, RenderedDrive> drives;
  if (drives.count(key) == 0) drives[key] = render(scenario, options);
  pairs_ = drives[key].pairs;
  poses_ = drives[key].poses;
}

ros::Time RenderedRecording::begin() const {
  return toRosTime(pairs_->front().stamp_ns);
}

ros::Time RenderedRecording::end() const {
  return toRosTime(pairs_->back().stamp_ns);
}

RecordedMessage RenderedRecording::infos(const ros::Time& stamp) const {
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

RecordedMessage RenderedRecording::firstInfos() const {
  return infos(begin());
}

GyroRecording RenderedRecording::gyroscope(const std::string& name) const {
  throw std::runtime_error("there is no gyroscope " + name);
}

void RenderedRecording::select(const ros::Time&, const ros::Time&, bool) {
  next_ = 0;
}

bool RenderedRecording::next(RecordedMessage& message) {
  if (next_ == pairs_->size()) return false;
  const auto index = static_cast<int>(next_++);
  message = infos(toRosTime((*pairs_)[static_cast<std::size_t>(index)].stamp_ns));
  const auto frame = [&](int shown) -> const StereoPair& {
    return (*pairs_)[static_cast<std::size_t>(std::clamp(shown, 0, size() - 1))];
  };
  const auto [left_frame, right_frame] = faults_.frames(index);
  cv::Mat left = frame(left_frame).left.clone();
  cv::Mat right = frame(right_frame).right.clone();
  faults_.images(left, right, index);
  message.left_image = cv_bridge::CvImage(message.left_info->header, "mono8", left).toImageMsg();
  message.right_image = cv_bridge::CvImage(message.right_info->header, "mono8", right).toImageMsg();
  return true;
}

}  // namespace rotrocc
