#include "rotrocc/reprojection_error.h"

#include <algorithm>
#include <cmath>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// The fit is nearly linear: two steps leave less than a hundredth of the first.
constexpr int kFitSteps = 2;

/// No feature is fitted beyond this many times its depth: a wrong match is not to become a right
/// one.
constexpr double kMostStretch = 2.0;

/// The view of a point along its ray, as a function of the disparity above that of infinity.
struct RayView {
  const StereoCamera& camera;
  Eigen::Vector3d ray;  // R X times disparity
  Eigen::Vector3d translation;

  /// The point's place in the previous frame, times disparity.
  Eigen::Vector3d place(double disparity_px) const {
    Eigen::Vector3d q = ray + disparity_px * translation;
    q.z() = std::max(q.z(), kMinDepth_m * disparity_px);
    return q;
  }
  /// d pi / d disparity.
  Eigen::Vector2d slope(const Eigen::Vector3d& q) const {
    return {camera.fx * (translation.x() - q.x() / q.z() * translation.z()) / q.z(),
            camera.fy * (translation.y() - q.y() / q.z() * translation.z()) / q.z()};
  }
};

double errorOf(const StereoCamera& camera,
               const FittedFeature& feature,
               const Eigen::Vector3d& translation) {
  Eigen::Vector3d point = feature.rotated_point + translation;
  point.z() = std::max(point.z(), kMinDepth_m);
  return (feature.whitening * (feature.target_px - camera.project(point))).norm();
}

}  // namespace

FittedFeature fitDisparity(const StereoCamera& camera,
                           const Correspondence& feature,
                           const Eigen::Isometry3d& T_prev_cur,
                           double noise_ratio) {
  const Eigen::Vector3d rotated = T_prev_cur.linear() * feature.point_cur;
  const double measured_px = feature.disparity_px - camera.disparityAtInfinity();
  const RayView view = {camera, measured_px * rotated, T_prev_cur.translation()};
  const double r2 = noise_ratio * noise_ratio;
  double fitted_px = measured_px;
  Eigen::Vector3d q = view.place(fitted_px);
  Eigen::Vector2d j = view.slope(q);
  for (int step = 0; step < kFitSteps && noise_ratio > 0.0; ++step) {
    const Eigen::Vector2d error_px = feature.prev_px - camera.project(q);
    fitted_px += (r2 * j.dot(error_px) - (fitted_px - measured_px)) / (1.0 + r2 * j.squaredNorm());
    fitted_px = std::clamp(fitted_px, measured_px / kMostStretch, measured_px * kMostStretch);
    q = view.place(fitted_px);
    j = view.slope(q);
  }

  FittedFeature fitted;
  fitted.target_px = feature.prev_px + (fitted_px - measured_px) * j;
  fitted.rotated_point = measured_px / fitted_px * rotated;
  fitted.whitening.setIdentity();
  fitted.by_disparity = j;
  const double j2 = j.squaredNorm();
  if (j2 > 0.0) {
    const double along_j = 1.0 / std::sqrt(1.0 + r2 * j2);
    fitted.whitening -= (1.0 - along_j) / j2 * j * j.transpose();
  }
  return fitted;
}

void fitDisparities(const StereoCamera& camera,
                    const Correspondences& features,
                    const Eigen::Isometry3d& T_prev_cur,
                    double noise_ratio,
                    std::vector<FittedFeature>& fitted) {
  fitted.clear();
  for (const Correspondence& feature : features) {
    fitted.push_back(fitDisparity(camera, feature, T_prev_cur, noise_ratio));
  }
}

template <int kParameters>
void ReprojectionProblem<kParameters>::assign(const StereoCamera& camera,
                                              const Correspondences& features,
                                              const FeatureSet& set,
                                              const Eigen::Isometry3d& T_0,
                                              double noise_ratio) {
  camera_ = camera;
  features_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] != 0) features_.push_back(fitDisparity(camera, features[i], T_0, noise_ratio));
  }
}

template <int kParameters>
void ReprojectionProblem<kParameters>::assign(const StereoCamera& camera,
                                              const std::vector<FittedFeature>& fitted,
                                              const FeatureSet& set) {
  camera_ = camera;
  features_.clear();
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (set[i] != 0) features_.push_back(fitted[i]);
  }
}

