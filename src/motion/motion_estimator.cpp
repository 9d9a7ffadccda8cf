#include "motion/motion_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "motion/consensus_motion.h"
#include "motion/feature_errors.h"
#include "motion/reprojection_problem.h"

namespace rotrocc {
namespace {

/// If stage 1 leaves a smaller share of the features, the motion may be that of an object.
constexpr double kRetryShare = 0.7;

/// A retry uses the features whose error is below this, in details of the images.
constexpr double kRetryAgreement_px = 2.0;

/// A smaller share of the features is not what most agree on.
constexpr double kMajority = 0.5;

/// The motion near the prediction wins with more than this fraction of the other's inliers.
constexpr double kLikelierShare = 0.5;

/// Grid of cells within which the errors of neighboring features may be correlated.
constexpr int kScatterColumns = 8;
constexpr int kScatterRows = 3;

/// The ratio of the variance of truncated errors to the full variance. The errors are Gaussian in x
/// and y, and only those shorter than `limit_px` are kept; these have the variance `residual_px2`
/// in each direction. The ratio is g = 1 - x / (e^x - 1) with x = limit^2 / (2 variance).
double shareOfVariance(double residual_px2, double limit_px) {
  const auto g = [](double x) { return 1.0 - x / std::expm1(x); };
  // If the errors are almost uniform up to the limit, they hardly determine the variance. The lower
  // bound of x therefore limits the growth of the covariance to a factor of 20.
  double low = 0.5;
  double high = 50.0;
  const double wanted = 2.0 * residual_px2 / (limit_px * limit_px);  // g(x) / x, which falls
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (g(middle) / middle > wanted ? low : high) = middle;
  }
  return g(low);
}

/// The parts of the covariance, in the order translation [m], rotation [rad].
struct Information {
  /// Sum of w^2 J^T J: the derivative of the sum of w J^T r, which is zero at the solution, by the
  /// motion. (The derivative of w r, averaged over directions, is w^2.)
  Matrix6d matrix = Matrix6d::Zero();
  /// Sum of g g^T over the cells of a grid [px^2], where g is the sum of w J^T r of the features in
  /// the cell. Its expectation is the variance times `matrix` if residuals are uncorrelated, and
  /// larger if neighbors are correlated.
  Matrix6d scatter = Matrix6d::Zero();
  double residual_variance = 0.0;  ///< from WeightedVariance [px^2]
  double deviation_px = 0.0;       ///< of the residuals, from their median
};

/// Ratio of the covariance to that of independent errors: the variance per degree of freedom from
/// the scatter of the cells, divided by that of a residual. Neighboring features share texture,
/// the motion of an object and the remaining lens distortion.
double inflation(double scatter_px2, double residual_px2) {
  return residual_px2 > 0.0 ? std::max(1.0, scatter_px2 / residual_px2) : 1.0;
}

/// Takes the terms of the problem, whose motion has so many parameters.
Information collect(const ReprojectionProblem& problem,
                    const Measurements& measured,
                    int estimated_parameters) {
  Information information;
  WeightedVariance variance;
  const StereoCamera& camera = measured.camera;
  const ImageGrid grid(camera.width, camera.height, kScatterColumns, kScatterRows);
  std::array<Vector6d, kScatterColumns * kScatterRows> gradients;
  gradients.fill(Vector6d::Zero());
  problem.visit(problem.motion(), [&](const ReprojectionProblem::Term& term) {
    Eigen::Matrix<double, 2, 6> J;
    J << term.weight * term.jacobian.rightCols<3>(), term.weight * term.jacobian.leftCols<3>();
    information.matrix += J.transpose() * J;
    const Eigen::Vector2d& pixel = measured.features[term.feature].cur_px;
    gradients[grid.cell(pixel.x(), pixel.y())] += J.transpose() * term.residual_px;
    variance.add(term.weight, term.residual_px.squaredNorm());
  });
  information.residual_variance = variance.value(estimated_parameters);
  int cells = 0;
  for (const Vector6d& gradient : gradients) {
    if (gradient.isZero(0.0)) continue;
    information.scatter += gradient * gradient.transpose();
    ++cells;
  }
  // The motion was fitted to these features, so they scatter less than the errors.
  information.scatter = information.scatter * cells / std::max(1, cells - 6);
  return information;
}

}  // namespace

