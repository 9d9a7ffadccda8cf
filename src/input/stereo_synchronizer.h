#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <sensor_msgs/Image.h>

#include "common/to_seconds.h"
#include "input/stamp_series.h"

namespace rotrocc {

/// Two images of the same time.
struct StereoImages {
  sensor_msgs::Image::ConstPtr left;
  sensor_msgs::Image::ConstPtr right;
  std::chrono::steady_clock::time_point first_arrival{};  ///< of either
};

/// Matches left and right images by their stamps. A pair is complete with the arrival of its second
/// image.
///
/// Images whose stamps differ by more than half the period of the images are never a pair: after a
/// lost image, each would get the partner of its neighbour. While no period is known, and their
/// stamps are apart, the first two images wait for the next one.
///
/// Either side may be late, and stamps may jump back, e.g. with a looping bag: images from before
/// and after a jump are not matched.
class StereoSynchronizer {
 public:
  /// Images whose stamps differ by at most `max_difference_s` may be a pair; of several candidates
  /// the nearest is used. Each side keeps the latest `queue_size` > 0 unmatched images.
  StereoSynchronizer(double max_difference_s, std::size_t queue_size);

  using Time = std::chrono::steady_clock::time_point;

  /// One of the two cameras.
  enum class Side { kLeft, kRight };

  /// The pair that `image` completes, if any. An image with the same stamp as the previous one of
  /// its side is ignored.
  std::optional<StereoImages> add(Side side,
                                  const sensor_msgs::Image::ConstPtr& image,
                                  Time arrival = {});

  /// An image of `side` was dropped before it came here: the one that would be its partner counts
  /// as excused, not as unmatched.
  void excusePartner(Side side);

  /// Number of images dropped without a partner or with a repeated stamp.
  std::uint64_t unmatched() const { return unmatched(Side::kLeft) + unmatched(Side::kRight); }
  std::uint64_t unmatched(Side side) const { return unmatched_[side == Side::kRight]; }
  std::uint64_t excused() const { return excused_; }

  /// The largest difference that is accepted now.
  double tolerance_s() const { return toSeconds(tolerance_ns()); }

  /// Stamps that have arrived.
  const StampSeries& leftStamps() const { return left_.series; }
  const StampSeries& rightStamps() const { return right_.series; }

  /// Discards all waiting images; they do not count as unmatched.
  void reset() { left_ = right_ = {}; }

 private:
  struct Waiting {
    std::int64_t stamp_ns;
    sensor_msgs::Image::ConstPtr image;
    Time arrival;
  };
  struct Images {
    std::deque<Waiting> waiting;  // in the order of their stamps
    std::optional<std::int64_t> last_stamp_ns;
    StampSeries series;
    std::size_t excused = 0;  // of those that are dropped next
  };
  /// Two of one time.
  struct Match {
    Waiting own, other;
  };

  std::optional<Match> findMatch(const Images& own, const Images& other) const;
  std::int64_t tolerance_ns() const;
  void drop(Images& images);
  void dropEarlierThan(std::int64_t stamp_ns, Images& images);
  void dropLaterThan(std::int64_t stamp_ns, Images& images);

  std::int64_t max_difference_ns_;
  std::size_t queue_size_;
  Images left_, right_;
  std::array<std::uint64_t, 2> unmatched_{};  // of left and right
  std::uint64_t excused_ = 0;
};

}  // namespace rotrocc
