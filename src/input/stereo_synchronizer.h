#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <sensor_msgs/Image.h>

#include "input/camera_clock.h"
#include "input/input_report.h"

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
/// lost image, each would get the partner of its neighbor. While no period is known, and their
/// stamps are apart, the first two images wait for the next one.
///
/// Either side may be late, and stamps may jump back, e.g. with a looping bag: images from before
/// and after a jump are not matched.
class StereoSynchronizer {
 public:
  /// Images whose stamps differ by at most `max_difference_s` may be a pair; of several candidates
  /// the nearest is used. Each side keeps the latest `queue_size` > 0 unmatched images.
  StereoSynchronizer(double max_difference_s, std::size_t queue_size);

  /// One of the two cameras.
  enum class Side { kLeft, kRight };

  /// The pair that `image` completes, if any. An image with the same stamp as the previous one of
  /// its side is ignored.
  std::optional<StereoImages> add(Side side,
                                  const sensor_msgs::Image::ConstPtr& image,
                                  const Arrival& arrival = {});

  /// An image of `side` was dropped before it came here: the one that would be its partner counts
  /// as excused, not as unmatched.
  void ignoreMissingPartner(Side side);

  /// Images dropped without a partner or with a repeated stamp.
  std::uint64_t unmatched() const { return left_.unmatched.total() + right_.unmatched.total(); }
  const TopicStatistics& unmatched(Side side) const { return camera(side).unmatched; }
  std::uint64_t excused() const { return excused_; }

  /// Judges images before they are added, and knows those that were.
  CameraClock& clock(Side side) { return camera(side).clock; }
  const CameraClock& clock(Side side) const { return camera(side).clock; }

  /// The shorter period of the two cameras, as far as it is known.
  std::optional<std::int64_t> period_ns() const;
  /// The largest difference that is accepted now.
  std::int64_t tolerance_ns() const;

 private:
  struct Waiting {
    std::int64_t stamp_ns;
    sensor_msgs::Image::ConstPtr image;
    std::chrono::steady_clock::time_point arrival;
  };
  struct Camera {
    CameraClock clock;
    std::deque<Waiting> waiting = {};  // in the order of their stamps
    std::size_t excused = 0;           // of those that are dropped next
    TopicStatistics unmatched = {};
  };

  const Camera& camera(Side side) const { return side == Side::kLeft ? left_ : right_; }
  Camera& camera(Side side) { return side == Side::kLeft ? left_ : right_; }
  static Stamps stampsOf(const Camera& camera);
  Waiting take(std::size_t index, Camera& camera);
  void drop(Camera& camera);
  void dropLaterThan(std::int64_t stamp_ns, Camera& camera);

  std::int64_t max_difference_ns_;
  std::size_t queue_size_;
  Camera left_{CameraClock("the left image")}, right_{CameraClock("the right image")};
  std::uint64_t excused_ = 0;
  TopicStatistics::Time now_;
};

}  // namespace rotrocc
