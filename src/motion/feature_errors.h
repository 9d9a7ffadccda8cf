#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The measurements of one pair and their noise.
struct Measurements {
  const StereoCamera& camera;
  const Correspondences& features;
  double noise_ratio;  ///< standard deviation of a disparity over that of a flow
};

/// Of cauchyWeights(), for motions and the disparity bias: the scale of a Cauchy distribution in
/// two dimensions is its median length, 1.177 s, over sqrt(3).
constexpr double kCauchyFactor = 0.68;

/// Standard deviation, in each direction, of two-dimensional Gaussian residuals from the median of
/// their lengths; there must be one. Reorders `lengths_px`.
double deviationOf(std::vector<double>& lengths_px);

/// Cauchy weights for iteratively reweighted least squares (Holland and Welsch 1977), for residuals
/// with long tails: w = 1 / (1 + (e / (f s))^2), in ]0, 1].
///
/// The tails of disparity and flow errors are longer than Gaussian tails and not symmetric: a
/// window at the edge of a near object also contains that object, so its disparity is too large.
/// Such errors bias the mean, but hardly the median: these weights are a compromise.
///
/// `errors_px` are the lengths e of two-dimensional residuals. s is their standard deviation in
/// each direction, estimated from the median of e for Gaussian residuals. f is `factor`. All
/// weights are 1 if s or f is 0. Returns s, 0 without residuals.
double cauchyWeights(double factor,
                     const std::vector<double>& errors_px,
                     std::vector<double>& weights);

/// Variance of weighted residuals r in each direction: the sum of (w r)^2 divided by the sum of
/// w^2, corrected for the degrees of freedom of the fitted parameters. This is the middle term of
/// the sandwich formula (Huber 1967).
class WeightedVariance {
 public:
  /// `error2_px2`: |r|^2 of a two-dimensional residual.
  void add(double weight, double error2_px2) {
    ++count_;
    squares_px2_ += weight * weight * error2_px2;
    squared_weights_ += weight * weight;
  }

  /// Returns the variance [px^2], or 0 if there are too few residuals.
  double value(int parameters) const {
    const double rows = 2.0 * count_;
    if (!(rows > parameters)) return 0.0;
    return squares_px2_ / ((rows - parameters) * 2.0 * squared_weights_ / rows);
  }

 private:
  int count_ = 0;
  double squares_px2_ = 0.0;
  double squared_weights_ = 0.0;
};

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

/// The threshold between inliers and outliers of an iteration, from the errors of the current set
/// (Eq. 26, 30): the larger of a fixed limit and the b-th highest error, where b is `drop_share` of
/// the set. No iteration drops a larger share. Infinite if the set is empty. Reorders the errors.
double fixedLimit(double limit, double drop_share, std::vector<double>& errors);

/// Flags in `set` exactly the features with an error below `threshold`. Dropped features may be
/// added again, as in Eq. 26. Returns whether the set changed.
bool keepBelow(const std::vector<double>& errors, double threshold, FeatureSet& set);

/// Median length of the flow of the features of a set [px]; 0 if there are none.
double medianFlow_px(const Correspondences& features, const FeatureSet& set);

/// Number of features in a set.
int count(const FeatureSet& set);

/// Reprojection error |x_keyframe - pi(R X_cur + T)| of each feature [px] (Eq. 2).
void reprojectionErrors(const Measurements& measured,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px);

/// Length [px] of each feature's flow after removing the rotation of the motion (Eq. 27, 28), which
/// is the flow caused by the translation alone: |x_keyframe - pi(R x_cur)|.
void decoupledFlow(const Measurements& measured,
                   const Eigen::Isometry3d& T_keyframe_cur,
                   std::vector<double>& lengths_px);

/// Errors of reprojectionErrors() divided by the flow of the features: the DNRE, or NRE (Eq. 8,
/// 30). Only without whitening, it equals the relative depth error, which is large for far points
/// with a wrong disparity.
void normalizedErrors(const Measurements& measured,
                      const Eigen::Isometry3d& T_keyframe_cur,
                      const std::vector<double>& flow_px,
                      std::vector<double>& errors);

}  // namespace rotrocc
