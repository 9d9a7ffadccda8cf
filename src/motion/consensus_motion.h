#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// When features agree on a motion, and how many motions are tried.
struct ConsensusLimits {
  double tolerance;  ///< of reprojection errors, in details of the images [camera.detail_px]
  int samples;       ///< of three features each, at most
};

/// Of tracked features: about the limit of stage 1, twice as much confuses a slow motion with that
/// of an object ahead. One of 500 samples is without an outlier in 98 % of all cases if a fifth of
/// the features agree; a motion of fewer does not convince.
constexpr ConsensusLimits kOfTracked = {0.7, 500};
/// Of features matched by descriptors, which are taken from images of up to half the size. Fewer
/// agree, and the depths of most are too inexact.
constexpr ConsensusLimits kOfRecognized = {3.0, 1000};

/// The motion, current to keyframe, that most features agree on: perspective-three-point in a
/// RANSAC loop, over at most 200 of the features. It is rough, but needs no initial value and
/// tolerates many outliers. None if there are fewer than 4 features, or no three of them give a
/// motion. The same features always give the same motion.
std::optional<Eigen::Isometry3d> consensusMotion(const StereoCamera& camera,
                                                 const Correspondences& features,
                                                 const ConsensusLimits& limits = kOfTracked);

}  // namespace rotrocc
