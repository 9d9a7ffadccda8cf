#include "node/health/recording_inspector.h"

#include <cmath>
#include <cstddef>

#include "input/to_text.h"
#include "node/health/loss_explanation.h"

namespace rotrocc {

std::string RecordingInspector::inspect(const StereoPair& pair,
                                        const StereoCamera& camera,
                                        const OdometryResult& result) {
  const std::string fault = inspector_.inspect(pair, camera, result, {}, [&] { return before_; });
  const std::string explanation = inspector_.finish();
  countReordered(result);
  const bool is_doubtful = result.state == State::kLost || result.state == State::kDegraded;
  if (is_doubtful && result.counts.tries > 0) trySinglePair(pair, camera);
  before_.push_back(copyOf(pair));
  if (before_.size() > kPairsBefore) before_.erase(before_.begin());
  if (result.state == State::kOk) last_ok_ = before_.back();
  return explanation.empty() ? fault : explanation;
}

/// The same pair with other images, from which the motion since the last good pair is found.
void RecordingInspector::trySinglePair(const StereoPair& pair, const StereoCamera& camera) {
  if (!last_ok_ || tried_ == kSinglePairs) return;
  ++tried_;
  const auto agreesMore = [&](const StereoPair& other, std::size_t count) {
    const Agreement agreement = agreementOf(config_, camera, *last_ok_, other);
    return agreement.is_clear && !agreement.stands_still && agreement.count > count;
  };
  const StereoPair& earlier = before_.back();
  const std::size_t few = agreementOf(config_, camera, *last_ok_, pair).count;
  const auto clearly_more = static_cast<std::size_t>(kClearlyMoreAgree * static_cast<double>(few));
  if (agreesMore(exchanged(pair), clearly_more)) {
    ++explained_
        ["match if left and right are swapped: look for a driver that mixes up its cameras"];
  } else if (agreesMore(paired(pair, earlier), clearly_more) ||
             agreesMore(paired(earlier, pair), clearly_more)) {
    ++explained_
        ["match an image of the previous pair: look for a driver that sends images of one "
         "camera in the wrong order"];
  }
}

/// Of two pairs that are exchanged: a step twice as long, one back, and another twice as long.
void RecordingInspector::countReordered(const OdometryResult& result) {
  ++pairs_;
  constexpr std::size_t kSteps = 4;
  constexpr double kSigmas = 5.0, kAlike = 0.5;
  const double sigma_m = std::sqrt(result.covariance.topLeftCorner<3, 3>().trace());
  const Eigen::Vector3d step_m = result.T_prev_cur.translation();
  if (!result.hasMotion() || step_m.norm() < kSigmas * sigma_m) return steps_m_.clear();
  steps_m_.push_back(step_m);
  if (steps_m_.size() > kSteps) steps_m_.erase(steps_m_.begin());
  if (steps_m_.size() < kSteps) return;
  const Eigen::Vector3d& step = steps_m_.front();
  const auto isStep = [&](std::size_t i, double times) {
    return (steps_m_[i] - times * step).norm() < kAlike * step.norm();
  };
  if (isStep(1, 2.0) && isStep(2, -1.0) && isStep(3, 2.0)) ++reordered_;
}

std::string RecordingInspector::faultOfSinglePairs() const {
  constexpr int kLeast = 2, kOfPairs = 4;  // a quarter: a wrong image may cost two pairs or more
  constexpr int kOfSteps = 100;            // fewer may be vibrations of a handheld camera
  if (reordered_ >= kLeast && kOfSteps * reordered_ >= pairs_) {
    return "the camera seems to go back for one pair " + toText(reordered_) +
           " times, as if two pairs were exchanged: look for a driver or recorder that changes the "
           "order of images";
  }
  for (const auto& [text, count] : explained_) {
    if (count < kLeast || kOfPairs * count < tried_) continue;
    return "of the first " + toText(tried_) + " lost or degraded pairs, " + toText(count) + " " +
           text;
  }
  return "";
}

}  // namespace rotrocc
