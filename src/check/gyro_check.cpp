#include "check/pair_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "common/to_seconds.h"
#include "input/to_text.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Clocks further apart belong to other recordings.
constexpr double kMostDelay_s = 0.2;
constexpr double kStep_s = 0.005;

constexpr Eigen::Index kLeastTurns = 20;

class GyroCheck : public PairCheck {
 public:
  explicit GyroCheck(const GyroRecording& gyroscope) : R_camera_gyro_(gyroscope.R_camera_gyro) {
    std::map<std::int64_t, Eigen::Vector3d> rates_rps;
    for (const GyroSample& sample : gyroscope.samples) {
      rates_rps.emplace(sample.stamp_ns, sample.rate_rps);
    }
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    auto before = rates_rps.begin();
    for (auto sample = before; sample != rates_rps.end(); before = sample++) {
      sum += 0.5 * toSeconds(sample->first - before->first) * (before->second + sample->second);
      sums_rad_.emplace_hint(sums_rad_.end(), sample->first, sum);
    }
  }

  void observe(const CheckedPair& pair) override {
    const OdometryResult& result = pair.result;
    // Over a step of the clock, the gyroscope's turn is another one.
    if (!result.hasMotion() || result.clock_set_ns != result.prev_clock_set_ns) return;
    turns_.push_back({pair.time_s,
                      result.prev_stamp_ns,
                      result.stamp_ns,
                      logRotation(result.T_prev_cur.linear())});
  }

  void report(const Windows& windows, RigReport& report) const override {
    const Fit all = sums_rad_.empty() ? Fit() : fit(turns_);
    if (!std::isfinite(all.rms_rad)) {
      report.findings.push_back({"time",
                                 "cameras against the gyroscope",
                                 "too few motions while the gyroscope was recorded",
                                 "",
                                 "turn the rig about all its axes while recording",
                                 Verdict::kUnknown});
      return;
    }
    Eigen::MatrixXd without(4, windows.count());
    for (std::size_t w = 0; w < windows.count(); ++w) {
      std::vector<Turn> others;
      for (const Turn& turn : turns_) {
        if (windows.of(turn.time_s) != w) others.push_back(turn);
      }
      const Fit fit = this->fit(others);
      without.col(Eigen::Index(w)) << fit.delay_s,
          logRotation(fit.R_camera_gyro * all.R_camera_gyro.transpose());
    }
    const Eigen::VectorXd sigmas = jackknifeSigmas(without);
    report.add({"time",
                "image timestamps against the gyroscope",
                toText(Estimate{1e3 * all.delay_s, 1e3 * sigmas[0]}, "ms") +
                    " to be added to the image timestamps",
                "at 50 deg/s, the predicted rotation is off by " +
                    fixedText(50.0 * std::abs(all.delay_s), 2) + " deg",
                "correct the driver's timestamps, or trigger both from one clock"},
               {{all.delay_s, sigmas[0]}, 0.005, 0.02});
    const double angle = Eigen::AngleAxisd(R_camera_gyro_ * all.R_camera_gyro.transpose()).angle();
    const double angle_sigma = sigmas.tail<3>().norm();
    const Eigen::Quaterniond q(all.R_camera_gyro);
    report.add({"time",
                "gyroscope axes against tf",
                toText(Estimate{angle * kDegrees, angle_sigma * kDegrees}, "deg") +
                    " apart; rotation from gyroscope to left camera according to the images: qx qy "
                    "qz qw " +
                    fixedText(q.x(), 5) + " " + fixedText(q.y(), 5) + " " + fixedText(q.z(), 5) +
                    " " + fixedText(q.w(), 5),
                "rotations are predicted about the wrong axis",
                "correct the transform from the base to the gyroscope, or to the camera"},
               {{angle, angle_sigma}, 1.0 / kDegrees, 3.0 / kDegrees});
  }

 private:
  /// A motion of the camera.
  struct Turn {
    double time_s;
    std::int64_t from_ns, to_ns;
    Eigen::Vector3d camera_rad;  ///< rotation vector, in axes of the camera
  };

