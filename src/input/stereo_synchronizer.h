#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <sensor_msgs/Image.h>

namespace rotrocc {

/// Two images of one moment.
struct StereoImages {
  sensor_msgs::Image::ConstPtr left;
  sensor_msgs::Image::ConstPtr right;
};

/// Matches left and right images by their stamps. A pair is complete with the arrival of its second
/// image: nothing waits for what may come later.
///
/// Either side may deliver late, and stamps may jump back, as when a bag begins anew: images from
/// before the jump find no partner from after it.
class StereoSynchronizer {
 public:
  /// Images whose stamps differ by at most `max_difference_s` are a pair; of more candidates the
  /// nearest. On each side the latest `queue_size` > 0 images wait for a partner.
  StereoSynchronizer(double max_difference_s, std::size_t queue_size);

  /// The pair that `image` completes, if it does. An image with the stamp of the one before it on
  /// its side is not looked at.
  std::optional<StereoImages> addLeft(const sensor_msgs::Image::ConstPtr& image);
  std::optional<StereoImages> addRight(const sensor_msgs::Image::ConstPtr& image);

  /// Images that were given up, as no partner came or their stamp was a repeated one.
  std::uint64_t unmatched() const { return unmatched_; }

  /// Forgets all images that wait; they do not count as unmatched.
  void reset();

 private:
  struct Waiting {
    std::int64_t stamp_ns;
    sensor_msgs::Image::ConstPtr image;
  };
  struct Side {
    std::deque<Waiting> waiting;  // in the order of their stamps
    std::optional<std::int64_t> last_stamp_ns;
  };

  sensor_msgs::Image::ConstPtr add(const sensor_msgs::Image::ConstPtr& image,
                                   Side& own,
                                   Side& other);
  void dropEarlierThan(std::int64_t stamp_ns, Side& side);
  void dropLaterThan(std::int64_t stamp_ns, Side& side);
  const Waiting* findPartner(std::int64_t stamp_ns, const Side& side) const;

  std::int64_t max_difference_ns_;
  std::size_t queue_size_;
  Side left_;
  Side right_;
  std::uint64_t unmatched_ = 0;
};

}  // namespace rotrocc
