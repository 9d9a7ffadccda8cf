#include "bags/recorded_pairs.h"

#include <optional>
#include <stdexcept>

#include "input/to_text.h"

namespace rotrocc {

Rectify rectifyOption(const std::string& text) {
  if (text == "auto") return Rectify::kIfRaw;
  if (text == "yes") return Rectify::kAlways;
  if (text == "no") return Rectify::kNever;
  throw std::invalid_argument("--rectify is '" + text + "', not auto, yes or no");
}

RecordedPairs::RecordedPairs(Recording& recording, const NodeParameters& node, Rectify rectify)
    : recording_(recording),
      synchronizer_(node.max_stamp_difference_s, node.queue_size),
      converter_(node.max_image_pixels, node.significant_bits),
      baseline_m_(node.baseline_m),
      left_info_(recording.firstLeftInfo()),
      right_info_(recording.firstRightInfo()),
      rectifies_(rectify == Rectify::kIfRaw ? recording.isRaw() : rectify == Rectify::kAlways),
      calibration_(node.baseline_m) {
  recording.select(recording.begin(), recording.end(), false);
}

bool RecordedPairs::next(StereoPair& pair, StereoCamera& camera) {
  RecordedMessage message;
  bool complete = false;
  while (!complete && recording_.next(message)) complete = add(message);
  if (!complete) return false;
  try {
    convert(pair, camera);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error("pair of " + toText(images_.left->header.stamp) +
                             " s: " + error.what());
  }
  pair.stamp_ns -= recording_.offset_ns();
  ++pairs_;
  return true;
}

std::string RecordedPairs::leftOut() const {
  if (left_images_ == pairs_) return recording_.leftOut();
  return std::to_string(left_images_ - pairs_) + " left images without a partner";
}

void RecordedPairs::convert(StereoPair& pair, StereoCamera& camera) {
  const StereoCamera current = toStereoCamera(*left_info_, *right_info_, baseline_m_);
  const StereoPair converted = converter_.convert(*images_.left, *images_.right);
  if (rectifies_) validateSize(*images_.left, current);
  pair = rectifies_ ? rectifier_.rectify(converted, calibration_.of(left_info_, right_info_))
                    : converted;
  camera = current;
}

/// Returns whether it completes a pair.
bool RecordedPairs::add(const RecordedMessage& message) {
  std::optional<StereoImages> images;
  if (message.left_image) {
    ++left_images_;
    images = synchronizer_.add(StereoSynchronizer::Side::kLeft, message.left_image);
  } else if (message.right_image) {
    images = synchronizer_.add(StereoSynchronizer::Side::kRight, message.right_image);
  } else if (message.left_info) {
    left_info_ = message.left_info;
  } else if (message.right_info) {
    right_info_ = message.right_info;
  }
  if (images) images_ = *images;
  return images.has_value();
}

}  // namespace rotrocc
