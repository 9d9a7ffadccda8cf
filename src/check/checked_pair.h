#pragma once

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// A pair of a recording, with what the odometry made of it.
struct CheckedPair {
  double time_s;  ///< since the first pair
  const StereoPair& images;
  const StereoCamera& camera;
  const OdometryResult& result;
  const Correspondences& features;  ///< between the keyframe and this pair
  const FeatureSet& inliers;        ///< of these, those that agree with the motion
};

}  // namespace rotrocc
