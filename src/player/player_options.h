#pragma once

#include <string>

#include <ros/node_handle.h>

#include "bags/stereo_topics.h"

namespace rotrocc {

/// Private parameters of the player, with the same names.
struct PlayerOptions {
  std::string bag;                  ///< path; or a directory, see openStereoSequence()
  StereoTopics topics;              ///< of a bag; empty: findStereoTopics()
  std::string calibration;          ///< files in place of camera_info, separated by spaces
  bool rectify = false;             ///< the odometry rectifies: it takes image_raw
  double rate = 1.0;                ///< times as fast as recorded; 0: as fast as possible
  double start = 0.0;               ///< offset from the start of the recording [s]
  double duration = 0.0;            ///< to play [s]; 0: to the end
  bool loop = false;                ///< repeats the recording
  bool paused = false;              ///< starts paused
  double lockstep_timeout_s = 0.0;  ///< longest wait for the odometry of each pair [s]; 0: none
  double image_timeout_s = 0.0;     ///< longest wait for a pair of a sequence that is being
                                    ///< written [s]; 0: all are there
  double max_stamp_difference_s = 0.01;  ///< between left and right image of a pair [s]
  std::string ground_truth_file;         ///< output of the true poses, in TUM format
  std::string base_frame = "base_link";  ///< frame whose recorded poses are ground truth
};

/// Throws std::invalid_argument if `bag` is missing or a value is out of range.
PlayerOptions readPlayerOptions(const ros::NodeHandle& private_nh);

/// The parameters with their defaults, for --help.
std::string describePlayerOptions();

}  // namespace rotrocc
