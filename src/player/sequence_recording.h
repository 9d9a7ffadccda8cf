#pragma once

#include <deque>
#include <memory>

#include "bags/sequence_messages.h"
#include "player/recording.h"

namespace rotrocc {

/// A sequence of images, rectified if it is not. It may still be written by another program, e.g.
/// simulate_drive.
class SequenceRecording : public Recording {
 public:
  /// Throws like openStereoSequence().
  explicit SequenceRecording(const PlayerOptions& options);

  std::string description() const override { return sequence_->directory(); }
  ros::Time begin() const override { return messages_.stamp(0); }
  ros::Time end() const override { return messages_.stamp(sequence_->size() - 1); }
  sensor_msgs::CameraInfo::ConstPtr firstLeftInfo() const override;
  sensor_msgs::CameraInfo::ConstPtr firstRightInfo() const override;
  tf2_msgs::TFMessage staticTransforms() const override { return messages_.mounts(); }
  const nav_msgs::Path& truth() const override { return messages_.groundTruth(); }
  Eigen::Isometry3d T_base_camera() const override { return sequence_->T_base_camera(); }
  void select(const ros::Time& from, const ros::Time& to) override;
  bool hasNext() const override;
  bool next(RecordedMessage& message) override;

 private:
  bool atEnd() const;
  void readPair();

  std::unique_ptr<StereoSequence> sequence_;
  SequenceMessages messages_;
  int next_pair_ = 0;
  ros::Time last_;
  std::deque<RecordedMessage> of_pair_;  // read, but not yet returned
};

}  // namespace rotrocc
