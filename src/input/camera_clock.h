#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "input/input_error.h"
#include "input/stamps.h"

namespace rotrocc {

/// Arrival of a message: by the steady clock, and in ROS time (0 if unknown).
struct Arrival {
  std::chrono::steady_clock::time_point time;
  std::int64_t clock_ns = 0;

  /// In ROS time, or else by the steady clock.
  std::int64_t ns() const {
    return clock_ns != 0 ? clock_ns : std::chrono::nanoseconds(time.time_since_epoch()).count();
  }
};

/// Stamps of another clock are further from ROS time, as in a replay without /clock.
constexpr double kOtherClock_s = 3600.0;

/// The clock that stamps the images of a camera, as seen by their arrival: its period, offset and
/// scatter over the latest images. Separates valid stamps from those of a faulty driver and from
/// time jumps, e.g. of a looping bag.
///
/// A stamp that is further ahead of the arrival than those before it (the first one: than any skew
/// of synchronized clocks), or far behind them, is a glitch or the first one after a jump. The next
/// image decides: until then this one is held.
class CameraClock {
 public:
  /// What to do with an image, and with the previous one if that was held.
  struct Verdict {
    bool held = false;                 ///< keep the image until the next call
    bool held_is_valid = false;        ///< the previous one is the first after a jump: use it first
    std::optional<InputError> glitch;  ///< the previous one must be dropped
  };

  /// `images`: name in messages, as "the left image".
  explicit CameraClock(std::string images) : images_(std::move(images)) {}

  /// Judges the next image that arrives. Whichever image is valid must be added. Throws InputError
  /// on a stamp that is zero, repeated, or slightly earlier than the previous one; an image that is
  /// held stays so.
  ///
  /// An earlier stamp is valid at once if the clock jumped back as well, or if it is that of the
  /// first images or an earlier one, as in a loop. One less than ten periods earlier is valid if it
  /// is the third in a row.
  Verdict judge(std::int64_t stamp_ns, const Arrival& arrival);

  /// Adds a valid image.
  void add(std::int64_t stamp_ns, const Arrival& arrival);

  /// By how much the clock was set forward since the first image, in steps while images kept
  /// arriving; a loop is none.
  std::int64_t set_ns() const { return set_ns_; }
  /// The same at one of the latest images.
  std::int64_t setAt_ns(std::int64_t stamp_ns) const;

  std::optional<std::int64_t> lastStamp_ns() const;
  /// The latest ones since time jumped back.
  Stamps stamps_ns() const;
  /// See periodOf(). Outlasts time jumps.
  std::optional<std::int64_t> period_ns() const { return period_ns_; }
  /// How far ROS time is ahead of the stamps of recent images in time when they arrive. None if
  /// there are none, or ROS time is unknown.
  std::optional<double> age_s() const;
  /// Standard deviation, robust against outliers, of the stamps about their period, and of the time
  /// from stamp to arrival [s]; 0 before there are two images.
  double stampScatter_s() const;
  double arrivalScatter_s() const;

 private:
  struct Image {
    std::int64_t stamp_ns;
    Arrival arrival;
    std::int64_t set_ns = 0;

    std::int64_t ahead_ns() const { return stamp_ns - arrival.ns(); }
  };

  bool continues(const Image& image);
  bool goesBack(const Image& image);
  bool isStartOfLoop(std::int64_t stamp_ns) const;
  std::int64_t stepTo(const Image& image) const;
  std::int64_t usualAhead_ns() const;
  double periods_ns(double count) const;

  std::string images_;
  std::deque<Image> latest_;
  std::optional<std::int64_t> period_ns_;
  std::optional<std::int64_t> first_stamp_ns_;  // since time jumped back
  std::int64_t set_ns_ = 0;
  std::optional<Image> held_;
  std::int64_t last_arrival_ns_ = 0;
  bool arrival_went_back_ = false;  // since the last valid image
  int backward_in_a_row_ = 0;
};

}  // namespace rotrocc
