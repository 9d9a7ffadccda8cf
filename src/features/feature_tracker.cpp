#include "features/feature_tracker.h"

#include <algorithm>
#include <cmath>

#include "features/image_noise.h"
#include "features/patch.h"

namespace rotrocc {
namespace {

/// Sum of squares [gray levels^2] below which a window is plain: keeps steps finite.
constexpr double kMinVariance = 1e-3;

/// Gray levels, and gray levels times gradients, in the units of the kernels.
constexpr double kOfGradient = 1.0 / (1 << Window::kGradientBits);
constexpr double kOfContrast = 1.0 / (1 << Window::kContrastBits);
constexpr double kOfDifference = 1.0 / (1 << MismatchSums::kDifferenceBits);

/// Pixels in a row of a patch, of which all but the last one are read in whole registers.
constexpr int stepOf(int side) {
  return (side + kMaxShorts - 2) / kMaxShorts * kMaxShorts + 1;
}

bool contains(const cv::Mat& image, const cv::Point2f& point) {
  return cv::Rect2f({}, cv::Size2f(image.size())).contains(point);
}

constexpr int kMaxRadius_px = Window::kMaxSide / 2;

/// A window whose border moves by less with the scale is taken as it is.
constexpr float kMinStretch_px = 0.3F;

/// A point within this fraction of the window's radius counts as close to its prediction.
constexpr double kNear = 0.5;

/// Correlation of a window with the place where it is found. Most wrong places have less.
constexpr double kMinCorrelation = 0.6;

/// Gauss-Newton converges within a few iterations of a level.
constexpr int kMaxIterations = 6;

/// Steps below a fraction of the flow's noise, about 0.1 px, gain nothing.
constexpr TrackingWindow::Stop kStop = {0.04};

/// The small images only provide a start for the large one.
constexpr TrackingWindow::Stop kRoughly = {0.12};

/// Scale of pixel coordinates in a level of the pyramid.
float scaleOf(std::size_t level) {
  return 1.0F / static_cast<float>(1 << level);
}

}  // namespace

TrackingWindow::TrackingWindow(int radius_px)
    : kernels_(&chooseKernels()),
      radius_(radius_px),
      side_(2 * radius_px + 1),
      copy_(static_cast<std::size_t>((side_ + 3) * stepOf(side_ + 3))) {
  CV_Assert(side_ <= Window::kMaxSide);
  window_.side = side_;
  std::fill_n(window_.mask, side_, std::int16_t{-1});
}

/// The patch for a window of the given radius, of the image enlarged by `scale`. Pixels outside the
/// image repeat its border.
Patch TrackingWindow::patchAround(const cv::Mat& image,
                                  const cv::Point2f& center,
                                  int radius,
                                  float scale) {
  if (scale != 1.0F) return resample(image, center, radius, scale);
  const int side = 2 * radius + 2;
  const int step = stepOf(side);
  // Registers read on in the next row, and not beyond it.
  const cv::Rect inside(radius, radius, image.cols - side + 1, image.rows - side);
  const cv::Point whole(cvFloor(center.x), cvFloor(center.y));
  if (inside.contains(whole) && step <= image.cols) return patchAt(image, center, radius);
  for (int y = 0; y < side; ++y) {
    const auto* row = image.ptr<uchar>(std::clamp(whole.y - radius + y, 0, image.rows - 1));
    uchar* out = &copy_[static_cast<std::size_t>(y * step)];
    for (int x = 0; x < side; ++x)
      out[x] = row[std::clamp(whole.x - radius + x, 0, image.cols - 1)];
  }
  const cv::Point2f rest = center - cv::Point2f(whole);
  return {copy_.data(), step, fractionOf(rest.x), fractionOf(rest.y)};
}

Patch TrackingWindow::resample(const cv::Mat& image,
                               const cv::Point2f& center,
                               int radius,
                               float scale) {
  constexpr int kBits = 10;
  struct Place {
    int before, after, part;  // after `before`, in units of 1 / 2^kBits
  };
  const auto placeOf = [&](int i, float middle, int count) -> Place {
    const float at = middle + static_cast<float>(i - radius) / scale;
    const int units = cvRound((1 << kBits) * std::clamp(at, 0.0F, static_cast<float>(count - 1)));
    const int before = units >> kBits;
    return {before, std::min(before + 1, count - 1), units - (before << kBits)};
  };
  const auto between = [](int a, int b, int part) { return (a << kBits) + part * (b - a); };
  const int side = 2 * radius + 2;
  Place columns[Window::kMaxSide + 3];
  for (int x = 0; x < side; ++x) columns[x] = placeOf(x, center.x, image.cols);
  for (int y = 0; y < side; ++y) {
    const Place row = placeOf(y, center.y, image.rows);
    const auto* upper = image.ptr<uchar>(row.before);
    const auto* lower = image.ptr<uchar>(row.after);
    uchar* out = &copy_[static_cast<std::size_t>(y * stepOf(side))];
    for (int x = 0; x < side; ++x) {
      const auto [left, right, part] = columns[x];
      const int value = between(between(upper[left], upper[right], part),
                                between(lower[left], lower[right], part),
                                row.part);
      out[x] = static_cast<uchar>((value + (1 << (2 * kBits - 1))) >> (2 * kBits));
    }
  }
  return {copy_.data(), stepOf(side), 0, 0};
}

bool TrackingWindow::take(const cv::Mat& image, const cv::Point2f& center, float scale) {
  if (!contains(image, center)) return false;
  if (std::abs(1.0F / scale - 1.0F) * static_cast<float>(radius_) < kMinStretch_px) scale = 1.0F;
  const Patch patch = patchAround(image, center, radius_ + 1, scale);
  return invertNormalMatrix(kernels_->takeWindow(patch, window_));
}

/// Sets what a change of brightness and contrast does to the least squares for a shift.
bool TrackingWindow::describeContrast(const WindowSums& sums) {
  const double pixels = side_ * side_;
  const cv::Point2d gradients(static_cast<double>(sums.x), static_cast<double>(sums.y));
  const cv::Point2d products(static_cast<double>(sums.contrast_x),
                             static_cast<double>(sums.contrast_y));
  mean_gradient_ = kOfGradient / pixels * gradients;
  mean_contrast_ = kOfContrast / pixels * static_cast<double>(sums.contrast);
  contrast_square_ = kOfContrast * kOfContrast * static_cast<double>(sums.contrast_square) -
                     pixels * mean_contrast_ * mean_contrast_;
  if (!(contrast_square_ > kMinVariance)) return false;
  gradient_by_contrast_ =
      1.0 / contrast_square_ *
      (kOfContrast * kOfGradient * products - pixels * mean_contrast_ * mean_gradient_);
  return true;
}

/// Inverts the normal matrix of the least squares for a shift and for a change of brightness and
/// contrast. The latter two are eliminated: what they explain of the gradients is subtracted.
bool TrackingWindow::invertNormalMatrix(const WindowSums& sums) {
  if (!describeContrast(sums)) return false;
  const double pixels = side_ * side_;
  const cv::Point2d& mean = mean_gradient_;
  const cv::Point2d& slope = gradient_by_contrast_;
  const auto left = [&](std::int64_t products, double by_brightness, double by_contrast) {
    return static_cast<float>(kOfGradient * kOfGradient * static_cast<double>(products) -
                              pixels * by_brightness - contrast_square_ * by_contrast);
  };
  const float xx = left(sums.xx, mean.x * mean.x, slope.x * slope.x);
  const float xy = left(sums.xy, mean.x * mean.y, slope.x * slope.y);
  const float yy = left(sums.yy, mean.y * mean.y, slope.y * slope.y);
  const float difference = xx - yy;
  const float smaller = 0.5F * (xx + yy - std::sqrt(difference * difference + 4.0F * xy * xy));
  if (!(smaller >= kMinTexture * static_cast<float>(side_ * side_))) return false;
  const float scale = 1.0F / (xx * yy - xy * xy);
  inverse_xx_ = scale * yy;
  inverse_xy_ = -scale * xy;
  inverse_yy_ = scale * xx;
  return true;
}

/// The shift towards the position that matches the window. The contrast there, relative to that of
/// the window, multiplies the gradients.
cv::Point2f TrackingWindow::stepFrom(const Patch& patch) {
  const MismatchSums sums = kernels_->compareWindow(patch, window_);
  const double brighter = kOfDifference * static_cast<double>(sums.one);
  const double with_contrast =
      kOfDifference * kOfContrast * static_cast<double>(sums.contrast) - brighter * mean_contrast_;
  const cv::Point2d products(static_cast<double>(sums.x), static_cast<double>(sums.y));
  cv::Point2d mismatch = kOfDifference * kOfGradient * products - brighter * mean_gradient_ -
                         with_contrast * gradient_by_contrast_;
  const double square = kOfDifference * kOfDifference * static_cast<double>(sums.square) -
                        brighter * brighter / (side_ * side_);
  const double variance = contrast_square_ + 2.0 * with_contrast + square;
  const double ratio = std::sqrt(contrast_square_ / std::max(variance, kMinVariance));
  correlation_ = ratio * (1.0 + with_contrast / contrast_square_);
  mismatch *= ratio;
  const cv::Point2f b(static_cast<float>(mismatch.x), static_cast<float>(mismatch.y));
  return {-inverse_xx_ * b.x - inverse_xy_ * b.y, -inverse_xy_ * b.x - inverse_yy_ * b.y};
}

bool TrackingWindow::find(const cv::Mat& image, const Stop& stop, cv::Point2f& center) {
  const auto min_px2 = static_cast<float>(stop.min_step_px * stop.min_step_px);
  cv::Point2f found = center;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (!contains(image, found)) return false;
    const cv::Point2f step = stepFrom(patchAround(image, found, radius_, 1.0F));
    found += step;
    if (cv::norm(found - center) > stop.max_shift_px) return false;
    if (step.dot(step) <= min_px2) break;
  }
  if (!contains(image, found)) return false;
  center = found;
  return true;
}

