#include "input/stereo_synchronizer.h"

#include <cmath>
#include <cstdlib>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

/// Whether `stamp_ns` is nearer to `a_ns` than to `b_ns`.
bool isNearer(const std::optional<std::int64_t>& stamp_ns, std::int64_t a_ns, std::int64_t b_ns) {
  return stamp_ns && std::abs(*stamp_ns - a_ns) < std::abs(*stamp_ns - b_ns);
}

}  // namespace

StereoSynchronizer::StereoSynchronizer(double max_difference_s, std::size_t queue_size)
    : max_difference_ns_(std::llround(1e9 * max_difference_s)), queue_size_(queue_size) {}

std::optional<StereoImages> StereoSynchronizer::addLeft(const sensor_msgs::Image::ConstPtr& image) {
  const auto right = add(image, left_, right_);
  if (!right) return std::nullopt;
  return StereoImages{image, right};
}

std::optional<StereoImages> StereoSynchronizer::addRight(
    const sensor_msgs::Image::ConstPtr& image) {
  const auto left = add(image, right_, left_);
  if (!left) return std::nullopt;
  return StereoImages{left, image};
}

void StereoSynchronizer::reset() {
  left_ = {};
  right_ = {};
}

/// Returns the partner of `image`; if there is none, stores the image.
sensor_msgs::Image::ConstPtr StereoSynchronizer::add(const sensor_msgs::Image::ConstPtr& image,
                                                     Side& own,
                                                     Side& other) {
  const std::int64_t stamp_ns = toNanoseconds(image->header.stamp);
  if (own.last_stamp_ns == stamp_ns) {
    ++unmatched_;
    return nullptr;
  }
  if (own.last_stamp_ns && stamp_ns < *own.last_stamp_ns) {
    // Time jumped back. Images of the other side from after the jump are kept.
    if (!isNearer(other.last_stamp_ns, stamp_ns, *own.last_stamp_ns)) {
      dropLaterThan(stamp_ns + max_difference_ns_, other);
    }
    dropLaterThan(stamp_ns, own);
  }
  own.last_stamp_ns = stamp_ns;

  if (const Waiting* found = findPartner(stamp_ns, other)) {
    const Waiting partner = *found;
    dropEarlierThan(stamp_ns, own);
    dropEarlierThan(partner.stamp_ns, other);
    other.waiting.pop_front();
    return partner.image;
  }
  own.waiting.push_back({stamp_ns, image});
  if (own.waiting.size() > queue_size_) {
    own.waiting.pop_front();
    ++unmatched_;
  }
  return nullptr;
}

void StereoSynchronizer::dropEarlierThan(std::int64_t stamp_ns, Side& side) {
  while (!side.waiting.empty() && side.waiting.front().stamp_ns < stamp_ns) {
    side.waiting.pop_front();
    ++unmatched_;
  }
}

void StereoSynchronizer::dropLaterThan(std::int64_t stamp_ns, Side& side) {
  while (!side.waiting.empty() && side.waiting.back().stamp_ns > stamp_ns) {
    side.waiting.pop_back();
    ++unmatched_;
  }
}

const StereoSynchronizer::Waiting* StereoSynchronizer::findPartner(std::int64_t stamp_ns,
                                                                   const Side& side) const {
  const Waiting* nearest = nullptr;
  for (const Waiting& candidate : side.waiting) {
    const std::int64_t difference_ns = std::abs(candidate.stamp_ns - stamp_ns);
    if (difference_ns > max_difference_ns_) continue;
    if (nearest == nullptr || difference_ns < std::abs(nearest->stamp_ns - stamp_ns)) {
      nearest = &candidate;
    }
  }
  return nearest;
}

}  // namespace rotrocc
