#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

// Largest reprojection errors of features that agree on a motion, in details of the images.

/// For tracked features: about the limit of stage 1. Twice as much follows an object ahead.
constexpr double kOfTracked = 0.7;
/// For features matched by descriptors, which are taken from images of up to half the size.
constexpr double kOfRecognized = 3.0;

/// The motion, current to keyframe, that most features agree on: perspective-three-point in a
/// RANSAC loop, over at most 200 of the features. It is rough, but needs no initial value and
/// tolerates many outliers. None if there are fewer than 4 features, or no three of them give a
/// motion. The same features always give the same motion.
std::optional<Eigen::Isometry3d> consensusMotion(const StereoCamera& camera,
                                                 const Correspondences& features,
                                                 double tolerance = kOfTracked);

}  // namespace rotrocc
