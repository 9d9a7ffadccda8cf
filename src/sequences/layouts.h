#pragma once

#include <optional>
#include <string>

#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// These read a directory, see openStereoSequence(), and throw like it; nothing if it has another
/// layout.

/// A recording in ASL format, as those of EuRoC; mav0 may be the directory itself:
///   mav0/cam0/data.csv, sensor.yaml, data/*.png    left camera: stamps [ns] and file names,
///                                                  intrinsics, distortion and pose on the body
///   mav0/cam1/...                                  right camera
///   mav0/imu0/data.csv, sensor.yaml                gyroscope and its pose; optional
///   mav0/state_groundtruth_estimate0/data.csv      poses of the body (position, quaternion w x y
///                                                  z), and the body's pose in sensor.yaml;
///                                                  optional
/// The base is the body. The pairs are rectified as chooseRectification() says.
std::optional<StereoSequence> readAslLayout(const std::string& directory,
                                            const SequenceOptions& options);

/// Images with the calibration of ROS:
///   left.yaml, right.yaml    files of camera_calibration
///   left/*, right/*          images (png, jpg, bmp, tif, pgm), in the order of their names
///   times.txt                one time [s] per pair; without it, the names of the images are their
///                            times: [ns] without a dot, [s] with one
///   groundtruth.txt          poses of the left camera in TUM format; optional
/// The base is at the left camera, with x forward.
std::optional<StereoSequence> readFolderLayout(const std::string& directory,
                                               const SequenceOptions& options);

}  // namespace rotrocc
