#pragma once

#include <optional>
#include <string>

#include "sequences/calibration_file.h"
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
///   left.yaml, right.yaml    files of camera_calibration; not with SequenceOptions::calibration
///   left/*, right/*          images (png, jpg, bmp, tif, pgm, webp)
///   times.txt                their times, see pairFolders(); without it, they are their names
///   groundtruth.txt          poses of the left camera in TUM format; optional
/// The base is at the left camera, with x forward.
std::optional<StereoSequence> readFolderLayout(const std::string& directory,
                                               const SequenceOptions& options);

/// A sequence of the KITTI odometry benchmark; if it has no gray images, the color ones:
///   image_0/*, image_1/*     rectified left and right images; image_2 and image_3 in color
///   calib.txt                3x4 projection matrices, row by row: `P0:` and `P1:`; in color
///                            `P2:` and `P3:`
///   times.txt                their times [s], see pairFolders()
///   poses.txt                ground truth, one pose of the left camera per pair, or in TUM format
///                            with stamps around all times; optional
/// The base is KITTI's car.
std::optional<StereoSequence> readKittiLayout(const std::string& directory,
                                              const SequenceOptions& options);

/// A rectified raw drive of KITTI:
///   image_00/data/*, image_01/data/*    left and right images; or image_02 and image_03
///   image_00/timestamps.txt             date and time of each left image
///   calib_cam_to_cam.txt                `P_rect_00:` and `P_rect_01:`; may be beside the drive
/// The base is KITTI's car.
std::optional<StereoSequence> readKittiRawLayout(const std::string& directory,
                                                 const SequenceOptions& options);

/// Of the first left image.
cv::Size sizeOf(const ImagePairs& pairs);

/// Of the files of the options, or else what `readOwn` reads of the sequence.
template <class ReadOwn>
StereoCalibration calibrationOf(const SequenceOptions& options,
                                const ImagePairs& pairs,
                                const ReadOwn& readOwn) {
  return options.calibration.empty()
             ? readOwn()
             : readStereoCalibration(options.calibration,
                                     {options.baseline_m, [&] { return sizeOf(pairs); }});
}

}  // namespace rotrocc
