#include "rotrocc/reprojection_error.h"

#include <algorithm>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {

template <int kParameters>
void ReprojectionProblem<kParameters>::assign(const StereoCamera& camera,
                                              const Correspondences& features,
                                              const FeatureSet& set, const Eigen::Matrix3d& R_0) {
  camera_ = camera;
  observations_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] == 0) continue;
    observations_.push_back({features[i].prev_px, R_0 * features[i].point_cur});
  }
}

template <int kParameters>
bool ReprojectionProblem<kParameters>::operator()(const double* parameters, double* residuals,
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
    residuals[2 * i] = observations_[i].prev_px.x() - (u + camera_.cx);
    residuals[2 * i + 1] = observations_[i].prev_px.y() - (v + camera_.cy);
    if (jacobian == nullptr) continue;

    Eigen::Matrix<double, 2, 3> by_point;
    by_point << -camera_.fx / z, 0.0, in_front ? u / z : 0.0, 0.0, -camera_.fy / z,
        in_front ? v / z : 0.0;
    const auto row = static_cast<Eigen::Index>(2 * i);
    J.template block<2, 3>(row, kParameters - 3) = by_point;
    if (kRotates) J.template block<2, 3>(row, 0) = -by_point * skew(rotated) * J_left;
  }
  return true;
}

template class ReprojectionProblem<3>;
template class ReprojectionProblem<6>;

void reprojectionErrors(const StereoCamera& camera, const Correspondences& features,
                        const Eigen::Isometry3d& T_prev_cur, std::vector<double>& errors_px) {
  errors_px.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    Eigen::Vector3d point = T_prev_cur * features[i].point_cur;
    point.z() = std::max(point.z(), kMinDepth_m);
    errors_px[i] = (features[i].prev_px - camera.project(point)).norm();
  }
}

}  // namespace rotrocc
