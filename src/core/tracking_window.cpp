#include "tracking_window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/core/hal/intrin.hpp>

namespace rotrocc {
namespace {

using Lanes = cv::v_int16x8;
constexpr int kLanes = 8;

/// Units of a grey level and of a gradient.
constexpr int kValueBits = 6;
constexpr int kGradientBits = 5;

/// Rows whose products 32 bits hold: 255 grey levels times the steepest gradient, two a lane.
constexpr int kBlockRows = 16;

/// Least smaller eigenvalue of the normal matrix, per pixel: (grey levels / px)^2.
constexpr float kLeastTexture = 0.1F;

/// A step that undoes the one before but for this [px] would go on forever.
constexpr float kSameStep_px = 0.01F;

int wholeRegisters(int count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

/// Eight pixels, each between one and its right neighbour by fx / 2^15, in value units.
Lanes betweenColumns(const uchar* pixels, const Lanes& fx) {
  const Lanes left = cv::v_reinterpret_as_s16(cv::v_load_expand(pixels));
  const Lanes right = cv::v_reinterpret_as_s16(cv::v_load_expand(pixels + 1));
  return cv::v_shl<kValueBits>(left) + cv::v_mul_hi(cv::v_shl<kValueBits + 1>(right - left), fx);
}

Lanes betweenRows(const Lanes& upper, const Lanes& lower, const Lanes& fy) {
  return upper + cv::v_mul_hi(cv::v_shl<1>(lower - upper), fy);
}

/// The gradient of Scharr, (3 10 3) / 16 across, from the differences of three rows or columns of
/// pixels that are two apart.
Lanes scharr(const Lanes& before, const Lanes& here, const Lanes& after) {
  const Lanes middle = cv::v_mul_hi(cv::v_shl<1>(here), cv::v_setall_s16(20480));  // 10 / 32
  const Lanes sides = cv::v_mul_hi(before + after, cv::v_setall_s16(12288));       // 3 / 16
  // A unit more makes up for what both products lose; the other two round.
  constexpr int kShift = kValueBits + 1 - kGradientBits;
  return cv::v_shr<kShift>(middle + sides + cv::v_setall_s16(1 + (1 << (kShift - 1))));
}

Lanes difference(const short* a, const short* b) {
  return cv::v_load(a) - cv::v_load(b);
}

std::int64_t sum(const cv::v_int32x4& lanes) {
  std::int32_t parts[4];
  cv::v_store(parts, lanes);
  return std::int64_t{parts[0]} + parts[1] + parts[2] + parts[3];
}

short fraction(float distance) {
  return static_cast<short>(32768.0F * distance);
}

}  // namespace

/// Pixels of an image and where between them the window begins.
struct TrackingWindow::Patch {
  const uchar* pixels;
  std::ptrdiff_t step;
  Lanes fx, fy;
};

TrackingWindow::TrackingWindow(int radius_px)
    : radius_(radius_px),
      side_(2 * radius_px + 1),
      stride_(wholeRegisters(side_)),
      sample_stride_(wholeRegisters(side_ + 2) + kLanes),
      samples_(static_cast<std::size_t>((side_ + 2) * sample_stride_)),
      values_(static_cast<std::size_t>(side_ * stride_)),
      gradient_x_(values_.size()),
      gradient_y_(values_.size()),
      mask_(static_cast<std::size_t>(stride_)),
      border_(static_cast<std::size_t>((side_ + 3) * (sample_stride_ + 1))) {
  std::fill_n(mask_.begin(), side_, static_cast<short>(-1));
}

/// The patch whose window has `radius` and `columns`, a multiple of the lanes. Beyond the image its
/// edge goes on.
TrackingWindow::Patch TrackingWindow::patchAround(const cv::Mat& image,
                                                  const cv::Point2f& center,
                                                  int radius,
                                                  int columns) {
  const int x = cvFloor(center.x);
  const int y = cvFloor(center.y);
  Patch patch;
  patch.fx = cv::v_setall_s16(fraction(center.x - static_cast<float>(x)));
  patch.fy = cv::v_setall_s16(fraction(center.y - static_cast<float>(y)));
  const int left = x - radius;
  const int top = y - radius;
  const int width = columns + 1;
  const int height = 2 * radius + 2;
  if (left >= 0 && top >= 0 && left + width <= image.cols && top + height <= image.rows) {
    patch.pixels = image.ptr<uchar>(top) + left;
    patch.step = static_cast<std::ptrdiff_t>(image.step);
    return patch;
  }
  for (int v = 0; v < height; ++v) {
    const auto* row = image.ptr<uchar>(std::clamp(top + v, 0, image.rows - 1));
    uchar* out = border_.data() + v * width;
    for (int u = 0; u < width; ++u) out[u] = row[std::clamp(left + u, 0, image.cols - 1)];
  }
  patch.pixels = border_.data();
  patch.step = width;
  return patch;
}

bool TrackingWindow::take(const cv::Mat& image, const cv::Point2f& center) {
  const cv::Rect2f inside(
      0.0F, 0.0F, static_cast<float>(image.cols), static_cast<float>(image.rows));
  if (!inside.contains(center)) return false;
  const int columns = wholeRegisters(side_ + 2);
  const Patch patch = patchAround(image, center, radius_ + 1, columns);
  for (int x = 0; x < columns; x += kLanes) {
    const uchar* pixels = patch.pixels + x;
    short* out = samples_.data() + x;
    Lanes upper = betweenColumns(pixels, patch.fx);
    for (int y = 0; y < side_ + 2; ++y) {
      pixels += patch.step;
      const Lanes lower = betweenColumns(pixels, patch.fx);
      cv::v_store(out, betweenRows(upper, lower, patch.fy));
      upper = lower;
      out += sample_stride_;
    }
  }

  std::int64_t xx = 0;
  std::int64_t xy = 0;
  std::int64_t yy = 0;
  for (int x = 0; x < stride_; x += kLanes) {
    const Lanes mask = cv::v_load(mask_.data() + x);
    cv::v_int32x4 sum_xx = cv::v_setzero_s32();
    cv::v_int32x4 sum_xy = cv::v_setzero_s32();
    cv::v_int32x4 sum_yy = cv::v_setzero_s32();
    for (int y = 0; y < side_; ++y) {
      const short* above = samples_.data() + y * sample_stride_ + x;
      const short* here = above + sample_stride_;
      const short* below = here + sample_stride_;
      const Lanes gx = scharr(difference(above + 2, above),
                              difference(here + 2, here),
                              difference(below + 2, below)) &
                       mask;
      const Lanes gy = scharr(difference(below, above),
                              difference(below + 1, above + 1),
                              difference(below + 2, above + 2)) &
                       mask;
      const std::ptrdiff_t at = y * stride_ + x;
      cv::v_store(values_.data() + at, cv::v_load(here + 1));
      cv::v_store(gradient_x_.data() + at, gx);
      cv::v_store(gradient_y_.data() + at, gy);
      sum_xx = sum_xx + cv::v_dotprod(gx, gx);
      sum_xy = sum_xy + cv::v_dotprod(gx, gy);
      sum_yy = sum_yy + cv::v_dotprod(gy, gy);
    }
    xx += sum(sum_xx);
    xy += sum(sum_xy);
    yy += sum(sum_yy);
  }
  constexpr float kUnit = 1.0F / (1 << (2 * kGradientBits));
  return invertNormalMatrix(kUnit * static_cast<float>(xx),
                            kUnit * static_cast<float>(xy),
                            kUnit * static_cast<float>(yy));
}

bool TrackingWindow::invertNormalMatrix(float xx, float xy, float yy) {
  const float difference = xx - yy;
  const float smaller = 0.5F * (xx + yy - std::sqrt(difference * difference + 4.0F * xy * xy));
  if (!(smaller >= kLeastTexture * static_cast<float>(side_ * side_))) return false;
  const float scale = 1.0F / (xx * yy - xy * xy);
  inverse_xx_ = scale * yy;
  inverse_xy_ = -scale * xy;
  inverse_yy_ = scale * xx;
  return true;
}

bool TrackingWindow::find(const cv::Mat& image, const Stop& stop, cv::Point2f& center) {
  const cv::Rect2f inside(
      0.0F, 0.0F, static_cast<float>(image.cols), static_cast<float>(image.rows));
  const auto least_px2 = static_cast<float>(stop.min_step_px * stop.min_step_px);
  cv::Point2f found = center;
  cv::Point2f last_step;
  for (int i = 0; i < stop.max_iterations; ++i) {
    if (!inside.contains(found)) return false;
    const cv::Point2f b = mismatch(patchAround(image, found, radius_, stride_));
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

/// Sum of the differences to the window times its gradients.
cv::Point2f TrackingWindow::mismatch(const Patch& patch) const {
  std::int64_t bx = 0;
  std::int64_t by = 0;
  for (int first = 0; first < side_; first += kBlockRows) {
    const int last = std::min(first + kBlockRows, side_);
    for (int x = 0; x < stride_; x += kLanes) {
      const uchar* pixels = patch.pixels + first * patch.step + x;
      cv::v_int32x4 sum_x = cv::v_setzero_s32();
      cv::v_int32x4 sum_y = cv::v_setzero_s32();
      Lanes upper = betweenColumns(pixels, patch.fx);
      for (int at = first * stride_ + x; at < last * stride_; at += stride_) {
        pixels += patch.step;
        const Lanes lower = betweenColumns(pixels, patch.fx);
        const Lanes excess = betweenRows(upper, lower, patch.fy) - cv::v_load(values_.data() + at);
        sum_x = sum_x + cv::v_dotprod(excess, cv::v_load(gradient_x_.data() + at));
        sum_y = sum_y + cv::v_dotprod(excess, cv::v_load(gradient_y_.data() + at));
        upper = lower;
      }
      bx += sum(sum_x);
      by += sum(sum_y);
    }
  }
  constexpr float kUnit = 1.0F / (1 << (kValueBits + kGradientBits));
  return {kUnit * static_cast<float>(bx), kUnit * static_cast<float>(by)};
}

}  // namespace rotrocc
