#pragma once

#include <vector>

#include <ceres/rotation.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/min_depth.h"
#include "motion/cauchy_weights.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// A feature as least squares over the motion alone may see it, although its disparity is noisy
/// too.
struct FittedFeature {
  Eigen::Vector2d target_px;      ///< what the projection should hit, in the previous image
  Eigen::Vector3d rotated_point;  ///< R X_cur of the fitted disparity [m]
  Eigen::Matrix2d whitening;      ///< of target_px - pi(R X_cur + T), to unit variance of a flow
  Eigen::Vector2d by_disparity;   ///< d pi(R X_cur + T) / d disparity, at the motion
};

/// Fits the features' disparities to both their measurements: themselves and, at the motion, their
/// flow. With r = `noise_ratio`, the standard deviation of a disparity over that of a flow, and
/// j = d pi(R X + T) / d disparity at the fitted disparity, the residual's covariance is
/// S = I + r^2 j j^T in units of the flow's variance, of which `whitening` is the inverse root; the
/// target is prev_px, moved to where it would be expected had the measured disparity been the
/// fitted one. The least squares of such residuals have their minimum where those over motion and
/// all true disparities have it (Deming's regression): taken at the measured disparities, noisy far
/// points would pull the motion towards too short. A ratio of 0 changes nothing: the paper's least
/// squares.
void fitDisparities(const StereoCamera& camera,
                    const Correspondences& features,
                    const Eigen::Isometry3d& T_prev_cur,
                    double noise_ratio,
                    std::vector<FittedFeature>& fitted);

/// The residual of Eq. 2 for one fitted feature, W (target - pi(R X_cur + T)) [px], where the
/// motion is a local increment on an initial one: R = Exp(p[0..2]) R_0, T = p[3..5].
///
/// Templated for ceres::Jet: the reference that the analytic Jacobians are tested against.
struct ReprojectionResidual {
  StereoCamera camera;
  FittedFeature feature;

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    const T point[3] = {
        T(feature.rotated_point.x()), T(feature.rotated_point.y()), T(feature.rotated_point.z())};
    T moved[3];
    ceres::AngleAxisRotatePoint(p, point, moved);
    const T z = moved[2] + p[5] < T(kMinDepth_m) ? T(kMinDepth_m) : moved[2] + p[5];
    const T x = feature.target_px.x() - (camera.fx * (moved[0] + p[3]) / z + camera.cx);
    const T y = feature.target_px.y() - (camera.fy * (moved[1] + p[4]) / z + camera.cy);
    const Eigen::Matrix2d& W = feature.whitening;
    residual[0] = W(0, 0) * x + W(0, 1) * y;
    residual[1] = W(1, 0) * x + W(1, 1) * y;
    return true;
  }
};

/// The residuals r of all features of a set and their analytic Jacobian J. With kParameters = 6 the
/// parameters are those of ReprojectionResidual (Eq. 25); with 3 they are the translation alone,
/// the rotation staying R_0 (Eq. 29).
template <int kParameters>
class ReprojectionProblem {
 public:
  using Parameters = Eigen::Matrix<double, kParameters, 1>;
  /// [J r]^T [J r]: J^T J, with J^T r in the last column and r^T r in the corner.
  using NormalMatrix = Eigen::Matrix<double, kParameters + 1, kParameters + 1>;

  /// Takes the features flagged in `set`, fitted at `T_0`.
  void assign(const StereoCamera& camera,
              const Correspondences& features,
              const FeatureSet& set,
              const Eigen::Isometry3d& T_0,
              double noise_ratio);

  /// Takes those flagged in `set` of features that are fitted already.
  void assign(const StereoCamera& camera,
              const std::vector<FittedFeature>& fitted,
              const FeatureSet& set);

  /// Multiplies the residuals by the roots of the weights that they have at `parameters`, in the
  /// order of the features.
  void weigh(const Parameters& parameters, CauchyWeights& weights);

  /// The features taken, in their order.
  const std::vector<FittedFeature>& features() const { return features_; }

  int residualCount() const { return static_cast<int>(2 * features_.size()); }

  /// `residuals`: x and y of each feature in turn. `jacobian`: by columns.
  void linearise(const Parameters& parameters, double* residuals, double* jacobian) const;

  /// What linearise() comes to in the normal equations.
  NormalMatrix normalMatrix(const Parameters& parameters) const;

  /// r^T r.
  double cost(const Parameters& parameters) const;

 private:
  struct Motion;
  using FeatureJacobian = Eigen::Matrix<double, 2, kParameters>;

  Eigen::Vector2d residual(const FittedFeature& feature,
                           const Motion& motion,
                           FeatureJacobian* jacobian) const;

  StereoCamera camera_;
  std::vector<FittedFeature> features_;
  std::vector<double> errors_px_;  // kept for its memory
};

/// Reprojection error |x_prev - pi(R X_cur + T)| of every feature [px] (Eq. 2).
void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_prev_cur,
                        std::vector<double>& errors_px);

/// The same, |W (target - pi(R X_cur + T))|, of features fitted at a motion with this translation.
void reprojectionErrors(const StereoCamera& camera,
                        const std::vector<FittedFeature>& fitted,
                        const Eigen::Vector3d& translation,
                        std::vector<double>& errors_px);

}  // namespace rotrocc
