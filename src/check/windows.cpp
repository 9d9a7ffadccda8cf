#include "check/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/median.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::size_t kLeastWindows = 2;
constexpr std::size_t kPairsPerWindow = 5;

}  // namespace

std::string toText(const Estimate& estimate, const std::string& unit) {
  int digits = 2;
  if (estimate.sigma > 0.0 && std::isfinite(estimate.sigma)) {
    digits = std::clamp(static_cast<int>(std::ceil(-std::log10(estimate.sigma))) + 1, 0, 6);
  }
  const auto text = [&](double value) {
    return std::isfinite(value) ? fixedText(value, digits) : std::string("unknown");
  };
  return text(estimate.value) + " +- " + text(estimate.sigma) + (unit.empty() ? "" : " " + unit);
}

Windows::Windows(double duration_s, std::size_t pairs, std::size_t wanted)
    : count_(std::clamp(pairs / kPairsPerWindow, std::min(kLeastWindows, wanted), wanted)),
      length_s_(std::max(duration_s, 1e-9) / static_cast<double>(count_)) {}

std::size_t Windows::of(double time_s) const {
  const double window = std::floor(time_s / length_s_);
  return static_cast<std::size_t>(std::clamp(window, 0.0, static_cast<double>(count_ - 1)));
}

Estimate meanOf(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const auto all = Eigen::ArrayXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
  const double mean = all.sum() / count;
  return {mean, std::sqrt((all - mean).square().sum() / (count - 1.0) / count)};
}

Estimate overWindows(const std::vector<TimedValue>& values,
                     const Windows& windows,
                     std::size_t least) {
  std::vector<std::vector<double>> parts(windows.count());
  for (const TimedValue& timed : values) {
    if (std::isfinite(timed.value)) parts[windows.of(timed.time_s)].push_back(timed.value);
  }
  std::vector<double> medians;
  for (std::vector<double>& part : parts) {
    if (part.size() >= least) medians.push_back(median(part));
  }
  return meanOf(medians);
}

Estimate scatterBeyondNoise(const std::vector<Estimate>& values) {
  double count = 0.0, sum = 0.0, sum_x = 0.0, sum_xx = 0.0, sum_w2 = 0.0;
  for (const auto& [x, sigma] : values) {
    if (!std::isfinite(sigma)) continue;
    const double w = 1.0 / (sigma * sigma);
    count += 1.0;
    sum += w;
    sum_x += w * x;
    sum_xx += w * x * x;
    sum_w2 += w * w;
  }
  if (count < 2.0) return {0.0, std::numeric_limits<double>::infinity()};
  const double scale = sum - sum_w2 / sum;
  const double degrees = count - 1.0;
  const double beyond = std::max(sum_xx - sum_x * sum_x / sum - degrees, 0.0);
  const double scatter = std::sqrt(beyond / scale);
  // Variance of the noncentral chi-squared distribution.
  const double sigma2 = std::sqrt(2.0 * degrees + 4.0 * beyond) / scale;
  return {scatter, sigma2 / (2.0 * std::max(scatter, std::sqrt(sigma2)))};
}

Eigen::VectorXd jackknifeSigmas(const Eigen::MatrixXd& without) {
  const auto count = static_cast<double>(without.cols());
  const Eigen::MatrixXd deviations = without.colwise() - without.rowwise().mean();
  return std::sqrt((count - 1.0) / count) * deviations.rowwise().norm();
}

}  // namespace rotrocc
