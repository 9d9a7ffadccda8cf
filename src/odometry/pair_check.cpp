#include "odometry/pair_check.h"

#include <stdexcept>

#include <opencv2/core.hpp>

#include "common/compared_text.h"
#include "common/to_seconds.h"

namespace rotrocc {
namespace {

/// A calibration that changes by less, as one that is refined while driving, describes the same
/// images. The pairs before and after are compared: the error is no more than this, in radians and
/// as a share of the way, where a restart would lose all of the way between them.
constexpr double kRefinedCamera = 1e-3;

}  // namespace

std::optional<std::string> whyUnusable(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const std::optional<std::int64_t>& newest_ns) {
  try {
    camera.check();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  struct Part {
    const char* name;
    const cv::Mat& image;
    bool is_required;
  };
  for (const Part& part : {Part{"left image", pair.left, true},
                           Part{"right image", pair.right, true},
                           Part{"left mask", pair.left_mask, false},
                           Part{"right mask", pair.right_mask, false}}) {
    const auto& [name, image, is_required] = part;
    if (image.empty() && is_required) return cv::format("the %s is empty", name);
    if (image.empty()) continue;
    if (image.type() != CV_8UC1) {
      return cv::format("the %s is of OpenCV type %d, not CV_8UC1", name, image.type());
    }
    if (image.cols == camera.width && image.rows == camera.height) continue;
    return cv::format("the %s has %dx%d pixels", name, image.cols, image.rows) +
           cv::format(", the camera %dx%d", camera.width, camera.height);
  }
  if (!newest_ns || pair.stamp_ns > *newest_ns) return std::nullopt;
  return "the stamp " + std::to_string(pair.stamp_ns) +
         " ns is not later than that of the pair before, " + std::to_string(*newest_ns) + " ns";
}

std::optional<std::string> whyRestart(const StereoPair& pair,
                                      const StereoCamera& camera,
                                      const std::optional<std::int64_t>& newest_ns,
                                      const StereoCamera& camera_before,
                                      double max_gap_s) {
  if (!newest_ns) return "first pair";
  if (camera_before.width != camera.width || camera_before.height != camera.height) {
    return "the size of the images has changed";
  }
  if (const double difference = camera_before.differenceTo(camera); difference > kRefinedCamera) {
    return cv::format("the calibration has changed by %.2g of the focal length or baseline",
                      difference);
  }
  const double gap_s = toSeconds(pair.stamp_ns - *newest_ns);
  if (gap_s <= max_gap_s) return std::nullopt;
  return "no pair for " + comparedText(gap_s, max_gap_s) +
         cv::format(" s, more than max_gap_s = %g", max_gap_s);
}

}  // namespace rotrocc
