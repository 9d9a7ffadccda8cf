#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace rotrocc {

constexpr double kDegrees = 180.0 / M_PI;

/// A value and its standard deviation.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;

  /// The least size that it has for certain: by three standard deviations, because a report has
  /// some twenty findings. Below zero if its sign is not certain; not finite if it is not known.
  double certain() const { return std::abs(value) - 3.0 * sigma; }

  Estimate operator*(double factor) const { return {factor * value, std::abs(factor) * sigma}; }
};

/// "0.702 +- 0.008 px", with as many digits as the uncertainty has a meaning; "unknown" for nan.
std::string toText(const Estimate& estimate, const std::string& unit);

struct TimedValue {
  double time_s = 0.0;
  double value = 0.0;
};

/// The time of a recording in equal windows: as many as wanted, or fewer if there are less than
/// five pairs for each, but at least two, unless one is wanted.
class Windows {
 public:
  Windows(double duration_s, std::size_t pairs, std::size_t wanted = 10);

  std::size_t count() const { return count_; }
  double duration_s() const { return static_cast<double>(count_) * length_s_; }
  std::size_t of(double time_s) const;
  double middle_s(std::size_t window) const {
    return (static_cast<double>(window) + 0.5) * length_s_;
  }

 private:
  std::size_t count_;
  double length_s_;
};

/// The mean, with its standard deviation by the scatter of the values; nan if unknown.
Estimate meanOf(const std::vector<double>& values);

/// The mean of the medians of the windows, with the standard deviation by their scatter, so that
/// errors that last for a while count. Both are nan without values, the deviation with one window.
/// Windows with fewer than `least` values do not count.
Estimate overWindows(const std::vector<TimedValue>& values,
                     const Windows& windows,
                     std::size_t least = 1);

/// The standard deviation of these values beyond their own (DerSimonian and Laird 1986), and its
/// standard deviation; {0, infinity} for less than two finite ones.
Estimate scatterBeyondNoise(const std::vector<Estimate>& values);

/// Standard deviations of several values from estimates that each leave out one window (jackknife,
/// Quenouille 1956, Tukey 1958). Column w of `without` has the values without window w.
Eigen::VectorXd jackknifeSigmas(const Eigen::MatrixXd& without);

}  // namespace rotrocc
