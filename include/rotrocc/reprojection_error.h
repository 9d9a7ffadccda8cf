#pragma once

#include <vector>

#include <ceres/rotation.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Points nearer to the image plane than this are projected as if they were there [m]: keeps the
/// residual of a wrong match finite.
constexpr double kMinDepth_m = 0.1;

/// How much a feature's error in the direction that its depth noise smears it counts, for
/// S = I + r^2 j j^T, the covariance of its residual in units of the flow's variance: the symmetric
/// root of S^-1. Here j = d pi(R X + T) / d disparity, and r is `noise_ratio`, the standard
/// deviation of a disparity over that of a flow. A ratio of 0 gives the identity: the paper's plain
/// least squares.
Eigen::Matrix2d whitening(const StereoCamera& camera,
                          const Correspondence& feature,
                          const Eigen::Isometry3d& T_prev_cur,
                          double noise_ratio);

/// The residual of Eq. 2 for one feature, W (x_prev - pi(R X_cur + T)) [px], where the motion is a
/// local increment on an initial one: R = Exp(p[0..2]) R_0, T = p[3..5].
///
/// Templated for ceres::Jet: the reference that the analytic Jacobians are tested against.
struct ReprojectionResidual {
  StereoCamera camera;
  Eigen::Vector2d prev_px;
  Eigen::Vector3d rotated_point;  ///< R_0 X_cur [m]
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    const T point[3] = {T(rotated_point.x()), T(rotated_point.y()), T(rotated_point.z())};
    T moved[3];
    ceres::AngleAxisRotatePoint(p, point, moved);
    const T z = moved[2] + p[5] < T(kMinDepth_m) ? T(kMinDepth_m) : moved[2] + p[5];
    const T x = prev_px.x() - (camera.fx * (moved[0] + p[3]) / z + camera.cx);
    const T y = prev_px.y() - (camera.fy * (moved[1] + p[4]) / z + camera.cy);
    residual[0] = whitening(0, 0) * x + whitening(0, 1) * y;
    residual[1] = whitening(1, 0) * x + whitening(1, 1) * y;
    return true;
  }
};

/// The residuals of all features of a set with their analytic Jacobians, in the form that
/// ceres::TinySolver wants. With kParameters = 6 the parameters are those of ReprojectionResidual
/// (Eq. 25); with 3 they are the translation alone, the rotation staying R_0 (Eq. 29).
template <int kParameters>
class ReprojectionProblem {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kParameters };

  /// Takes the features flagged in `set`, turned by the rotation of `T_0` and whitened at T_0.
  void assign(const StereoCamera& camera,
              const Correspondences& features,
              const FeatureSet& set,
              const Eigen::Isometry3d& T_0,
              double noise_ratio);

  int NumResiduals() const { return static_cast<int>(2 * observations_.size()); }

  /// `residuals`: 2N, x and y of each feature in turn. `jacobian`: 2N x kParameters by columns, or
  /// null.
  bool operator()(const double* parameters, double* residuals, double* jacobian) const;

 private:
  struct Observation {
    Eigen::Vector2d prev_px;
    Eigen::Vector3d rotated_point;
    Eigen::Matrix2d whitening;
  };

  StereoCamera camera_;
  std::vector<Observation> observations_;
};

/// Whitened reprojection error |W (x_prev - pi(R X_cur + T))| of every feature [px] (Eq. 2).
void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_prev_cur,
                        double noise_ratio,
                        std::vector<double>& errors_px);

}  // namespace rotrocc
