#include "rig/bias_meter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>

#include "motion/feature_errors.h"

namespace rotrocc {
namespace {

using Problem = ReprojectionProblem;

/// Number of parameters of motion and bias.
constexpr int kParameters = 7;

/// With fewer features, the bias can hardly be distinguished from the motion.
constexpr std::size_t kLeastFeatures = 30;

/// Ratio of disparity noise to flow noise, see ReprojectionProblem: that of single matches. With a
/// larger one, it would also absorb errors that neighbors share, and with them a part of the bias.
constexpr double kNoiseRatio = 1.0;

/// Ratio of the standard deviation of an error that neighbors share to the noise, which is larger
/// with that kNoiseRatio: 0.7 to 1.3 on KITTI and Karlsruhe.
constexpr double kSharedRatio = 1.3;

/// Iterations end after a step below kSettled_px. Without parallax the bias is undetermined and
/// steps would be arbitrarily long.
constexpr int kMostSteps = 15;
constexpr double kSettled_px = 0.05;
constexpr double kLongestStep_px = 1.0;

/// Standard deviation from which on a measurement says nothing: a drive has 0.02 to 0.6 px, a robot
/// at rest 8 px and more.
constexpr double kMostSigma_px = 5.0;

/// The normal equations without the motion.
struct Bias {
  double information, weighted;
  Vector6d motion_by_bias, motion;  // rotation, then translation
};

Bias eliminateMotion(const Problem::NormalMatrix& normal) {
  const auto of_motion = normal.block<6, 6>(LinearBlock::kMotion, LinearBlock::kMotion).ldlt();
  const Vector6d mixed = normal.block<6, 1>(LinearBlock::kMotion, LinearBlock::kBias);
  Bias bias;
  bias.motion_by_bias = -of_motion.solve(mixed);
  bias.motion = -of_motion.solve(normal.block<6, 1>(LinearBlock::kMotion, LinearBlock::kResidual));
  bias.information =
      normal(LinearBlock::kBias, LinearBlock::kBias) + mixed.dot(bias.motion_by_bias);
  bias.weighted = -normal(LinearBlock::kBias, LinearBlock::kResidual) - mixed.dot(bias.motion);
  return bias;
}

}  // namespace

std::optional<BiasMeasurement> BiasMeter::measure(const StereoCamera& camera,
                                                  const Correspondences& features,
                                                  const Eigen::Isometry3d& T_keyframe_cur) {
  camera_ = camera;
  T_keyframe_cur_ = T_keyframe_cur;
  features_ = features;
  double variance_px2 = 0.0;
  for (int step = 0; step < kMostSteps && features_.size() >= kLeastFeatures; ++step) {
    variance_px2 = linearize();
    const Bias bias = eliminateMotion(problem_.normalMatrix(T_keyframe_cur_, LinearBlock::kBias));
    if (!(variance_px2 / bias.information < kMostSigma_px * kMostSigma_px)) return std::nullopt;
    const double step_px = bias.weighted / bias.information;
    if (!std::isfinite(step_px)) return std::nullopt;
    const double change_px = std::clamp(step_px, -kLongestStep_px, kLongestStep_px);
    const Vector6d motion = bias.motion + bias.motion_by_bias * change_px;
    T_keyframe_cur_.linear() = expRotation(motion.head<3>()) * T_keyframe_cur_.linear();
    T_keyframe_cur_.translation() += motion.tail<3>();
    camera_.cx_right += change_px;
    triangulate(camera_, features_);
    if (std::abs(change_px) < kSettled_px) break;
  }
  if (features_.size() < kLeastFeatures) return std::nullopt;
  auto measurement = describe(variance_px2);
  if (measurement) measurement->bias_px = camera_.cx_right - camera.cx_right;
  return measurement;
}

/// Sets the problem of the current step. Returns the variance of its residuals.
double BiasMeter::linearize() {
  problem_.assign({camera_, features_, kNoiseRatio}, T_keyframe_cur_);
  problem_.weigh(kCauchyFactor);
  problem_.shareErrors(kSharedRatio, kSmoothRatio);
  WeightedVariance variance;
  problem_.visit(T_keyframe_cur_, [&](const Problem::Term& term) {
    variance.add(term.weight, term.residual_px.squaredNorm());
  });
  return variance.value(kParameters);
}

/// At the start of the last step, with the variance of the residuals there.
std::optional<BiasMeasurement> BiasMeter::describe(double variance_px2) {
  // The curvature of reweighted least squares never overshoots. That which the robust cost has on
  // average, from the squared weights (see motion_estimator.cpp), gives the uncertainty.
  problem_.squareWeights();
  const Bias all = eliminateMotion(problem_.normalMatrix(problem_.motion(), LinearBlock::kBias));
  problem_.shareErrors(0.0, 0.0);
  const Bias alone = eliminateMotion(problem_.normalMatrix(problem_.motion(), LinearBlock::kBias));
  BiasMeasurement measurement;
  measurement.noise_px2 = variance_px2 / alone.information;
  measurement.shared_px2 = variance_px2 / all.information - measurement.noise_px2;
  measurement.motion_by_bias << all.motion_by_bias.tail<3>(), all.motion_by_bias.head<3>();
  const bool is_valid = measurement.noise_px2 > 0.0 && measurement.shared_px2 >= 0.0 &&
                        std::isfinite(measurement.noise_px2 + measurement.shared_px2) &&
                        measurement.motion_by_bias.allFinite();
  return is_valid ? std::optional(measurement) : std::nullopt;
}

}  // namespace rotrocc
