#include "input/stereo_synchronizer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/to_seconds.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

/// Less than the period of usual cameras.
constexpr std::int64_t kUnknownTolerance_ns = 10'000'000;

/// Whether `stamp_ns` is nearer to `a_ns` than to `b_ns`.
bool isNearer(const std::optional<std::int64_t>& stamp_ns, std::int64_t a_ns, std::int64_t b_ns) {
  return stamp_ns && std::abs(*stamp_ns - a_ns) < std::abs(*stamp_ns - b_ns);
}

}  // namespace

StereoSynchronizer::StereoSynchronizer(double max_difference_s, std::size_t queue_size)
    : max_difference_ns_(std::llround(1e9 * max_difference_s)), queue_size_(queue_size) {}

std::optional<StereoImages> StereoSynchronizer::add(Side side,
                                                    const sensor_msgs::Image::ConstPtr& image,
                                                    Time arrival) {
  Images& own = side == Side::kLeft ? left_ : right_;
  Images& other = side == Side::kLeft ? right_ : left_;
  const std::int64_t stamp_ns = toNanoseconds(image->header.stamp);
  if (own.last_stamp_ns == stamp_ns) {
    drop(own);
    return std::nullopt;
  }
  if (own.last_stamp_ns && stamp_ns < *own.last_stamp_ns) {
    // Time jumped back. Images of the other side from after the jump are kept.
    if (!isNearer(other.last_stamp_ns, stamp_ns, *own.last_stamp_ns)) {
      dropLaterThan(stamp_ns + max_difference_ns_, other);
    }
    dropLaterThan(stamp_ns, own);
  }
  own.last_stamp_ns = stamp_ns;

  own.series.add(stamp_ns);
  own.waiting.push_back({stamp_ns, image, arrival});
  if (const auto match = findMatch(own, other)) {
    dropEarlierThan(match->own.stamp_ns, own);
    dropEarlierThan(match->other.stamp_ns, other);
    own.waiting.pop_front();
    other.waiting.pop_front();
    const Waiting& left = side == Side::kLeft ? match->own : match->other;
    const Waiting& right = side == Side::kLeft ? match->other : match->own;
    return StereoImages{left.image, right.image, std::min(left.arrival, right.arrival)};
  }
  if (own.waiting.size() > queue_size_) {
    own.waiting.pop_front();
    drop(own);
  }
  return std::nullopt;
}

/// The partner of the new image; without one, that of an earlier image, because the new one may
/// have told the period.
std::optional<StereoSynchronizer::Match> StereoSynchronizer::findMatch(const Images& own,
                                                                       const Images& other) const {
  const std::int64_t tolerance = tolerance_ns();
  for (auto image = own.waiting.rbegin(); image != own.waiting.rend(); ++image) {
    const auto nearest = std::min_element(
        other.waiting.begin(), other.waiting.end(), [&](const Waiting& a, const Waiting& b) {
          return std::abs(a.stamp_ns - image->stamp_ns) < std::abs(b.stamp_ns - image->stamp_ns);
        });
    if (nearest == other.waiting.end()) return std::nullopt;
    if (std::abs(nearest->stamp_ns - image->stamp_ns) <= tolerance) return Match{*image, *nearest};
  }
  return std::nullopt;
}

std::int64_t StereoSynchronizer::tolerance_ns() const {
  const auto period_ns = commonPeriod_ns(left_.series, right_.series);
  return std::min(max_difference_ns_, period_ns ? *period_ns / 2 : kUnknownTolerance_ns);
}

void StereoSynchronizer::excusePartner(Side side) {
  Images& own = side == Side::kLeft ? left_ : right_;
  Images& other = side == Side::kLeft ? right_ : left_;
  if (own.excused > 0) {  // both are dropped
    --own.excused;
  } else {
    other.excused = std::min(other.excused + 1, queue_size_);
  }
}

void StereoSynchronizer::drop(Images& images) {
  if (images.excused > 0) {
    --images.excused;
    ++excused_;
  } else {
    ++unmatched_[&images == &right_];
  }
}

void StereoSynchronizer::dropEarlierThan(std::int64_t stamp_ns, Images& images) {
  while (!images.waiting.empty() && images.waiting.front().stamp_ns < stamp_ns) {
    images.waiting.pop_front();
    drop(images);
  }
}

void StereoSynchronizer::dropLaterThan(std::int64_t stamp_ns, Images& images) {
  while (!images.waiting.empty() && images.waiting.back().stamp_ns > stamp_ns) {
    images.waiting.pop_back();
    drop(images);
  }
}

}  // namespace rotrocc
