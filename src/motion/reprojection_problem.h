#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "geometry/min_depth.h"
#include "motion/cauchy_weights.h"
#include "motion/fitted_feature.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Least squares over a set of fitted features: residuals W (target - pi(R X + T)) [px], Jacobian
/// and weights. The solver, the covariance and the rig calibration all use the terms of
/// linearise().
///
/// With kParameters = 6 the parameters are a rotation vector relative to R_0, the rotation of the
/// fit, and the translation (Eq. 25): R = Exp(p[0..2]) R_0, T = p[3..5]. With kParameters = 3 they
/// are the translation alone, and the rotation is R_0 (Eq. 29).
template <int kParameters>
class ReprojectionProblem {
 public:
  using Parameters = Eigen::Matrix<double, kParameters, 1>;

  /// The contribution of one feature.
  struct Term {
    std::size_t feature;          ///< index among all features of the pair
    const FittedFeature& fitted;  ///< the feature itself
    double weight;                ///< weight of both residuals
    Eigen::Vector2d residual_px;
    /// Derivatives by a rotation applied after that of the parameters, and by the translation.
    Eigen::Matrix<double, 2, kParameters> jacobian;
  };

  /// sum w [J r]^T [J r]: J^T J, with J^T r in the last column and r^T r in the lower right corner.
  using NormalMatrix = Eigen::Matrix<double, kParameters + 1, kParameters + 1>;

  /// Takes the features flagged in `set`, with equal weights.
  void assign(const StereoCamera& camera, const Fit& fit, const FeatureSet& set);

  /// Weights the features by their residuals at `parameters`, using cauchyWeights() with the given
  /// factor.
  void weigh(const Parameters& parameters, double robust_factor);

  /// Adds an unknown for each cell of SharedErrorGrid, a disparity error that its features share.
  /// Its standard deviation is `ratio` times that of a flow. The unknowns are eliminated (Schur
  /// complement) from normalMatrix() and cost(). 0: there are none, as after assign().
  void shareErrors(double ratio);

  /// The parameters of the motion of the fit.
  Parameters start() const;

  std::size_t size() const { return indices_.size(); }

  /// Calls visit(const Term&) for each feature, in order.
  template <class Visit>
  void linearise(const Parameters& parameters, Visit&& visit) const {
    const Motion motion(parameters);
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      const FittedFeature& fitted = features_[i];
      Term term = {indices_[i], fitted, weights_[i], {}, {}};
      term.residual_px = residual(fitted, motion, &term.jacobian);
      visit(static_cast<const Term&>(term));
    }
  }

  /// The normal matrix of all terms by the parameters, without shared errors.
  NormalMatrix normalMatrix(const Parameters& parameters) const;

  /// Sum of w |r|^2, without the part that shared errors explain.
  double cost(const Parameters& parameters) const;

 private:
  using FeatureJacobian = Eigen::Matrix<double, 2, kParameters>;
  static constexpr bool kRotates = kParameters == 6;

  bool sharesErrors() const { return !cells_.empty(); }

  /// The motion that the parameters describe.
  struct Motion {
    explicit Motion(const Parameters& parameters) : T(parameters.template tail<3>()) {
      if (kRotates) R = expRotation(parameters.template head<3>());
    }

    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d T;
  };

  /// `jacobian` may be null.
  Eigen::Vector2d residual(const FittedFeature& feature,
                           const Motion& motion,
                           FeatureJacobian* jacobian) const {
    Eigen::Vector3d rotated = feature.rotated_point;
    if (kRotates) rotated = motion.R * feature.rotated_point;
    const Eigen::Vector3d moved = rotated + motion.T;
    const bool in_front = moved.z() >= kMinDepth_m;
    const double per_z = 1.0 / (in_front ? moved.z() : kMinDepth_m);
    const double u = camera_.fx * moved.x() * per_z;
    const double v = camera_.fy * moved.y() * per_z;
    if (jacobian != nullptr) {
      Eigen::Matrix<double, 2, 3> by_point;
      by_point << -camera_.fx * per_z, 0.0, in_front ? u * per_z : 0.0, 0.0, -camera_.fy * per_z,
          in_front ? v * per_z : 0.0;
      by_point = feature.whitening * by_point;
      jacobian->template rightCols<3>() = by_point;
      if (kRotates) {
        for (int i = 0; i < 2; ++i) {
          jacobian->row(i).template head<3>() =
              rotated.cross(by_point.row(i).transpose()).transpose();
        }
      }
    }
    const Eigen::Vector2d projected(u + camera_.cx, v + camera_.cy);
    return feature.whitening * (feature.target_px - projected);
  }

  StereoCamera camera_;
  Eigen::Isometry3d T_keyframe_cur_;  // of the fit
  std::vector<std::size_t> indices_;
  std::vector<FittedFeature> features_;
  std::vector<double> weights_;
  std::vector<std::size_t> cells_;  // of the features, if they share errors
  double inverse_shared_variance_ = 0.0;
  std::vector<double> errors_px_;  // reused
};

}  // namespace rotrocc
