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

  /// In the previous frame: the pixel, and how it moves with the disparity.
  struct Pixel {
    Eigen::Vector2d px;
    Eigen::Vector2d slope;
  };

  Pixel at(double disparity_px) const {
    const Eigen::Vector3d q = ray + disparity_px * translation;  // the place, times disparity
    const double per_z = 1.0 / std::max(q.z(), kMinDepth_m * disparity_px);
    const double x = per_z * q.x();
    const double y = per_z * q.y();
    return {{camera.fx * x + camera.cx, camera.fy * y + camera.cy},
            {camera.fx * per_z * (translation.x() - x * translation.z()),
             camera.fy * per_z * (translation.y() - y * translation.z())}};
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
  RayView::Pixel pixel = view.at(fitted_px);
  for (int step = 0; step < kFitSteps && noise_ratio > 0.0; ++step) {
    const Eigen::Vector2d& j = pixel.slope;
    const double along_px = j.dot(feature.prev_px - pixel.px);
    fitted_px += (r2 * along_px - (fitted_px - measured_px)) / (1.0 + r2 * j.squaredNorm());
    fitted_px = std::clamp(fitted_px, measured_px / kMostStretch, measured_px * kMostStretch);
    pixel = view.at(fitted_px);
  }

  const Eigen::Vector2d& j = pixel.slope;
  FittedFeature fitted;
  fitted.target_px = feature.prev_px + (fitted_px - measured_px) * j;
  fitted.rotated_point = measured_px / fitted_px * rotated;
  fitted.by_disparity = j;
  // (I + r^2 j j^T)^-1/2: 1 / s along j, where s^2 = 1 + r^2 j^2.
  const double s = std::sqrt(1.0 + r2 * j.squaredNorm());
  fitted.whitening = Eigen::Matrix2d::Identity() - r2 / (s * (s + 1.0)) * j * j.transpose();
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

/// `jacobian` may be null. It is by a small rotation after the motion's own, not by its parameters.
template <int kParameters>
inline Eigen::Vector2d ReprojectionProblem<kParameters>::residual(const FittedFeature& feature,
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
      for (int i = 0; i < 2; ++i) {
        jacobian->row(i).template head<3>() =
            rotated.cross(by_point.row(i).transpose()).transpose();
      }
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
    if (Motion::kRotates) by_parameters.template leftCols<3>() *= motion.R_by_parameters;
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
  NormalMatrix normal = sum.template topLeftCorner<kParameters + 1, kParameters + 1>();
  if (Motion::kRotates) {
    normal.template topRows<3>() =
        motion.R_by_parameters.transpose() * normal.template topRows<3>().eval();
    normal.template leftCols<3>() = normal.template leftCols<3>().eval() * motion.R_by_parameters;
  }
  return normal;
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
