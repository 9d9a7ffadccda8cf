#include "check/rig_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "check/rig_problem.h"

namespace rotrocc {
namespace {

/// Significance below which a value is left out.
constexpr double kSigmas = 3.0;

/// The root mean square of rows, and of disparities the mean and a part of the scatter: what
/// changes over the image averages out but for about a fourth, on real clips.
Eigen::Vector2d effectOf(const std::vector<PairSamples>& pairs,
                         const RigDisplacement& displacement) {
  constexpr double kOfScatter = 0.25;
  double count = 0.0, sum = 0.0, squares = 0.0, rows = 0.0;
  for (const PairSamples& pair : pairs) {
    for (const RigSample& sample : pair.samples) {
      const Eigen::Vector2d moved_px = displacement.of(sample);
      sum += moved_px.x();
      squares += moved_px.x() * moved_px.x();
      rows += moved_px.y() * moved_px.y();
      count += 1.0;
    }
  }
  const double mean = sum / count;
  const double scatter = std::sqrt(std::max(squares / count - mean * mean, 0.0));
  return {std::abs(mean) + kOfScatter * scatter, std::sqrt(rows / count)};
}

/// Mean square distance from the middle of the image, in normalized coordinates.
double meanRadius2(const std::vector<PairSamples>& pairs) {
  double sum = 0.0, count = 0.0;
  for (const PairSamples& pair : pairs) {
    for (const RigSample& sample : pair.samples) {
      sum += sample.x_right * sample.x_right + sample.y * sample.y;
      count += 1.0;
    }
  }
  return sum / count;
}

void addEffects(const StereoCamera& camera,
                const std::vector<PairSamples>& pairs,
                const RigProblem& problem,
                RigModel& model) {
  for (std::size_t k = 0; k < kRigCauses; ++k) {
    RigCauses alone = {};
    alone[k] = 0.1 * kPriorSigmas[k];
    const Eigen::Vector2d effect_px =
        effectOf(pairs, RigDisplacement(camera, problem.causesOf(alone)));
    model.disparities_px[k] = effect_px.x() / alone[k] * std::abs(model.values[k]);
    model.rows_px[k] = effect_px.y() / alone[k] * std::abs(model.values[k]);
  }
  // Radial distortion k1 r^2 changes the scale of the image by three times as much.
  model.disparities_px[kBothLenses] =
      model.typical_disparity_px * 3.0 * meanRadius2(pairs) * std::abs(model.values[kBothLenses]);
}

double typicalOf(const StereoCamera& camera, const std::vector<PairSamples>& pairs) {
  constexpr double kLeast_px = 1.0;
  double inverses = 0.0;
  double count = 0.0;
  for (const PairSamples& pair : pairs) {
    for (const RigSample& sample : pair.samples) {
      const double disparity_px = sample.left_px.x - camera.cx - camera.fx * sample.x_right;
      inverses += 1.0 / std::max(disparity_px, kLeast_px);
      count += 1.0;
    }
  }
  return count / inverses;
}

/// A turn and the value in the middle of the image of which it may be the cause.
struct Turn {
  RigCause turn, shift;
  double turn_by_shift;
};

/// Whether the shape of the errors is that of the turn which makes the value in the middle, or
/// none: by the ratio of their likelihoods. A lens whose rows have the shape of a yaw has other
/// shapes, too: of a third of it, on real cameras.
TurnOrShift decide(const Turn& turn, const RigCauses& values, const RigCauses& sigmas) {
  const double shape = values[turn.turn];
  const double by_shift = turn.turn_by_shift * values[turn.shift];
  const double of_lens = values[kTwist] / 3.0;
  const double sigma = std::hypot(sigmas[turn.turn], of_lens);
  const double likelier = (std::pow(shape, 2) - std::pow(shape - by_shift, 2)) / std::pow(sigma, 2);
  constexpr double kLikelier = 4.0;  // two standard deviations
  if (likelier > kLikelier) return TurnOrShift::kTurn;
  return likelier < -kLikelier ? TurnOrShift::kShift : TurnOrShift::kEither;
}

/// The steps of fitRig(), which fill in the model.
class RigFit {
 public:
  RigFit(const StereoCamera& camera,
         const std::vector<PairSamples>& pairs,
         const Windows& windows,
         RigModel& model)
      : camera_(camera), pairs_(pairs), problem_(camera, pairs, windows), model_(model) {
    typical_px_ = typicalOf(camera, pairs);
    turns_[0] = {{kPitch, kOffset, 1.0 / camera.fy}, &model.vertical};
    turns_[1] = {{kYaw, kBias, -1.0 / camera.fx}, &model.horizontal};
  }

