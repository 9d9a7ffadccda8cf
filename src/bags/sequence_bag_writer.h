#pragma once

#include <functional>
#include <string>

#include "bags/sequence_recording.h"

namespace rotrocc {

/// Writes a sequence as a bag:
///   /stereo/{left,right}/image_rect    sensor_msgs/Image, mono8 or mono16; image_raw if
///                                      not rectified
///   /stereo/{left,right}/camera_info   sensor_msgs/CameraInfo: of raw images with their K, D and R
///   /tf_static                         base_link -> stereo_left_optical: the rectified left camera
///   /ground_truth/path                 nav_msgs/Path of base_link in odom, once, if known
///   /ground_truth/pose                 geometry_msgs/PoseStamped, one per pair that has one
///   /imu/data                          sensor_msgs/Imu in imu_link, whose axes are those of
///                                      base_link; the angular velocity only, if there is one
/// Until it is complete, the bag is `path`.part, which is removed if anything fails. Throws
/// std::runtime_error if the file cannot be written or an image not read.
void writeSequenceBag(const std::string& path,
                      SequenceRecording& recording,
                      const std::function<void()>& on_pair = {});

/// The images of the sequence in `directory`, as they were recorded or rectified.
void writeSequenceBag(const std::string& path, const std::string& directory, bool rectify = false);

}  // namespace rotrocc
