#include "motion/reprojection_error.h"

#include <algorithm>
#include <cmath>

#include "features/kernels/kernels.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// The fit is nearly linear: two steps leave less than a hundredth of the first.
constexpr int kFitSteps = 2;

FitTerms termsOf(const StereoCamera& camera,
                 const Eigen::Isometry3d& T_prev_cur,
                 double noise_ratio) {
  FitTerms terms;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(terms.rotation) = T_prev_cur.linear();
  Eigen::Map<Eigen::Vector3d>(terms.translation) = T_prev_cur.translation();
  terms.fx = camera.fx;
  terms.fy = camera.fy;
  terms.cx = camera.cx;
  terms.cy = camera.cy;
  terms.least_depth = kMinDepth_m;
  terms.ratio2 = noise_ratio * noise_ratio;
  terms.steps = noise_ratio > 0.0 ? kFitSteps : 0;
  return terms;
}

void put(const StereoCamera& camera, const Correspondence& feature, FitBlock& block, int i) {
  block.prev_x[i] = feature.prev_px.x();
  block.prev_y[i] = feature.prev_px.y();
  block.point_x[i] = feature.point_cur.x();
  block.point_y[i] = feature.point_cur.y();
  block.point_z[i] = feature.point_cur.z();
  block.measured[i] = feature.disparity_px - camera.disparityAtInfinity();
}

void get(const FitBlock& block, int i, FittedFeature& fitted) {
  fitted.target_px = {block.target_x[i], block.target_y[i]};
  fitted.rotated_point = {block.rotated_x[i], block.rotated_y[i], block.rotated_z[i]};
  fitted.whitening << block.whitening_xx[i], block.whitening_xy[i], block.whitening_xy[i],
      block.whitening_yy[i];
  fitted.by_disparity = {block.slope_x[i], block.slope_y[i]};
}

double errorOf(const StereoCamera& camera,
               const FittedFeature& feature,
               const Eigen::Vector3d& translation) {
  Eigen::Vector3d point = feature.rotated_point + translation;
  point.z() = std::max(point.z(), kMinDepth_m);
  return (feature.whitening * (feature.target_px - camera.project(point))).norm();
}

}  // namespace

void fitDisparities(const StereoCamera& camera,
                    const Correspondences& features,
                    const Eigen::Isometry3d& T_prev_cur,
                    double noise_ratio,
                    std::vector<FittedFeature>& fitted) {
  const Kernels& kernels = chooseKernels();
  const FitTerms terms = termsOf(camera, T_prev_cur, noise_ratio);
  FitBlock block = {};
  fitted.resize(features.size());
  for (std::size_t first = 0; first < features.size(); first += FitBlock::kSize) {
    const auto left = features.size() - first;
    const int count = static_cast<int>(std::min<std::size_t>(left, FitBlock::kSize));
    for (int i = 0; i < FitBlock::kSize; ++i) {
      put(camera, features[first + static_cast<std::size_t>(std::min(i, count - 1))], block, i);
    }
    kernels.fitDisparities(terms, block);
    for (int i = 0; i < count; ++i) get(block, i, fitted[first + static_cast<std::size_t>(i)]);
  }
}

template <int kParameters>
void ReprojectionProblem<kParameters>::assign(const StereoCamera& camera,
                                              const Correspondences& features,
                                              const FeatureSet& set,
                                              const Eigen::Isometry3d& T_0,
                                              double noise_ratio) {
  camera_ = camera;
  fitDisparities(camera, features, T_0, noise_ratio, features_);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] != 0) features_[taken++] = features_[i];
  }
  features_.resize(taken);
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
void ReprojectionProblem<kParameters>::weigh(const Parameters& parameters, CauchyWeights& weights) {
  const Motion motion(parameters);
  errors_px_.clear();
  for (const FittedFeature& feature : features_) {
    errors_px_.push_back(residual(feature, motion, nullptr).norm());
  }
  weights.update(errors_px_);
  for (std::size_t i = 0; i < features_.size(); ++i) {
    features_[i].whitening *= std::sqrt(weights[i]);
  }
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
                        std::vector<double>& errors_px) {
  errors_px.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    Eigen::Vector3d point = T_prev_cur * features[i].point_cur;
    point.z() = std::max(point.z(), kMinDepth_m);
    errors_px[i] = (features[i].prev_px - camera.project(point)).norm();
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