  void decideTurns() {
    fit();
    first_sigmas_ = model_.sigmas;
    first_sigmas_[kBothLenses] =
        0.0;  // images that are not rectified look like several small errors
    for (const auto& [turn, result] : turns_) *result = decide(turn, model_.values, model_.sigmas);
    for (const auto& [turn, result] : turns_) {
      if (*result != TurnOrShift::kTurn) continue;
      problem_.values[turn.turn] = turn.turn_by_shift * problem_.values[turn.shift];
      problem_.leaveOut(turn.shift);
      problem_.is_of_turn[turn.shift] = true;
      first_sigmas_[turn.turn] = 0.0;
    }
  }

  void leaveOutInsignificant() {
    for (std::size_t weakest = 0; weakest < kRigCauses;) {
      fit();
      weakest = kRigCauses;
      double least = kSigmas;
      for (std::size_t k = 0; k < kRigCauses; ++k) {
        const double significance = std::abs(model_.values[k]) / model_.sigmas[k];
        if (problem_.isLeftOut(k) || significance >= least) continue;
        least = significance;
        weakest = k;
      }
      if (weakest < kRigCauses) problem_.leaveOut(weakest);
    }
    if (!problem_.isLeftOut(kTimeSkew)) {
      problem_.skew_is_of_rows = true;
      fit();
    }
    model_.causes = problem_.causesOf(model_.values);
    // That others are left out is no certainty.
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      model_.sigmas[k] = std::max(model_.sigmas[k], first_sigmas_[k]);
    }
  }

  void addCorrectable() {
    RigCauses values = model_.values;
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      const bool is_of_calibration = k != kTimeSkew && k != kTwist && k != kBothLenses;
      const bool matters = model_.exceeds(kAcceptable, static_cast<RigCause>(k));
      if (!is_of_calibration || !matters) values[k] = 0.0;
    }
    for (const auto& [turn, result] : turns_) {
      if (*result == TurnOrShift::kTurn) continue;
      if (!model_.exceeds(1.0, turn.turn)) values[turn.turn] = 0.0;
      const bool may_be_turn = *result == TurnOrShift::kEither && values[turn.turn] == 0.0;
      if (turn.turn == kPitch) continue;  // both are as good
      // Where it matters which of the two it is, a wrong one may be worse than neither.
      if (may_be_turn && shapeOf(turn) > kAcceptable) values[turn.shift] = 0.0;
    }
    model_.correctable = problem_.causesOf(values);
    std::tie(model_.rows_gain, model_.flow_gain) = problem_.gains(values);
    model_.biases_px = problem_.biases();
  }

 private:
  void fit() {
    problem_.solve();
    const RigCauses sigmas = problem_.sigmas();
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      if (!problem_.isLeftOut(k)) model_.sigmas[k] = sigmas[k];
    }
    model_.values = problem_.values;
    model_.typical_disparity_px = std::max(typical_px_ + model_.values[kBias], 1.0);
    addEffects(camera_, pairs_, problem_, model_);
  }

  /// The severity of what a turn in place of a shift would change.
  double shapeOf(const Turn& turn) const {
    RigCauses turned = {};
    turned[turn.turn] = turn.turn_by_shift * model_.values[turn.shift];
    return model_.severityOf(effectOf(pairs_, RigDisplacement(camera_, problem_.causesOf(turned))));
  }

  const StereoCamera& camera_;
  const std::vector<PairSamples>& pairs_;
  RigProblem problem_;
  RigModel& model_;
  std::array<std::pair<Turn, TurnOrShift*>, 2> turns_;
  RigCauses first_sigmas_ = {};  // with all values
  double typical_px_;
};

}  // namespace

double RigModel::severityOf(const Eigen::Vector2d& effect_px) const {
  return std::max(effect_px.x() / (kFixScale * typical_disparity_px), effect_px.y() / kFixRows_px);
}

Estimate RigModel::severity(RigCause cause) const {
  if (values[cause] == 0.0) return {0.0, std::isfinite(sigmas[cause]) ? 0.0 : sigmas[cause]};
  const double severity = severityOf({disparities_px[cause], rows_px[cause]});
  return {severity, severity / std::abs(values[cause]) * sigmas[cause]};
}

bool RigModel::exceeds(double limit, RigCause cause) const {
  const Estimate severity = this->severity(cause);
  return severity.value - kSigmas * severity.sigma > limit;
}

RigModel fitRig(const StereoCamera& camera,
                const std::vector<PairSamples>& pairs,
                const Windows& windows) {
  RigModel model;
  std::size_t count = 0;
  for (const PairSamples& pair : pairs) count += pair.samples.size();
  if (count < kLeastSamples) {
    model.sigmas.fill(std::numeric_limits<double>::infinity());
    return model;
  }
  // More samples would change the uncertainties, which are of windows and parts, by little.
  constexpr std::size_t kMostSamples = 20000;
  std::vector<PairSamples> fitted;
  const std::size_t step = count / kMostSamples + 1;
  for (std::size_t i = 0; i < pairs.size(); i += step) fitted.push_back(pairs[i]);
  RigFit fit(camera, fitted, windows, model);
  fit.decideTurns();
  fit.leaveOutInsignificant();
  fit.addCorrectable();
  return model;
}

}  // namespace rotrocc
