#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bags/recording.h"
#include "simulation/simulator.h"
#include "support/kitti_sequence.h"

namespace rotrocc {

/// A drive as a recording, with faults of images and of camera_info.
class FaultyRecording : public Recording {
 public:
  struct Faults {
    /// Which frames are shown at an index, left and right; clamped to those there are.
    std::function<std::pair<int, int>(int index)> frames = [](int index) {
      return std::pair(index, index);
    };
    std::function<void(cv::Mat& left, cv::Mat& right, int index)> images =
        [](cv::Mat&, cv::Mat&, int) {};
    std::function<void(sensor_msgs::CameraInfo& right)> info = [](sensor_msgs::CameraInfo&) {};
  };

  /// Renders `options.frames` frames, except what an earlier one has. All have the same camera.
  FaultyRecording(const std::string& scenario, const SimulationOptions& options, Faults faults);

  /// Reads the images once for all recordings of a sequence.
  FaultyRecording(const KittiSequence& sequence, Faults faults);

  std::string description() const override { return "a drive with faults"; }
  int size() const override { return size_; }
  bool isRaw() const override { return false; }
  ros::Time begin() const override;
  ros::Time end() const override;
  RecordedMessage firstInfos() const override;
  tf2_msgs::TFMessage staticTransforms() const override { return {}; }
  nav_msgs::Path truth() const override { return {}; }
  Eigen::Isometry3d T_base_camera() const override { return Eigen::Isometry3d::Identity(); }
  GyroRecording gyroscope(const std::string& name) const override;
  void select(const ros::Time& from, const ros::Time& to, bool with_tf) override;
  bool next(RecordedMessage& message) override;

  /// T_first_left of a rendered drive.
  const Eigen::Isometry3d& pose(int index) const { return drive_->poses.at(index); }

 private:
  struct Drive {
    std::vector<StereoPair> pairs;
    std::vector<Eigen::Isometry3d> poses;               ///< T_first_left
    std::map<std::string, std::vector<cv::Mat>> right;  ///< by the faults of the rig
  };

  const StereoPair& pair(int index) const { return drive_->pairs.at(index); }
  RecordedMessage infos(const ros::Time& stamp) const;

  StereoCamera camera_;
  Faults faults_;
  const Drive* drive_;  ///< may have more frames
  const std::vector<cv::Mat>* right_;
  int size_;
  int next_ = 0;
};

}  // namespace rotrocc