FeatureTracker::FeatureTracker(const Config& config)
    : config_(config), window_(config.window_radius_px), small_window_(config.window_radius_px) {}

void FeatureTracker::setWindowScale(double scale) {
  window_scale_ = scale;
  const int radius_px = std::min(cvCeil(scale * config_.window_radius_px), kMaxRadius_px);
  if (radius_px != window_.radius()) window_ = small_window_ = TrackingWindow(radius_px);
}

bool FeatureTracker::track(const ImagePyramid& from,
                           const ImagePyramid& to,
                           const cv::Point2f& start,
                           float scale,
                           cv::Point2f& end) {
  if (!contains(to[0], end)) return false;
  cv::Point2f found = end;
  TrackingWindow::Stop near = kStop;
  near.max_shift_px = kNear * window_scale_ * config_.window_radius_px;
  if (!window_.take(from[0], start, scale)) return false;
  if (!window_.find(to[0], near, found)) {
    for (std::size_t level = std::min(from.size(), to.size()) - 1; level > 0; --level) {
      const float at_level = scaleOf(level);
      cv::Point2f scaled = at_level * found;
      // Features that are not found in a small image are left to the larger ones.
      if (small_window_.take(from[level], at_level * start, scale) &&
          small_window_.find(to[level], kRoughly, scaled)) {
        found = scaled / at_level;
      }
    }
    if (!window_.find(to[0], kStop, found)) return false;
  }
  if (window_.correlation() < kMinCorrelation) return false;
  end = found;
  return true;
}

bool FeatureTracker::locate(const cv::Mat& from,
                            const cv::Mat& to,
                            const cv::Point2f& start,
                            cv::Point2f& point) {
  return window_.take(from, start, 1.0F) && window_.find(to, kStop, point);
}

}  // namespace rotrocc
