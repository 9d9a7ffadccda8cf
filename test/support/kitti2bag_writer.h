#pragma once

#include <string>

#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// Writes a bag of the shape kitti2bag (github.com/tomas789/kitti2bag) gives to raw drives, as far
/// as a stereo odometry depends on it: /kitti/camera_{gray,color}_{left,right}/image_raw whose
/// stamps differ by up to 7 ms between left and right; camera_info with K, D and R of the
/// unrectified images, so that only P is valid for those in the bag; mounts in /tf_static, again at
/// every stamp; world -> base_link in /tf.
void writeKitti2bagRaw(const StereoSequence& sequence, const std::string& path);

/// Writes a bag of the shape kitti2bag gives to gray odometry sequences:
/// /kitti/camera_gray_{left,right}/image_rect; camera_info with nothing but size and P; world ->
/// camera_left in /tf, where camera_left is not the frame of the images; no mounts.
void writeKitti2bagOdometry(const StereoSequence& sequence, const std::string& path);

}  // namespace rotrocc
