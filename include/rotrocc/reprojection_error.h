#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/rotation.h>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Points nearer to the image plane than this are projected as if they were there [m]: keeps the
/// residual of a wrong match finite.
constexpr double kMinDepth_m = 0.1;

/// The residual of Eq. 2 for one feature, x_prev - pi(R X_cur + T) [px], where the motion is a local
/// increment on an initial one: R = Exp(p[0..2]) R_0, T = p[3..5].
///
/// Templated for ceres::Jet: the reference that the analytic Jacobians are tested against.
struct ReprojectionResidual {
  StereoCamera camera;
  Eigen::Vector2d prev_px;
  Eigen::Vector3d rotated_point;  ///< R_0 X_cur [m]

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    const T point[3] = {T(rotated_point.x()), T(rotated_point.y()), T(rotated_point.z())};
    T moved[3];
    ceres::AngleAxisRotatePoint(p, point, moved);
    const T z = moved[2] + p[5] < T(kMinDepth_m) ? T(kMinDepth_m) : moved[2] + p[5];
    residual[0] = prev_px.x() - (camera.fx * (moved[0] + p[3]) / z + camera.cx);
    residual[1] = prev_px.y() - (camera.fy * (moved[1] + p[4]) / z + camera.cy);
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

  /// Takes the features flagged in `set`, turned by `R_0`.
  void assign(const StereoCamera& camera, const Correspondences& features, const FeatureSet& set,
              const Eigen::Matrix3d& R_0);

  int NumResiduals() const { return static_cast<int>(2 * observations_.size()); }

  /// `residuals`: 2N, x and y of each feature in turn. `jacobian`: 2N x kParameters by columns, or
  /// null.
  bool operator()(const double* parameters, double* residuals, double* jacobian) const;

 private:
  struct Observation {
    Eigen::Vector2d prev_px;
    Eigen::Vector3d rotated_point;
  };

  StereoCamera camera_;
  std::vector<Observation> observations_;
};

/// Reprojection error |x_prev - pi(R X_cur + T)| of every feature [px] (Eq. 2).
void reprojectionErrors(const StereoCamera& camera, const Correspondences& features,
                        const Eigen::Isometry3d& T_prev_cur, std::vector<double>& errors_px);

}  // namespace rotrocc
