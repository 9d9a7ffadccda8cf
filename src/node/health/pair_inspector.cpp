#include "node/health/pair_inspector.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Share of the features that agree on the motion of a pair.
constexpr double kMostAgree = 0.8;
/// Searches that find nothing, after which an explanation no longer holds.
constexpr int kSearches = 2;
/// Ratio of contrasts that causes a hint: one stop. On real clips, right images with half of their
/// contrast cost nothing.
constexpr double kApart = 2.0;
/// Share of the gains that is dropped at either end: single pairs may be wrong.
constexpr double kDropped = 0.1;

}  // namespace

StereoPair copyOf(StereoPair pair) {
  pair.left = pair.left.clone();
  pair.right = pair.right.clone();
  return pair;
}

PairInspector::PairInspector(const OdometryConfig& config, bool rectifies)
    : rectifies_(rectifies), config_(config) {}

void PairInspector::configure(const OdometryConfig& config) {
  config_ = config;
  reset();
}

std::string PairInspector::inspect(const StereoPair& pair,
                                   const StereoCamera& camera,
                                   const OdometryResult& result,
                                   const GrayRange& range,
                                   const PairsBefore& before) {
  const std::string fault = compareExposures(result);
  // Of a pair that was not tried the odometry knows why.
  if (result.state == State::kInitializing || result.counts.tries == 0) return fault;
  if (result.state == State::kOk) {
    // Chance matches may look like a motion: one of them takes back few of the doubts.
    doubtful_ -= 1 + doubtful_ / kPatience;
    explain_at_ = std::min(explain_at_, std::max(kPatience, 2 * doubtful_));
    if (doubtful_ <= 0) reset();
    return fault;
  }
  ++doubtful_;
  try {
    explain(pair, camera, result, range, before);
  } catch (const std::exception&) {
    return fault;  // no memory, or no thread
  }
  return explanation_.text.empty() ? fault : explanation_.text;
}

/// Takes over the explanation if there is a new one, and looks for the next one if it is time.
/// Throws std::exception if it cannot be looked for.
void PairInspector::explain(const StereoPair& pair,
                            const StereoCamera& camera,
                            const OdometryResult& result,
                            const GrayRange& range,
                            const PairsBefore& before) {
  if (search_.valid()) {
    if (search_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    finish();
  }
  if (doubtful_ < explain_at_) return;
  explain_at_ = 2 * doubtful_;
  search_is_of_this_loss_ = true;
  std::vector<StereoPair> pairs;
  try {
    if (before) pairs = before();
  } catch (const std::exception&) {  // one of them is damaged: lateness is not reported
  }
  pairs.push_back(copyOf(pair));
  search_ = std::async(
      std::launch::async,
      [pairs = std::move(pairs), config = config_, camera, result, rectifies = rectifies_, range] {
        pthread_setname_np(pthread_self(), "odometry_hint");
        return explainLoss(pairs, config, camera, result, rectifies, range);
      });
}

OdometryResult PairInspector::distrusted(OdometryResult result) const {
  if (!isOfNoPair() || !result.hasMotion()) return result;
  if (result.counts.rotation_inliers >= kMostAgree * result.counts.consistent) {
    result.state = State::kDegraded;
    result.reason = "left and right images did not match shortly before";
    return result;
  }
  result.state = State::kLost;
  result.reason = "left and right images do not match";
  result.T_prev_cur.setIdentity();
  result.covariance.setZero();
  result.contrast_gain = result.flow_noise_px = 0.0;
  return result;
}

void PairInspector::reset() {
  doubtful_ = 0;
  explain_at_ = kPatience;
  explanation_ = {};
  search_is_of_this_loss_ = false;
  found_nothing_ = 0;
}

std::string PairInspector::finish() {
  if (search_.valid()) {
    const Explanation found = search_.get();
    if (!search_is_of_this_loss_) return explanation_.text;
    // Not each pair shows it.
    const bool is_less = found.is_guess && !explanation_.text.empty();
    found_nothing_ = found.text.empty() || is_less ? found_nothing_ + 1 : 0;
    if (found_nothing_ == 0 || found_nothing_ >= kSearches) explanation_ = found;
  }
  return explanation_.text;
}

bool PairInspector::isUnexplained() const {
  return found_nothing_ >= kSearches && explanation_.text.empty();
}

std::string PairInspector::compareExposures(const OdometryResult& result) {
  constexpr const char* kRemedy = ": couple the exposures of the cameras";
  if (result.hasMotion()) gains_.push_back(result.contrast_gain);
  if (gains_.size() < kMinExposures) return "";
  const double least = quantileOf(gains_, kDropped);
  const double most = quantileOf(gains_, 1.0 - kDropped);
  if (most > kApart * least) {
    return "the right camera's contrast moves between " + hundredths(least) + " and " +
           hundredths(most) + " times the left one's" + kRemedy;
  }
  const double typical = quantileOf(gains_, 0.5);
  if (std::max(typical, 1.0 / typical) <= kApart) return "";
  return "the right camera's contrast is " + hundredths(typical) + " times the left one's" +
         kRemedy;
}

}  // namespace rotrocc
