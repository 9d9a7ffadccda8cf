#include "features/tracking_window.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace rotrocc {
namespace {

/// Minimum of the smaller eigenvalue of the normal matrix, per pixel: (grey levels / px)^2.
constexpr float kLeastTexture = 0.1F;

/// If a step reverses the previous one to within this distance [px], the iteration oscillates and
/// is stopped.
constexpr float kSameStep_px = 0.01F;

/// Grey levels, and grey levels times gradients, in the units of the kernels.
constexpr double kOfValue = 1.0 / (1 << Window::kValueBits);
constexpr double kOfProduct = kOfValue / (1 << Window::kGradientBits);

std::int16_t fraction(float distance) {
  return static_cast<std::int16_t>(32768.0F * distance);
}

}  // namespace

TrackingWindow::TrackingWindow(int radius_px, bool ignores_brightness)
    : kernels_(&chooseKernels()),
      radius_(radius_px),
      side_(2 * radius_px + 1),
      ignores_brightness_(ignores_brightness),
      stride_(wholeRegisters(side_)),
      sample_stride_(wholeRegisters(side_ + 2) + kernels_->shorts),
      samples_(static_cast<std::size_t>((side_ + 2) * sample_stride_)),
      values_(static_cast<std::size_t>(side_ * stride_)),
      gradient_x_(values_.size()),
      gradient_y_(values_.size()),
      mask_(static_cast<std::size_t>(stride_)),
      spread_(mask_.size()),
      border_(static_cast<std::size_t>((side_ + 3) * (sample_stride_ + 1))) {
  std::fill_n(mask_.begin(), side_, static_cast<std::int16_t>(-1));
}

int TrackingWindow::wholeRegisters(int count) const {
  return (count + kernels_->shorts - 1) / kernels_->shorts * kernels_->shorts;
}

Window TrackingWindow::window() {
  return {side_,
          stride_,
          values_.data(),
          gradient_x_.data(),
          gradient_y_.data(),
          mask_.data(),
          spread_.data(),
          samples_.data(),
          sample_stride_};
}

/// The patch for a window of the given radius and number of columns, a multiple of the lanes.
/// Pixels outside the image repeat its border.
Patch TrackingWindow::patchAround(const cv::Mat& image,
                                  const cv::Point2f& center,
                                  int radius,
                                  int columns) {
  const int x = cvFloor(center.x);
  const int y = cvFloor(center.y);
  const std::int16_t fx = fraction(center.x - static_cast<float>(x));
  const std::int16_t fy = fraction(center.y - static_cast<float>(y));
  const cv::Rect area(x - radius, y - radius, columns + 1, 2 * radius + 2);
  if (area.x >= 0 && area.y >= 0 && area.x + area.width <= image.cols &&
      area.y + area.height <= image.rows) {
    return {image.ptr<uchar>(area.y) + area.x, static_cast<std::ptrdiff_t>(image.step), fx, fy};
  }
  copyWithEdge(image, area);
  return {border_.data(), area.width, fx, fy};
}

/// Copies `area` into border_. It must contain at least one pixel of the image.
void TrackingWindow::copyWithEdge(const cv::Mat& image, const cv::Rect& area) {
  const int left = std::clamp(-area.x, 0, area.width);
  const int right = std::clamp(image.cols - area.x, 0, area.width);
  uchar* out = border_.data();
  for (int y = area.y; y < area.y + area.height; ++y, out += area.width) {
    const auto* row = image.ptr<uchar>(std::clamp(y, 0, image.rows - 1));
    std::memcpy(out + left, row + area.x + left, static_cast<std::size_t>(right - left));
    for (int x = 0; x < left; ++x) out[x] = row[0];
    for (int x = right; x < area.width; ++x) out[x] = row[image.cols - 1];
  }
}

bool TrackingWindow::take(const cv::Mat& image,
                          const cv::Point2f& center,
                          float scale,
                          double gain) {
  const cv::Rect2f inside(
      0.0F, 0.0F, static_cast<float>(image.cols), static_cast<float>(image.rows));
  if (!inside.contains(center)) return false;
  spread(scale);
  const Patch patch = patchAround(image, center, radius_ + 1, wholeRegisters(side_ + 2));
  if (!invertNormalMatrix(kernels_->takeWindow(patch, window()))) return false;
  changeContrast(gain);
  return true;
}

