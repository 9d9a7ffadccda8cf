#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nav_msgs/Path.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>
#include <Eigen/Geometry>

#include "player/player_options.h"

namespace rotrocc {

/// A message of a recording, and when it was recorded. One of the pointers is set.
struct RecordedMessage {
  ros::Time time;
  sensor_msgs::Image::ConstPtr left_image;
  sensor_msgs::Image::ConstPtr right_image;
  sensor_msgs::CameraInfo::ConstPtr left_info;
  sensor_msgs::CameraInfo::ConstPtr right_info;
  tf2_msgs::TFMessage::ConstPtr tf;
};

/// A stereo recording to replay, whatever its format is.
class Recording {
 public:
  virtual ~Recording() = default;

  /// For messages, e.g. "/stereo/left/image_rect and /stereo/right/image_rect of 06.bag".
  virtual std::string description() const = 0;

  /// Name of the topics of the images: image_rect, or image_raw if the odometry rectifies them.
  virtual std::string imageTopic() const { return "image_rect"; }

  /// How recorded poses are used; for the log.
  virtual std::vector<std::string> notes() const { return {}; }

  /// Times of the first and the last message.
  virtual ros::Time begin() const = 0;
  virtual ros::Time end() const = 0;

  virtual sensor_msgs::CameraInfo::ConstPtr firstLeftInfo() const = 0;
  virtual sensor_msgs::CameraInfo::ConstPtr firstRightInfo() const = 0;
  virtual tf2_msgs::TFMessage staticTransforms() const = 0;

  /// True path of the base in the frame odom; empty if it is not known.
  virtual const nav_msgs::Path& truth() const = 0;
  virtual Eigen::Isometry3d T_base_camera() const = 0;

  /// Selects the messages from `from` to `to`, both included.
  virtual void select(const ros::Time& from, const ros::Time& to) = 0;

  /// Whether the next message is there; in a recording that is being written it may not be yet.
  virtual bool hasNext() const { return true; }

  /// Reads the next selected message. Returns false at the end. Throws std::runtime_error if it is
  /// unreadable.
  virtual bool next(RecordedMessage& message) = 0;
};

/// Opens a bag, or the directory of a sequence: see openStereoSequence(). Throws std::exception if
/// it is neither, or unusable, as images that are not rectified are for an odometry that does not.
std::unique_ptr<Recording> openRecording(const PlayerOptions& options);

}  // namespace rotrocc
