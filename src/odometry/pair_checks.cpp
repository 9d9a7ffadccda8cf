#include "odometry/pair_checks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "common/compared_text.h"
#include "common/to_seconds.h"
#include "features/image_noise.h"

namespace rotrocc {
namespace {

/// After so many, another drive may have begun: the estimator restarts.
constexpr double kSameDrive = 30.0;

/// A calibration that changes by less, as one that is refined while driving, describes the same
/// images. The pairs before and after are compared: the error is no more than this, in radians and
/// as a share of the way, where a restart would lose all of the way between them.
constexpr double kRefinedCamera = 1e-3;

bool isSame(const ImagePyramid& a, const ImagePyramid& b, std::size_t level) {
  return a.size() == b.size() && a[level].size() == b[level].size() &&
         std::memcmp(a[level].data, b[level].data, a[level].total()) == 0;
}

}  // namespace

std::optional<std::string> whyUnusable(const StereoPair& pair, const StereoCamera& camera) {
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
  return std::nullopt;
}

std::optional<std::string> whyRestart(const StereoPair& pair,
                                      const StereoCamera& camera,
                                      const StereoFrame* newest,
                                      const StereoCamera& camera_before,
                                      double period_s) {
  if (newest == nullptr) return "first pair";
  if (camera_before.width != camera.width || camera_before.height != camera.height) {
    return "the size of the images has changed";
  }
  if (const double difference = camera_before.differenceTo(camera); difference > kRefinedCamera) {
    return cv::format("the calibration has changed by %.2g of the focal length or baseline",
                      difference);
  }
  const double gap_s = toSeconds(pair.time_ns() - newest->time_ns());
  const double limit_s = kSameDrive * period_s;
  if (period_s == 0.0 ? gap_s >= 0.0 : std::abs(gap_s) <= limit_s) return std::nullopt;
  return (gap_s > 0.0 ? "no pair for " : "stamps went back by ") +
         comparedText(std::abs(gap_s), limit_s) +
         cv::format(" s, more than %g periods of %.3g s", kSameDrive, period_s);
}

std::optional<std::string> whyRepeated(const StereoPair& pair,
                                       const StereoFrame& current,
                                       const StereoFrame& newest,
                                       const std::function<bool()>& may_repeat) {
  const std::size_t level = current.hasImage() && newest.hasImage() ? 0 : 1;
  const auto isRepeated = [&](const ImagePyramid StereoFrame::*side, const cv::Mat& image) {
    return isSame(current.*side, newest.*side, level) && !isNoise(image);
  };
  const bool left = isRepeated(&StereoFrame::whole_left, pair.left);
  const bool right = isRepeated(&StereoFrame::whole_right, pair.right);
  if (!left && !right) return std::nullopt;
  if (left && right && may_repeat && may_repeat()) return std::nullopt;
  const std::string which = left && right ? "both images are identical to the previous ones"
                            : left        ? "the left image is identical to the previous one"
                                          : "the right image is identical to the previous one";
  return which + ": is the camera frozen, or does its driver repeat images?";
}

}  // namespace rotrocc