/// Sets the sampling offsets from the pixel grid. They must be less than one pixel.
void TrackingWindow::spread(float scale) {
  const float most = 0.9F / static_cast<float>(std::max(radius_, 1));
  const float per_px = std::clamp(1.0F / scale - 1.0F, -most, most);
  for (int i = 0; i < side_; ++i) {
    spread_[static_cast<std::size_t>(i)] = fraction(per_px * static_cast<float>(i - radius_));
  }
}

/// Inverts the normal matrix of the least squares for a shift and a brightness difference. The
/// latter is eliminated by subtracting the mean gradient.
bool TrackingWindow::invertNormalMatrix(const GradientSums& sums) {
  const double unit = 1.0 / (1 << Window::kGradientBits);
  const double pixels = side_ * side_;
  const double per_pixel = ignores_brightness_ ? unit / pixels : 0.0;
  const double mean_x = per_pixel * static_cast<double>(sums.x);
  const double mean_y = per_pixel * static_cast<double>(sums.y);
  const auto about = [&](std::int64_t products, double mean_a, double mean_b) {
    return static_cast<float>(unit * unit * static_cast<double>(products) -
                              pixels * mean_a * mean_b);
  };
  const float xx = about(sums.xx, mean_x, mean_x);
  const float xy = about(sums.xy, mean_x, mean_y);
  const float yy = about(sums.yy, mean_y, mean_y);
  const float difference = xx - yy;
  const float smaller = 0.5F * (xx + yy - std::sqrt(difference * difference + 4.0F * xy * xy));
  if (!(smaller >= kLeastTexture * static_cast<float>(side_ * side_))) return false;
  const float scale = 1.0F / (xx * yy - xy * xy);
  inverse_xx_ = scale * yy;
  inverse_xy_ = -scale * xy;
  inverse_yy_ = scale * xx;
  mean_gradient_ = {mean_x, mean_y};
  return true;
}

/// Gradients change with the contrast, so steps do, too.
void TrackingWindow::changeContrast(double gain) {
  contrast_ = {};
  if (gain == 1.0) return;
  const ValueSums sums = kernels_->sumValues(window());
  const double value = kOfValue * static_cast<double>(sums.one);
  const cv::Point2d products(static_cast<double>(sums.x), static_cast<double>(sums.y));
  contrast_ = (gain - 1.0) * (kOfProduct * products - value * mean_gradient_);
  const auto inverse = static_cast<float>(1.0 / gain);
  inverse_xx_ *= inverse;
  inverse_xy_ *= inverse;
  inverse_yy_ *= inverse;
}

/// Sum of (difference to the window, without the differences of brightness and contrast) times its
/// gradients.
cv::Point2f TrackingWindow::mismatch(const Patch& patch, const Window& window) const {
  const MismatchSums sums = kernels_->compareWindow(patch, window);
  const double brighter = kOfValue * static_cast<double>(sums.one);
  return {static_cast<float>(kOfProduct * static_cast<double>(sums.x) -
                             brighter * mean_gradient_.x - contrast_.x),
          static_cast<float>(kOfProduct * static_cast<double>(sums.y) -
                             brighter * mean_gradient_.y - contrast_.y)};
}

bool TrackingWindow::find(const cv::Mat& image, const Stop& stop, cv::Point2f& center) {
  const cv::Rect2f inside(
      0.0F, 0.0F, static_cast<float>(image.cols), static_cast<float>(image.rows));
  const auto least_px2 = static_cast<float>(stop.min_step_px * stop.min_step_px);
  const Window window = this->window();
  cv::Point2f found = center;
  cv::Point2f last_step;
  for (int i = 0; i < stop.max_iterations; ++i) {
    if (!inside.contains(found)) return false;
    const cv::Point2f b = mismatch(patchAround(image, found, radius_, stride_), window);
    const cv::Point2f step(-inverse_xx_ * b.x - inverse_xy_ * b.y,
                           -inverse_xy_ * b.x - inverse_yy_ * b.y);
    found += step;
    if (step.dot(step) <= least_px2) break;
    const cv::Point2f both = step + last_step;
    if (i > 0 && std::abs(both.x) < kSameStep_px && std::abs(both.y) < kSameStep_px) {
      found -= 0.5F * step;
      break;
    }
    last_step = step;
  }
  if (!inside.contains(found)) return false;
  center = found;
  return true;
}

}  // namespace rotrocc