/// The motion that the parameters stand for.
template <int kParameters>
struct ReprojectionProblem<kParameters>::Motion {
  static constexpr bool kRotates = kParameters == 6;

  explicit Motion(const Parameters& parameters) : T(parameters.template tail<3>()) {
    if (!kRotates) return;
    R = expRotation(parameters.template head<3>());
    R_by_parameters = leftJacobian(parameters.template head<3>());
  }

  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_by_parameters;
  Eigen::Vector3d T;
};

/// `jacobian` may be null.
template <int kParameters>
Eigen::Vector2d ReprojectionProblem<kParameters>::residual(const FittedFeature& feature,
                                                           const Motion& motion,
                                                           FeatureJacobian* jacobian) const {
  Eigen::Vector3d rotated = feature.rotated_point;
  if (Motion::kRotates) rotated = motion.R * feature.rotated_point;
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
    if (Motion::kRotates) {
      const Eigen::Matrix<double, 2, 3> by_rotation = by_point * skew(-rotated);
      jacobian->template leftCols<3>() = by_rotation * motion.R_by_parameters;
    }
  }
  return feature.whitening * (feature.target_px - Eigen::Vector2d(u + camera_.cx, v + camera_.cy));
}

template <int kParameters>
void ReprojectionProblem<kParameters>::linearise(const Parameters& parameters,
                                                 double* residuals,
                                                 double* jacobian) const {
  const Motion motion(parameters);
  Eigen::Map<Eigen::VectorXd> r(residuals, residualCount());
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kParameters>> J(
      jacobian, residualCount(), kParameters);
  Eigen::Index row = 0;
  FeatureJacobian by_parameters;
  for (const FittedFeature& feature : features_) {
    r.segment<2>(row) = residual(feature, motion, &by_parameters);
    J.template middleRows<2>(row) = by_parameters;
    row += 2;
  }
}

template <int kParameters>
typename ReprojectionProblem<kParameters>::NormalMatrix
ReprojectionProblem<kParameters>::normalMatrix(const Parameters& parameters) const {
  constexpr int kColumns = (kParameters + 2) / 2 * 2;  // even, for SIMD
  const Motion motion(parameters);
  Eigen::Matrix<double, kColumns, kColumns> sum = Eigen::Matrix<double, kColumns, kColumns>::Zero();
  Eigen::Matrix<double, kColumns, 2> columns = Eigen::Matrix<double, kColumns, 2>::Zero();
  FeatureJacobian by_parameters;
  for (const FittedFeature& feature : features_) {
    columns.row(kParameters) = residual(feature, motion, &by_parameters).transpose();
    columns.template topRows<kParameters>() = by_parameters.transpose();
    sum += columns.lazyProduct(columns.transpose());
  }
  return sum.template topLeftCorner<kParameters + 1, kParameters + 1>();
}

template <int kParameters>
double ReprojectionProblem<kParameters>::cost(const Parameters& parameters) const {
  const Motion motion(parameters);
  double sum = 0.0;
  for (const FittedFeature& feature : features_) {
    sum += residual(feature, motion, nullptr).squaredNorm();
  }
  return sum;
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
    if (noise_ratio == 0.0) {
      Eigen::Vector3d point = T_prev_cur * features[i].point_cur;
      point.z() = std::max(point.z(), kMinDepth_m);
      errors_px[i] = (features[i].prev_px - camera.project(point)).norm();
      continue;
    }
    const FittedFeature fitted = fitDisparity(camera, features[i], T_prev_cur, noise_ratio);
    errors_px[i] = errorOf(camera, fitted, T_prev_cur.translation());
  }
}

void reprojectionErrors(const StereoCamera& camera,
                        const std::vector<FittedFeature>& fitted,
                        const Eigen::Vector3d& translation,
                        std::vector<double>& errors_px) {
  errors_px.clear();
  for (const FittedFeature& feature : fitted) {
    errors_px.push_back(errorOf(camera, feature, translation));
  }
}

}  // namespace rotrocc
