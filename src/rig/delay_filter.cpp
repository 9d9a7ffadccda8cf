#include "rig/delay_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/median.h"
#include "motion/feature_errors.h"

namespace rotrocc {
namespace {

/// Features that the estimate remembers, about.
constexpr double kMemory = 1000.0;

/// Noise averages out over more features than that, but not what lenses leave beyond the
/// polynomial: on KITTI and Karlsruhe, it passes for a delay of a hundredth of the period.
constexpr double kIndependent = 40.0;

/// A delay of this many standard deviations is applied by half, a smaller one hardly, a larger one
/// as a whole.
constexpr double kSignificance = 3.0;

/// Standard deviations before the first feature: of the polynomial, slopes of rays, and of the
/// delay over the period.
constexpr double kPriorSlope = 0.01;
constexpr double kPriorDelay = 0.2;

/// With more than this share of the period, the images are of other pairs.
constexpr double kMostDelay = 0.5;

/// Standard deviation of the first residuals, over that about their median: what a delay makes of
/// them is not wrong yet.
constexpr double kStart = 3.0;

/// Variance of residuals without noise, by rounding.
constexpr double kRounding = 1e-12;

}  // namespace

/// At the median offset, without a delay: wrong rows of the first pair must not pass for one.
void DelayFilter::start(double fx_px, const std::vector<RowSample>& samples) {
  std::vector<float> offsets_px;
  for (const RowSample& sample : samples) offsets_px.push_back(sample.offset_px);
  const float middle_px = median(offsets_px);
  for (float& offset_px : offsets_px) offset_px = std::abs(offset_px - middle_px);
  solution_[0] = middle_px / fx_px;
  const double deviation = kStart * kDeviationOverMedian * median(offsets_px) / fx_px;
  variance_ = std::max(deviation * deviation, kRounding);
}

void DelayFilter::add(const StereoCamera& camera,
                      double dt_s,
                      const std::vector<RowSample>& samples) {
  const double kept = std::exp(-static_cast<double>(samples.size()) / kMemory);
  normal_ *= kept;
  count_ *= kept;
  squares_ *= kept;
  if (count_ == 0.0 && !samples.empty()) start(camera.fx, samples);
  for (const RowSample& sample : samples) {
    const double x = (sample.left_px.x() - camera.cx) / camera.fx;
    const double y = (sample.left_px.y() - camera.cy) / camera.fx;
    const double speed = sample.flow_px.y() / (camera.fx * dt_s);
    Columns columns;
    columns << 1.0, x, y, x * x, x * y, y * y, speed, sample.offset_px / camera.fx;
    const double square = std::pow(columns.dot(solution_), 2);
    const double weight = 1.0 / (1.0 + square / (kCauchyFactor * kCauchyFactor * variance_));
    normal_ += weight * columns * columns.transpose();
    count_ += weight;
    squares_ += weight * square;
  }
  if (count_ <= kUnknowns) return;
  constexpr int kDelay = kUnknowns - 1;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  variance_ = std::max(squares_ / (count_ - kUnknowns), kRounding);
  Matrix information = normal_.topLeftCorner<kUnknowns, kUnknowns>();
  information.diagonal().head<kDelay>().array() += variance_ / std::pow(kPriorSlope, 2);
  information(kDelay, kDelay) += variance_ / std::pow(kPriorDelay * dt_s, 2);
  const auto llt = information.llt();
  solution_.head<kUnknowns>() = llt.solve(normal_.topRightCorner<kUnknowns, 1>());
  const double variance_s2 = variance_ * llt.solve(Matrix::Identity())(kDelay, kDelay);
  delay_.estimated_s = solution_[kDelay];
  delay_.sigma_s = std::sqrt((1.0 + count_ / kIndependent) * variance_s2);
  const double sigmas = delay_.estimated_s / delay_.sigma_s;
  const double log_odds = 0.5 * (sigmas * sigmas - kSignificance * kSignificance);
  const bool is_possible = std::abs(delay_.estimated_s) < kMostDelay * dt_s;
  delay_.applied_s = is_possible ? delay_.estimated_s / (1.0 + std::exp(-log_odds)) : 0.0;
}

}  // namespace rotrocc
