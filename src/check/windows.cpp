#include "check/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/median.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::size_t kLeastWindows = 2;
constexpr std::size_t kPairsPerWindow = 5;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::string toText(const Estimate& estimate, const std::string& unit) {
  const auto text = [&](double value, int digits) {
    return std::isfinite(value) ? fixedText(value, digits) : std::string("unknown");
  };
  int digits = 2;
  if (estimate.sigma > 0.0 && std::isfinite(estimate.sigma)) {
    digits = std::clamp(static_cast<int>(std::ceil(-std::log10(estimate.sigma))) + 1, 0, 6);
  }
  return text(estimate.value, digits) + " +- " + text(estimate.sigma, digits) +
         (unit.empty() ? "" : " " + unit);
}

Windows::Windows(double duration_s, std::size_t pairs, std::size_t wanted)
    : count_(std::clamp(pairs / kPairsPerWindow, kLeastWindows, wanted)),
      length_s_(std::max(duration_s, 1e-9) / static_cast<double>(count_)) {}

std::size_t Windows::of(double time_s) const {
  const double window = std::floor(time_s / length_s_);
  return static_cast<std::size_t>(std::clamp(window, 0.0, static_cast<double>(count_ - 1)));
}

Estimate meanOf(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  if (values.empty()) return {kUnknown, kUnknown};
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, count < 2.0 ? kUnknown : std::sqrt(squares / (count - 1.0) / count)};
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
  double count = 0.0, mean = 0.0, squares = 0.0, variance = 0.0;
  for (const Estimate& estimate : values) {
    if (!std::isfinite(estimate.sigma)) continue;
    count += 1.0;
    mean += estimate.value;
    variance += estimate.sigma * estimate.sigma;
  }
  if (count < 2.0) return {0.0, std::numeric_limits<double>::infinity()};
  mean /= count;
  variance /= count;
  for (const Estimate& estimate : values) {
    if (std::isfinite(estimate.sigma))
      squares += std::pow(estimate.value - mean, 2) / (count - 1.0);
  }
  const double scatter = std::sqrt(std::max(squares - variance, 0.0));
  // That of a variance of normal values.
  const double sigma2 = variance * std::sqrt(2.0 / (count - 1.0));
  return {scatter, sigma2 / (2.0 * std::max({scatter, std::sqrt(variance), 1e-12}))};
}

std::vector<double> jackknifeSigmas(const std::vector<std::vector<double>>& without) {
  const auto count = static_cast<double>(without.size());
  std::vector<double> sigmas(without.front().size());
  for (std::size_t k = 0; k < sigmas.size(); ++k) {
    double mean = 0.0;
    for (const auto& values : without) mean += values[k] / count;
    double squares = 0.0;
    for (const auto& values : without) squares += (values[k] - mean) * (values[k] - mean);
    sigmas[k] = std::sqrt((count - 1.0) / count * squares);
  }
  return sigmas;
}

}  // namespace rotrocc
