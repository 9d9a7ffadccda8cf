#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace rotrocc {

/// Angular velocity [rad/s] in axes of the gyroscope.
struct GyroSample {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d rate_rps = Eigen::Vector3d::Zero();
};

/// Rotation of a gyroscope between two stamps, in its own axes.
struct GyroRotation {
  Eigen::Matrix3d R_from_to = Eigen::Matrix3d::Identity();
  /// With a bias that is larger by d, the rotation is R_from_to * Exp(-by_bias_s * d) for small d.
  Eigen::Matrix3d by_bias_s = Eigen::Matrix3d::Zero();
  double turned_rad = 0.0;  ///< all angles added up, whatever their axes
};

/// The last samples of a gyroscope.
class GyroHistory {
 public:
  static constexpr double kLength_s = 5.0;  ///< older samples are dropped
  /// Fast motions of a hand or a drone have periods of a third of a second: samples further apart
  /// do not follow them.
  static constexpr double kMaxGap_s = 0.05;
  /// A sample that is earlier than the previous one by more than this restarts it, as with a
  /// looping bag.
  static constexpr double kJump_s = 1.0;

  /// Why the sample is rejected, in one sentence; none if it is kept.
  std::optional<std::string> add(const GyroSample& sample);

  /// Stamp of the newest sample; none before the first one.
  std::optional<std::int64_t> newest_ns() const;

  /// Why there is no rotation from `from_ns` to `to_ns`, in one sentence; none if there is one.
  std::optional<std::string> whyUnknown(std::int64_t from_ns, std::int64_t to_ns) const;

  /// The rotation, by the trapezoidal rule. There must be one.
  GyroRotation rotation(std::int64_t from_ns,
                        std::int64_t to_ns,
                        const Eigen::Vector3d& bias_rps) const;

 private:
  using Samples = std::deque<GyroSample>;
  Samples::const_iterator lastUpTo(std::int64_t stamp_ns) const;

  Samples samples_;
};

}  // namespace rotrocc
