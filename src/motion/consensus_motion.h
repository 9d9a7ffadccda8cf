#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Of tracked features, in details of the images: about the limit of stage 1. Twice as much
/// confuses a slow motion with that of an object ahead.
constexpr double kTrackedTolerance = 0.7;

/// The motion, current to keyframe, that most features agree on: perspective-three-point in a
/// RANSAC loop, over at most 200 of the features. It is rough, but needs no initial value and
/// tolerates many outliers. None if there are fewer than 4 features, or no three of them give a
/// motion. The same features always give the same motion. Features agree on a motion if their
/// reprojection errors are below `tolerance`, in details of the images [camera.detail_px].
std::optional<Eigen::Isometry3d> consensusMotion(const StereoCamera& camera,
                                                 const Correspondences& features,
                                                 double tolerance = kTrackedTolerance);

}  // namespace rotrocc
