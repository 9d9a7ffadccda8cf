#pragma once

#include <string>

#include <ros/node_handle.h>

namespace rotrocc {

/// What the player is told by its private parameters of the same names.
struct PlayerOptions {
  std::string bag;         ///< path
  std::string left_image;  ///< topics of the pair, if findStereoTopics() cannot tell
  std::string right_image;
  double rate = 1.0;                     ///< times as fast as recorded; 0: as fast as possible
  double start = 0.0;                    ///< begins that long after the bag's begin [s]
  double duration = 0.0;                 ///< plays that much of the bag [s]; 0: to its end
  bool loop = false;                     ///< begins anew at the end
  bool paused = false;                   ///< begins with a pause
  bool lockstep = false;                 ///< waits for the odometry of each pair
  double lockstep_timeout_s = 10.0;      ///< but not longer than that [s]
  double max_stamp_difference_s = 0.01;  ///< between left and right image of a pair [s]
  std::string ground_truth_file;  ///< for true poses of the left camera, see writeGroundTruth()
  std::string base_frame = "base_link";  ///< of the vehicle, whose recorded poses are ground truth
};

/// Throws std::invalid_argument on a missing bag or a value out of range.
PlayerOptions readPlayerOptions(const ros::NodeHandle& private_nh);

}  // namespace rotrocc
