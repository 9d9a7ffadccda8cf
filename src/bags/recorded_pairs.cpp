#include "bags/recorded_pairs.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "input/message_conversion.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

NodeParameters withRectify(NodeParameters node,
                           bool rectify,
                           const StereoCalibration* calibration) {
  node.rectify = rectify && !calibration;
  if (calibration) node.baseline_m = calibration->rectified.baseline_m;
  return node;
}

}  // namespace

RecordedPairs::RecordedPairs(Recording& recording,
                             const NodeParameters& node,
                             const std::string& rectify,
                             std::shared_ptr<const StereoCalibration> calibration)
    : recording_(recording),
      calibration_(std::move(calibration)),
      rectifies_(calibration_ || (rectify == "auto" ? recording.isRaw() : rectify == "yes")),
      intake_(withRectify(node, rectifies_, calibration_.get()),
              drops_,
              [this](ReceivedPair pair) { received_.push_back(std::move(pair)); }),
      converter_(node.significant_bits, node.mask) {
  if (rectify != "auto" && rectify != "yes" && rectify != "no") {
    throw std::invalid_argument("--rectify is '" + rectify + "', not auto, yes or no");
  }
  recording.select(recording.begin(), recording.end(), false);
  add(recording.firstInfos());
}

bool RecordedPairs::next(StereoPair& pair, StereoCamera& camera) {
  while (!received_.empty() || readMessage()) {
    if (received_.empty()) continue;
    current_ = std::move(received_.front());
    received_.pop_front();
    if (calibration_) {
      current_.calibration = calibration_;
      current_.camera = calibration_->rectified;
    }
    try {
      pair = converter_.convert(current_);
    } catch (const InputError& error) {
      const std::string stamp = toText(current_.images.left->header.stamp);
      drops_.add(InputError(error.reason(), "pair of " + stamp + " s: " + error.what()));
      continue;
    }
    pair.stamp_ns -= recording_.offset_ns();
    camera = current_.camera;
    ++pairs_;
    return true;
  }
  if (pairs_ > 0) return false;
  const auto last = drops_.lastWithin(std::chrono::hours(1));
  throw std::runtime_error("there is no pair that can be used" +
                           (last ? std::string(": ") + last->what() : ""));
}

std::string RecordedPairs::leftOut() const {
  std::string reasons;
  for (const auto& [reason, count] : drops_.counts()) {
    reasons += (reasons.empty() ? " (" : ", ") + std::to_string(count) + " " + toString(reason);
  }
  const int left_out = recording_.size() - pairs_;
  std::string text = recording_.leftOut();
  if (left_out == 0 && reasons.empty()) return text;
  text += (text.empty() ? "" : ", ") + std::to_string(left_out) + " of " +
          std::to_string(recording_.size()) + " pairs";
  return text + (reasons.empty() ? "" : reasons + ")");
}

/// Returns false at the end.
bool RecordedPairs::readMessage() {
  RecordedMessage message;
  try {
    if (!recording_.next(message)) return false;
    observe_(message);
    add(message);
  } catch (const InputError& error) {
    drops_.add(error);
  }
  return true;
}

void RecordedPairs::add(const RecordedMessage& message) {
  using Side = StereoIntake::Side;
  // Not ROS time: the clock of the recorder may have been another one than that of the cameras.
  const std::chrono::nanoseconds time(toNanoseconds(message.time));
  const Arrival arrival = {std::chrono::steady_clock::time_point(time)};
  if (message.left_info) intake_.addInfo(Side::kLeft, message.left_info, arrival);
  if (message.right_info) intake_.addInfo(Side::kRight, message.right_info, arrival);
  if (message.left_image) intake_.addImage(Side::kLeft, message.left_image, arrival);
  if (message.right_image) intake_.addImage(Side::kRight, message.right_image, arrival);
}

}  // namespace rotrocc
