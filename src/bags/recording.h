#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nav_msgs/Path.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>
#include <Eigen/Geometry>

#include "bags/stereo_topics.h"
#include "rotrocc/trajectory.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// What was recorded at a time: one message, an image with its camera_info, or all of a pair. The
/// other pointers are null.
struct RecordedMessage {
  ros::Time time;
  sensor_msgs::Image::ConstPtr left_image;
  sensor_msgs::Image::ConstPtr right_image;
  sensor_msgs::CameraInfo::ConstPtr left_info;
  sensor_msgs::CameraInfo::ConstPtr right_info;
  tf2_msgs::TFMessage::ConstPtr tf;
};

/// A stereo recording as messages of ROS, whatever its format is.
class Recording {
 public:
  virtual ~Recording() = default;

  /// For messages, e.g. "/stereo/left/image_rect and /stereo/right/image_rect of 06.bag".
  virtual std::string description() const = 0;

  /// An upper bound of the number of pairs.
  virtual int size() const = 0;

  /// Whether the images have to be rectified.
  virtual bool isRaw() const = 0;

  /// Whether the calibration is of raw images. Those of a topic of rectified images may have one,
  /// see isRectifiedByName().
  virtual bool hasRawCalibration() const { return isRaw(); }

  /// For the log: which mount of the camera is assumed, and how recorded poses are used; or empty.
  virtual std::string mountNote() const { return ""; }
  virtual std::string truthNote() const { return ""; }

  /// Times of the first and the last image or camera_info.
  virtual ros::Time begin() const = 0;
  virtual ros::Time end() const = 0;

  /// From the stamps of the recording to those of the messages: ROS does not accept stamp 0.
  virtual std::int64_t offset_ns() const { return 0; }

  /// The first camera_info of both cameras, with the time begin().
  virtual RecordedMessage firstInfos() const = 0;
  virtual tf2_msgs::TFMessage staticTransforms() const = 0;

  /// True path of the base in the frame odom; empty if it is not known.
  virtual nav_msgs::Path truth() const = 0;
  virtual Eigen::Isometry3d T_base_camera() const = 0;

  /// The gyroscope of a topic of a bag, with its mount from tf, or of a folder or file of a
  /// sequence, with the stamps of the recording. Throws std::runtime_error if there is none of that
  /// name.
  virtual GyroRecording gyroscope(const std::string& name) const = 0;

  /// Selects the messages from `from` to `to`, both included. Without tf it is not read.
  virtual void select(const ros::Time& from, const ros::Time& to, bool with_tf) = 0;

  /// Whether the next message is there; in a recording that is being written it may not be yet.
  virtual bool hasNext() const { return true; }

  /// Reads the next selected message. Returns false at the end. Throws InputError if an image
  /// cannot be decoded, which the next call skips, and std::runtime_error if the recording is
  /// unreadable.
  virtual bool next(RecordedMessage& message) = 0;

  /// Images that were left out, e.g. "1 left image and 0 right images without a partner"; empty if
  /// none.
  virtual std::string leftOut() const { return ""; }
};

struct RecordingOptions {
  StereoTopics topics;                   ///< of a bag; empty: findStereoTopics()
  std::string base_frame = "base_link";  ///< of a bag: its recorded poses are the true path
  bool raw_sequence = false;  ///< images of a sequence as they were recorded; otherwise rectified
  SequenceOptions sequence;   ///< its calibration also in place of camera_info
};

/// Opens a stereo bag, whatever its topics are, several bags or a directory of bags as one, or the
/// directory of a sequence: see openStereoSequence(). Recorded poses of the base in a bag are its
/// true path, not tf: the odometry publishes the pose of the base. Throws std::runtime_error if
/// `paths` are none of these, or have no stereo pair.
std::unique_ptr<Recording> openRecording(const std::vector<std::string>& paths,
                                         const RecordingOptions& options = {});

/// Converts a recorded trajectory of a body to the path of the base it is mounted on, relative to
/// the first pose of the base, where the odometry starts: in the frame odom.
nav_msgs::Path pathOfBase(const Trajectory& recorded, const Eigen::Isometry3d& T_base_body);

}  // namespace rotrocc
