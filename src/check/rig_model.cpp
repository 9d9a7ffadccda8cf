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

/// The mean over the samples of what `of` returns, an Eigen::Array3d.
template <typename Of>
Eigen::Array3d meanOf(const std::vector<PairSamples>& pairs, const Of& of) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double count = 0.0;
  for (const PairSamples& pair : pairs) {
    for (const RigSample& sample : pair.samples) {
      sum += of(sample);
      count += 1.0;
    }
  }
  return sum / count;
}

/// The root mean square of rows, and of disparities the mean and a part of the scatter: what
/// changes over the image averages out but for about a fourth, on real clips.
Eigen::Vector2d effectOf(const std::vector<PairSamples>& pairs,
                         const RigDisplacement& displacement) {
  constexpr double kOfScatter = 0.25;
  const Eigen::Array3d means = meanOf(pairs, [&](const RigSample& sample) {
    const Eigen::Vector2d moved_px = displacement.of(sample);
    return Eigen::Array3d(moved_px.x(), moved_px.x() * moved_px.x(), moved_px.y() * moved_px.y());
  });
  const double scatter = std::sqrt(std::max(means[1] - means[0] * means[0], 0.0));
  return {std::abs(means[0]) + kOfScatter * scatter, std::sqrt(means[2])};
}

/// A turn and the value in the middle of the image of which it may be the cause.
struct Turn {
  RigCause turn, shift;
  double turn_by_shift;
};

/// How well a turn is known by the shape of its errors. A lens whose rows have the shape of a yaw
/// has other shapes, too: of a third of it, on real cameras.
double sigmaOfShape(RigCause turn, const RigModel& model) {
  return std::hypot(model.sigmas[turn], model.values[kTwist] / 3.0);
}

/// Whether the errors have the shape of the turn which makes the value in the middle, or
/// none: by the ratio of their likelihoods.
TurnOrShift decide(const Turn& turn, const RigModel& model) {
  const double shape = model.values[turn.turn];
  const double by_shift = turn.turn_by_shift * model.values[turn.shift];
  const double likelier = (std::pow(shape, 2) - std::pow(shape - by_shift, 2)) /
                          std::pow(sigmaOfShape(turn.turn, model), 2);
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
    constexpr double kLeast_px = 1.0;
    means_ = meanOf(pairs, [&](const RigSample& sample) {
      const double disparity_px = sample.left_px.x - camera.cx - camera.fx * sample.x_right;
      const double radius2 = sample.x_right * sample.x_right + sample.y * sample.y;
      return Eigen::Array3d(1.0 / std::max(disparity_px, kLeast_px), radius2, 0.0);
    });
    turns_[0] = {{kPitch, kOffset, 1.0 / camera.fy}, &model.vertical};
    turns_[1] = {{kYaw, kBias, -1.0 / camera.fx}, &model.horizontal};
  }

  void decideTurns() {
    fit();
    first_sigmas_ = model_.sigmas;
    first_sigmas_[kBothLenses] = 0.0;  // raw images look like several small errors
    for (const auto& [turn, result] : turns_) *result = decide(turn, model_);
    for (const auto& [turn, result] : turns_) {
      if (*result != TurnOrShift::kTurn) continue;
      problem_.values[turn.turn] = turn.turn_by_shift * problem_.values[turn.shift];
      problem_.leaveOut(turn.shift);
      problem_.is_of_turn[turn.shift] = true;
      first_sigmas_[turn.turn] = 0.0;
    }
  }

  /// Few rigs have a wrong principal point of both cameras, which blurs other values: it must cost
  /// something. With eight parts of the image, 0.02 % exceed 7 sigma by chance.
  void leaveOutInsignificant() {
    constexpr double kSigmas = 3.0, kSigmasOfCenter = 7.0;
    const double costs_px = kAcceptable * kFixScale * camera_.fx;
    for (std::size_t weakest = 0; weakest < kRigCauses;) {
      fit();
      weakest = kRigCauses;
      double least = 1.0;
      for (std::size_t k = 0; k < kRigCauses; ++k) {
        const double limit =
            k < kBothX ? kSigmas * model_.sigmas[k] : kSigmasOfCenter * model_.sigmas[k] + costs_px;
        const double significance = std::abs(model_.values[k]) / limit;
        if (problem_.isLeftOut(k) || significance >= least) continue;
        least = significance;
        weakest = k;
      }
      if (weakest < kRigCauses) problem_.leaveOut(weakest);
    }
    model_.causes = problem_.causesOf(model_.values);
    // That others are left out is no certainty.
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      model_.sigmas[k] = std::max(model_.sigmas[k], first_sigmas_[k]);
    }
    addEffects();
  }

  void addCorrectable() {
    RigCauses values = model_.values;
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      const bool is_of_calibration = k != kTimeSkew && k != kTwist && k < kBothLenses;
      const bool matters = model_.exceeds(kAcceptable, static_cast<RigCause>(k));
      if (!is_of_calibration || !matters) values[k] = 0.0;
    }
    for (const auto& [turn, result] : turns_) {
      if (*result == TurnOrShift::kTurn) continue;
      const Estimate shape = {values[turn.turn], sigmaOfShape(turn.turn, model_)};
      const double unit = model_.severityOf(model_.effects_px[turn.turn]);
      if (!(shape.certain() * unit > 1.0)) values[turn.turn] = 0.0;
      const bool may_be_turn = *result == TurnOrShift::kEither && values[turn.turn] == 0.0;
      if (turn.turn == kPitch) continue;  // both are as good
      // Where it matters which of the two it is, a wrong one may be worse than neither.
      if (may_be_turn && shapeOf(turn) > kAcceptable) values[turn.shift] = 0.0;
    }
    model_.correctable = problem_.causesOf(values);
    std::tie(model_.rows_gain, model_.flow_gain) = problem_.gains(values);
  }

 private:
  void fit() {
    problem_.solve();
    const RigCauses sigmas = problem_.sigmas();
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      if (!problem_.isLeftOut(k)) model_.sigmas[k] = sigmas[k];
    }
    model_.values = problem_.values;
  }

  void addEffects() {
    model_.typical_disparity_px = std::max(1.0 / means_[0] + model_.values[kBias], 1.0);
    for (std::size_t k = 0; k < kRigCauses; ++k) {
      RigCauses alone = {};
      alone[k] = 0.1 * kPriorSigmas[k];
      const RigDisplacement displacement(camera_, problem_.causesOf(alone));
      model_.effects_px[k] = effectOf(pairs_, displacement) / alone[k];
    }
    // Radial distortion k1 r^2 changes the scale of the image by three times as much.
    model_.effects_px[kBothLenses].x() = model_.typical_disparity_px * 3.0 * means_[1];
    // A principal point turns motions, as a part of their length.
    model_.effects_px[kBothX].x() = model_.typical_disparity_px / camera_.fx;
    model_.effects_px[kBothY].x() = model_.typical_disparity_px / camera_.fy;
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
  Eigen::Array3d means_;         // of 1 / disparity, and squared distances from the middle
};

}  // namespace

double RigModel::severityOf(const Eigen::Vector2d& effect_px) const {
  return std::max(effect_px.x() / (kFixScale * typical_disparity_px), effect_px.y() / fix_rows_px);
}

Estimate RigModel::severity(RigCause cause) const {
  return Estimate{std::abs(values[cause]), sigmas[cause]} * severityOf(effects_px[cause]);
}

RigModel fitRig(const StereoCamera& camera,
                const std::vector<PairSamples>& pairs,
                const Windows& windows) {
  RigModel model;
  model.fix_rows_px = 0.4 * camera.detail_px;
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
