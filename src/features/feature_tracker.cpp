#include "features/feature_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Columns that are read for so many columns of a window: whole registers.
constexpr int columnsOf(int count) {
  return (count + kMaxShorts - 1) / kMaxShorts * kMaxShorts;
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

constexpr double kAnywhere_px = std::numeric_limits<double>::infinity();

/// When iterations of a level stop. Gauss-Newton converges within a few; steps below a fraction of
/// the flow's noise, about 0.1 px, gain nothing.
constexpr TrackingWindow::Stop kStop = {6, 0.04, kAnywhere_px};

/// The small images only provide a start for the large one.
constexpr TrackingWindow::Stop kRoughly = {6, 0.12, kAnywhere_px};

/// Scale of pixel coordinates in a level of the pyramid.
float scaleOf(std::size_t level) {
  return 1.0F / static_cast<float>(1 << level);
}

}  // namespace

TrackingWindow::TrackingWindow(int radius_px)
    : kernels_(&chooseKernels()),
      radius_(radius_px),
      side_(2 * radius_px + 1),
      resampled_(static_cast<std::size_t>((side_ + 3) * (columnsOf(side_ + 2) + 1))) {
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
  const int side = 2 * radius + 2;
  const int step = columnsOf(side - 1) + 1;
  // Registers read on in the next row, and not beyond it.
  const cv::Rect inside(radius, radius, image.cols - side + 1, image.rows - side);
  if (std::abs(1.0F / scale - 1.0F) * static_cast<float>(radius_) < kMinStretch_px) scale = 1.0F;
  const bool is_inside = inside.contains({cvFloor(center.x), cvFloor(center.y)});
  if (scale == 1.0F && is_inside && step <= image.cols) return patchAt(image, center, radius);
  const auto placeOf = [&](int i, float middle, int count) {
    const float place = middle + static_cast<float>(i - radius) / scale;
    return std::clamp(place, 0.0F, static_cast<float>(count - 1));
  };
  const auto between = [](float a, float b, float at) { return a + at * (b - a); };
  for (int x = 0; x < side; ++x) {
    const float column = placeOf(x, center.x, image.cols);
    const int left = static_cast<int>(column);
    const int right = std::min(left + 1, image.cols - 1);
    const float aside = column - static_cast<float>(left);
    for (int y = 0; y < side; ++y) {
      const float row = placeOf(y, center.y, image.rows);
      const int top = static_cast<int>(row);
      const auto* upper = image.ptr<uchar>(top);
      const auto* lower = image.ptr<uchar>(std::min(top + 1, image.rows - 1));
      const float value = between(between(upper[left], upper[right], aside),
                                  between(lower[left], lower[right], aside),
                                  row - static_cast<float>(top));
      resampled_[static_cast<std::size_t>(y * step + x)] = static_cast<uchar>(value + 0.5F);
    }
  }
  return {resampled_.data(), step, 0, 0};
}

bool TrackingWindow::take(const cv::Mat& image, const cv::Point2f& center, float scale) {
  if (!contains(image, center)) return false;
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
  for (int i = 0; i < stop.max_iterations; ++i) {
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
    : config_(config), window_(config.window_radius_px) {}

void FeatureTracker::setDetail(double detail_px) {
  detail_px_ = detail_px;
  const int radius_px = std::min(cvCeil(detail_px * config_.window_radius_px), kMaxRadius_px);
  if (radius_px != window_.radius()) window_ = TrackingWindow(radius_px);
}

bool FeatureTracker::track(const ImagePyramid& from,
                           const ImagePyramid& to,
                           const cv::Point2f& start,
                           float scale,
                           cv::Point2f& end) {
  if (!contains(to[0], end)) return false;
  cv::Point2f found = end;
  TrackingWindow::Stop near = kStop;
  near.max_shift_px = kNear * detail_px_ * config_.window_radius_px;
  if (!window_.take(from[0], start, scale) || !window_.find(to[0], near, found)) {
    for (std::size_t level = std::min(from.size(), to.size()) - 1; level > 0; --level) {
      const float at_level = scaleOf(level);
      cv::Point2f scaled = at_level * found;
      // Features that are not found in a small image are left to the larger ones.
      if (window_.take(from[level], at_level * start, scale) &&
          window_.find(to[level], kRoughly, scaled)) {
        found = scaled / at_level;
      }
    }
    if (!window_.take(from[0], start, scale) || !window_.find(to[0], kStop, found)) return false;
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
