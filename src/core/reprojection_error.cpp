#include "rotrocc/reprojection_error.h"

#include <algorithm>
#include <cmath>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// d pi(point) / d point [px/m].
Eigen::Matrix<double, 2, 3> projectionJacobian(const StereoCamera& camera,
                                               const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 2, 3> J;
  const double z = point.z();
  J << camera.fx / z, 0.0, -camera.fx * point.x() / (z * z), 0.0, camera.fy / z,
      -camera.fy * point.y() / (z * z);
  return J;
}

}  // namespace

Eigen::Matrix2d whitening(const StereoCamera& camera,
                          const Correspondence& feature,
                          const Eigen::Isometry3d& T_prev_cur,
                          double noise_ratio) {
  if (noise_ratio == 0.0) return Eigen::Matrix2d::Identity();
  Eigen::Vector3d point = T_prev_cur * feature.point_cur;
  point.z() = std::max(point.z(), kMinDepth_m);
  // A point moves along its ray: dX / d disparity = -X / (disparity above that of infinity).
  const double disparity_px = feature.disparity_px - camera.disparityAtInfinity();
  const Eigen::Vector2d j =
      projectionJacobian(camera, point) * (T_prev_cur.linear() * feature.point_cur) / -disparity_px;
  const double j2 = j.squaredNorm();
  if (j2 == 0.0) return Eigen::Matrix2d::Identity();
  const double along_j = 1.0 / std::sqrt(1.0 + noise_ratio * noise_ratio * j2);
  return Eigen::Matrix2d::Identity() - (1.0 - along_j) / j2 * j * j.transpose();
}

template <int kParameters>
void ReprojectionProblem<kParameters>::assign(const StereoCamera& camera,
                                              const Correspondences& features,
                                              const FeatureSet& set,
                                              const Eigen::Isometry3d& T_0,
                                              double noise_ratio) {
  camera_ = camera;
  observations_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] == 0) continue;
    observations_.push_back({features[i].prev_px,
                             T_0.linear() * features[i].point_cur,
                             whitening(camera, features[i], T_0, noise_ratio)});
  }
}

template <int kParameters>
bool ReprojectionProblem<kParameters>::operator()(const double* parameters,
                                                  double* residuals,
                                                  double* jacobian) const {
  using Vector3 = Eigen::Map<const Eigen::Vector3d>;
  constexpr bool kRotates = kParameters == 6;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d J_left = Eigen::Matrix3d::Identity();
  if (kRotates) {
    R = expRotation(Vector3(parameters));
    J_left = leftJacobian(Vector3(parameters));
  }
  const Vector3 T(parameters + kParameters - 3);

  const auto rows = static_cast<Eigen::Index>(2 * observations_.size());
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kParameters>> J(jacobian, rows, kParameters);
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    const Eigen::Vector3d rotated = R * observations_[i].rotated_point;
    const Eigen::Vector3d moved = rotated + T;
    const bool in_front = moved.z() >= kMinDepth_m;
    const double z = in_front ? moved.z() : kMinDepth_m;
    const double u = camera_.fx * moved.x() / z;
    const double v = camera_.fy * moved.y() / z;
    const Observation& observation = observations_[i];
    Eigen::Map<Eigen::Vector2d>(residuals + 2 * i) =
        observation.whitening *
        (observation.prev_px - Eigen::Vector2d(u + camera_.cx, v + camera_.cy));
    if (jacobian == nullptr) continue;

    Eigen::Matrix<double, 2, 3> by_point;
    by_point << -camera_.fx / z, 0.0, in_front ? u / z : 0.0, 0.0, -camera_.fy / z,
        in_front ? v / z : 0.0;
    by_point = observation.whitening * by_point;
    const auto row = static_cast<Eigen::Index>(2 * i);
    J.template block<2, 3>(row, kParameters - 3) = by_point;
    if (kRotates) J.template block<2, 3>(row, 0) = -by_point * skew(rotated) * J_left;
  }
  return true;
}

template class ReprojectionProblem<3>;
template class ReprojectionProblem<6>;

void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_prev_cur,
                        double noise_ratio,
                        std::vector<double>& errors_px) {
  errors_px.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    Eigen::Vector3d point = T_prev_cur * features[i].point_cur;
    point.z() = std::max(point.z(), kMinDepth_m);
    const Eigen::Vector2d error_px = features[i].prev_px - camera.project(point);
    errors_px[i] = (whitening(camera, features[i], T_prev_cur, noise_ratio) * error_px).norm();
  }
}

}  // namespace rotrocc
