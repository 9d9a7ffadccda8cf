#include "input/stereo_synchronizer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

/// Less than the period of usual cameras.
constexpr std::int64_t kUnknownTolerance_ns = 10'000'000;

}  // namespace

StereoSynchronizer::StereoSynchronizer(double max_difference_s, std::size_t queue_size)
    : max_difference_ns_(std::llround(1e9 * max_difference_s)), queue_size_(queue_size) {}

std::optional<StereoImages> StereoSynchronizer::add(Side side,
                                                    const sensor_msgs::Image::ConstPtr& image,
                                                    const Arrival& arrival) {
  Camera& own = camera(side);
  Camera& other = &own == &left_ ? right_ : left_;
  const std::int64_t stamp_ns = toNanoseconds(image->header.stamp);
  now_ = arrival.time;
  const std::int64_t last_ns = own.clock.lastStamp_ns().value_or(-1);
  if (stamp_ns == last_ns) {
    drop(own);
    return std::nullopt;
  }
  if (stamp_ns < last_ns) {
    // Time jumped back. Images of the other side from after the jump are kept.
    const auto other_ns = other.clock.lastStamp_ns();
    if (!other_ns || std::abs(*other_ns - stamp_ns) >= std::abs(*other_ns - last_ns)) {
      dropLaterThan(stamp_ns + max_difference_ns_, other);
    }
    dropLaterThan(stamp_ns, own);
  }
  own.clock.add(stamp_ns, arrival);
  own.waiting.push_back({stamp_ns, image, arrival.time});
  // Not only the new image may have a partner: it may have shown the period.
  const auto matches = matchStamps(stampsOf(left_), stampsOf(right_), tolerance_ns());
  if (!matches.empty()) {
    const Waiting left = take(matches.back().first, left_);
    const Waiting right = take(matches.back().second, right_);
    return StereoImages{left.image, right.image, std::min(left.arrival, right.arrival)};
  }
  if (own.waiting.size() > queue_size_) {
    own.waiting.pop_front();
    drop(own);
  }
  return std::nullopt;
}

std::int64_t StereoSynchronizer::tolerance_ns() const {
  const auto period = period_ns();
  return std::min(max_difference_ns_, period ? *period / 2 : kUnknownTolerance_ns);
}

std::optional<std::int64_t> StereoSynchronizer::period_ns() const {
  const auto left_ns = left_.clock.period_ns();
  const auto right_ns = right_.clock.period_ns();
  return left_ns && right_ns ? std::min(left_ns, right_ns) : std::max(left_ns, right_ns);
}

void StereoSynchronizer::ignoreMissingPartner(Side side) {
  Camera& own = camera(side);
  Camera& other = &own == &left_ ? right_ : left_;
  if (own.excused > 0) {  // both are dropped
    --own.excused;
  } else {
    other.excused = std::min(other.excused + 1, queue_size_);
  }
}

Stamps StereoSynchronizer::stampsOf(const Camera& camera) {
  Stamps stamps_ns;
  for (const Waiting& image : camera.waiting) stamps_ns.push_back(image.stamp_ns);
  return stamps_ns;
}

/// Removes a waiting image. Those before it have no partner.
StereoSynchronizer::Waiting StereoSynchronizer::take(std::size_t index, Camera& camera) {
  for (; index > 0; --index) {
    camera.waiting.pop_front();
    drop(camera);
  }
  const Waiting taken = camera.waiting.front();
  camera.waiting.pop_front();
  return taken;
}

void StereoSynchronizer::drop(Camera& camera) {
  if (camera.excused == 0) return camera.unmatched.add(now_);
  --camera.excused;
  ++excused_;
}

void StereoSynchronizer::dropLaterThan(std::int64_t stamp_ns, Camera& camera) {
  while (!camera.waiting.empty() && camera.waiting.back().stamp_ns > stamp_ns) {
    camera.waiting.pop_back();
    drop(camera);
  }
}

}  // namespace rotrocc