const MotionEstimate& MotionEstimator::estimate(
    const StereoCamera& camera,
    const Correspondences& features,
    const Eigen::Isometry3d& initial,
    double /*dt_s*/,
    const std::optional<Eigen::Isometry3d>& prediction) {
  const Measurements measured = {camera, features, kDisparityNoiseRatio};
  all_.assign(features.size(), 1);
  estimateFrom(all_, measured, initial, found_);
  const int agree = found_.valid ? count(found_.rotation_inliers) : 0;
  if (agree >= kRetryShare * static_cast<double>(features.size())) return found_;
  if (agree < kMajority * static_cast<double>(features.size())) takeConsensus(measured);
  if (!prediction) return found_;
  retryNear(*prediction, measured);
  const int near = retry_.valid ? count(retry_.rotation_inliers) : 0;
  return near > kLikelierShare * count(found_.rotation_inliers) ? retry_ : found_;
}

/// The full set is a mixture of motions: its least squares fit may end at none of them, or at one
/// of the smaller part. Replaces it by the motion that most features agree on, if more do.
void MotionEstimator::takeConsensus(const Measurements& measured) {
  const auto consensus = consensusMotion(measured.camera, measured.features);
  if (!consensus) return;
  retryNear(*consensus, measured);
  if (!retry_.valid) return;
  const int before = count(found_.rotation_inliers);
  if (!found_.valid || count(retry_.rotation_inliers) > before) std::swap(found_, retry_);
}

/// Estimates from the features close to a motion.
void MotionEstimator::retryNear(const Eigen::Isometry3d& motion, const Measurements& measured) {
  // Without whitening, because the motion of an object along the road looks like a wrong disparity.
  reprojectionErrors(measured, motion, errors_px_);
  near_ = all_;
  keepBelow(errors_px_, measured.camera.detail_px * kRetryAgreement_px, near_);
  estimateFrom(near_, measured, motion, retry_);
}

void MotionEstimator::estimateFrom(const FeatureSet& set,
                                   const Measurements& measured,
                                   const Eigen::Isometry3d& initial,
                                   MotionEstimate& estimate) {
  two_stages_.estimate(measured, set, initial, problem_, estimate);
  const double limit_px = measured.camera.detail_px * kRotationLimit;
  estimate.valid = estimateCovariance(measured, limit_px, kCauchyFactor, problem_, estimate);
}

bool MotionEstimator::estimateCovariance(const Measurements& measured,
                                         double limit_px,
                                         double robust_factor,
                                         ReprojectionProblem& problem,
                                         MotionEstimate& motion) {
  motion.covariance.setZero();
  motion.flow_noise_px = 0.0;
  if (!motion.valid) return false;
  const auto informationOf = [&](const FeatureSet& set, int estimated_parameters) {
    problem.select(set);
    const double deviation_px = problem.weigh(robust_factor);
    Information information = collect(problem, measured, estimated_parameters);
    information.deviation_px = deviation_px;
    return information;
  };
  const Information one = informationOf(motion.rotation_inliers, 6);
  const Eigen::LDLT<Matrix6d> full(one.matrix);
  if (full.info() != Eigen::Success || !full.isPositive()) return false;
  const double share = shareOfVariance(one.residual_variance, limit_px);
  const double variance = one.residual_variance / share;
  const double correlation_inflation =
      inflation(full.solve(one.scatter).trace() / 6.0, one.residual_variance);
  const Matrix6d both = correlation_inflation * variance / share * full.solve(Matrix6d::Identity());
  if (!both.allFinite()) return false;
  motion.covariance = both;
  motion.flow_noise_px = one.deviation_px;
  if (!motion.has_translation_stage) return true;

  const Information two = informationOf(motion.translation_inliers, 3);
  const Eigen::LDLT<Eigen::Matrix3d> translation(two.matrix.topLeftCorner<3, 3>());
  if (translation.info() != Eigen::Success || !translation.isPositive()) return false;
  const Eigen::Matrix3d by_rotation = -translation.solve(two.matrix.topRightCorner<3, 3>());
  const Eigen::Matrix3d rotation = both.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d scatter = two.scatter.topLeftCorner<3, 3>();
  const double correlation_inflation_of_two =
      inflation(translation.solve(scatter).trace() / 3.0, two.residual_variance);
  motion.covariance.topLeftCorner<3, 3>() = correlation_inflation_of_two *
                                                std::max(two.residual_variance, variance) *
                                                translation.solve(Eigen::Matrix3d::Identity()) +
                                            by_rotation * rotation * by_rotation.transpose();
  motion.covariance.topRightCorner<3, 3>() = by_rotation * rotation;
  motion.covariance.bottomLeftCorner<3, 3>() = rotation * by_rotation.transpose();
  return motion.covariance.allFinite();
}

}  // namespace rotrocc