  struct Fit {
    double delay_s = 0.0;  ///< to be added to stamps of images to get those of the gyroscope
    Eigen::Matrix3d R_camera_gyro = Eigen::Matrix3d::Identity();
    double rms_rad = std::numeric_limits<double>::infinity();  ///< per second
  };

  /// The rotation vector of the gyroscope during a turn, for one so small that its parts commute.
  std::optional<Eigen::Vector3d> turned(const Turn& turn, double delay_s) const {
    const auto delay_ns = static_cast<std::int64_t>(std::llround(1e9 * delay_s));
    const std::int64_t from_ns = turn.from_ns + delay_ns;
    const std::int64_t to_ns = turn.to_ns + delay_ns;
    if (from_ns < sums_rad_.begin()->first || to_ns >= sums_rad_.rbegin()->first)
      return std::nullopt;
    return turnedUpTo(to_ns) - turnedUpTo(from_ns);
  }

  /// Linear between the samples.
  Eigen::Vector3d turnedUpTo(std::int64_t stamp_ns) const {
    const auto after = sums_rad_.upper_bound(stamp_ns);
    const auto before = std::prev(after);
    const double share =
        toSeconds(stamp_ns - before->first) / toSeconds(after->first - before->first);
    return before->second + share * (after->second - before->second);
  }

  /// The rotation from turn rates, with the bias as a shift (Umeyama 1991).
  Fit fitRotation(double delay_s, const std::vector<Turn>& turns) const {
    const auto most = static_cast<Eigen::Index>(turns.size());
    Eigen::Matrix3Xd camera(3, most), gyro(3, most);
    Eigen::Index count = 0;
    for (const Turn& turn : turns) {
      const auto turned_rad = turned(turn, delay_s);
      if (!turned_rad) continue;
      const double interval_s = toSeconds(turn.to_ns - turn.from_ns);
      camera.col(count) = turn.camera_rad / interval_s;
      gyro.col(count++) = *turned_rad / interval_s;
    }
    if (count < kLeastTurns) return {delay_s};
    camera.conservativeResize(3, count);
    gyro.conservativeResize(3, count);
    const Eigen::Matrix4d fitted = Eigen::umeyama(gyro, camera, false);
    const Eigen::Matrix3d R = fitted.topLeftCorner<3, 3>();
    const Eigen::Matrix3Xd errors = ((R * gyro).colwise() + fitted.topRightCorner<3, 1>()) - camera;
    return {delay_s, R, std::sqrt(errors.squaredNorm() / static_cast<double>(count))};
  }

  /// The delay with the smallest difference: on a grid, then by a parabola.
  Fit fit(const std::vector<Turn>& turns) const {
    Fit best = fitRotation(0.0, turns);
    for (double delay_s = -kMostDelay_s; delay_s <= kMostDelay_s; delay_s += kStep_s) {
      const Fit fit = fitRotation(delay_s, turns);
      if (fit.rms_rad < best.rms_rad) best = fit;
    }
    const auto square = [&](double delay_s) {
      return std::pow(fitRotation(delay_s, turns).rms_rad, 2);
    };
    const double before = square(best.delay_s - kStep_s);
    const double at = square(best.delay_s);
    const double after = square(best.delay_s + kStep_s);
    const double curvature = before - 2.0 * at + after;
    if (!std::isfinite(curvature) || curvature <= 0.0) return best;
    const double step = std::clamp(0.5 * (before - after) / curvature, -1.0, 1.0);
    return fitRotation(best.delay_s + step * kStep_s, turns);
  }

  std::map<std::int64_t, Eigen::Vector3d> sums_rad_;  // integral of the rate up to each stamp
  Eigen::Matrix3d R_camera_gyro_;                     // as configured
  std::vector<Turn> turns_;
};

}  // namespace

std::unique_ptr<PairCheck> makeGyroCheck(const GyroRecording& gyroscope) {
  return std::make_unique<GyroCheck>(gyroscope);
}

}  // namespace rotrocc
