#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "motion/fitted_feature.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The entries of those features that are in the set.
template <class Entry>
void select(const std::vector<Entry>& entries,
            const FeatureSet& set,
            std::vector<Entry>& selected) {
  selected.clear();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (set[i] != 0) selected.push_back(entries[i]);
  }
}

// The thresholds between inliers and outliers are computed in each iteration, from the errors of
// the current set. They are infinite if it is empty.

/// Eq. 26 and 30: the larger of a fixed limit and the b-th highest error, where b is `drop_share`
/// of the set. No iteration drops a larger share. Reorders the errors.
double fixedLimit(double limit, double drop_share, std::vector<double>& errors);
/// Eq. 32: `factor` times the mean error.
double meanBasedLimit(double factor, const std::vector<double>& errors);
/// Eq. 31: `factor` standard deviations above the mean error.
double deviationBasedLimit(double factor, const std::vector<double>& errors);

/// Flags in `set` exactly the features with an error below `threshold`. Dropped features may be
/// added again, as in Eq. 26. Returns whether the set changed.
bool keepBelow(const std::vector<double>& errors, double threshold, FeatureSet& set);

/// Number of features in a set.
int count(const FeatureSet& set);

/// Reprojection error |x_keyframe - pi(R X_cur + T)| of each feature [px] (Eq. 2).
void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px);

/// Whitened reprojection errors |W (target - pi(R X_cur + T))| [px], at the motion of the fit.
void fittedErrors(const StereoCamera& camera, const Fit& fit, std::vector<double>& errors_px);

/// Length [px] of each feature's flow after removing the rotation (Eq. 27, 28), which is the flow
/// caused by the translation alone: |x_keyframe - pi(R x_cur)|.
void decoupledFlow(const StereoCamera& camera,
                   const Correspondences& features,
                   const Eigen::Matrix3d& R_keyframe_cur,
                   std::vector<double>& lengths_px);

/// Length [px] of each feature's measured flow: |x_keyframe - x_cur|.
void coupledFlow(const Correspondences& features, std::vector<double>& lengths_px);

}  // namespace rotrocc
