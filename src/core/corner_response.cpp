#include "rotrocc/corner_response.h"

#include <algorithm>

#include <opencv2/core/hal/intrin.hpp>

namespace rotrocc {
namespace {

constexpr int kLanes = 8;

using Shorts = cv::v_int16x8;
using Ints = cv::v_int32x4;
using Floats = cv::v_float32x4;

Shorts loadPixels(const uchar* pixels) {
  return cv::v_reinterpret_as_s16(cv::v_load_expand(pixels));
}

/// Adds the products of the pairs (a, b) that enter the sums and takes away those that leave them.
/// Where `leaving_b` is negated, a dot product of both does it at once.
void replaceProducts(const Shorts& a,
                     const Shorts& leaving_a,
                     const Shorts& b,
                     const Shorts& minus_leaving_b,
                     std::int32_t* sums) {
  Shorts a_low, a_high, b_low, b_high;
  cv::v_zip(a, leaving_a, a_low, a_high);
  cv::v_zip(b, minus_leaving_b, b_low, b_high);
  cv::v_store(sums, cv::v_load(sums) + cv::v_dotprod(a_low, b_low));
  cv::v_store(sums + 4, cv::v_load(sums + 4) + cv::v_dotprod(a_high, b_high));
}

/// Smaller eigenvalues of [xx xy; xy yy].
Floats smallerEigenvalues(const Floats& xx, const Floats& xy, const Floats& yy) {
  const Floats difference = xx - yy;
  const Floats root = cv::v_sqrt(difference * difference + cv::v_setall_f32(4.0F) * xy * xy);
  return cv::v_setall_f32(0.5F) * (xx + yy - root);
}

}  // namespace

CornerResponse::CornerResponse(int block_radius_px)
    : radius_(block_radius_px), side_(2 * block_radius_px + 1) {}

void CornerResponse::compute(
    const cv::Mat& image, int first_row, int last_row, int margin, cv::Mat& response) {
  stride_ = static_cast<std::size_t>(image.cols + side_ + 2 * kLanes);
  for (auto* row : {&smooth_, &steps_}) row->resize(stride_);
  for (auto* sums : {&xx_, &xy_, &yy_}) sums->assign(stride_, 0);
  gradients_.assign(static_cast<std::size_t>(2 * side_) * stride_, 0);

  response.create(last_row - first_row, image.cols + 2 * margin + kLanes, CV_32F);
  const int first = std::max(first_row, radius_);
  const int last = std::min(last_row, image.rows - radius_);
  const int count = image.cols - 2 * radius_;
  if (first >= last || count <= 0) {
    response.setTo(0.0F);
    return;
  }
  for (int y = first - radius_; y < first + radius_; ++y) addGradients(image, y);
  for (int y = first_row; y < last_row; ++y) {
    auto* row = response.ptr<float>(y - first_row);
    auto* end = row + response.cols;
    if (y < first || y >= last) {
      std::fill(row, end, 0.0F);
      continue;
    }
    addGradients(image, y + radius_);
    auto* inner = std::fill_n(row, margin + radius_, 0.0F);
    respond(count, inner);
    std::fill(inner + count, end, 0.0F);
  }
}

/// Smooths row y by (1 2 1) downwards into smooth_, and differentiates it into steps_. Both begin
/// one pixel left of the image, whose edge goes on.
void CornerResponse::differentiate(const cv::Mat& image, int y) {
  const auto* above = image.ptr<uchar>(std::max(y - 1, 0));
  const auto* here = image.ptr<uchar>(y);
  const auto* below = image.ptr<uchar>(std::min(y + 1, image.rows - 1));
  short* smooth = smooth_.data() + 1;
  short* steps = steps_.data() + 1;
  int x = 0;
  for (; x <= image.cols - kLanes; x += kLanes) {
    const Shorts a = loadPixels(above + x);
    const Shorts h = loadPixels(here + x);
    const Shorts b = loadPixels(below + x);
    cv::v_store(smooth + x, a + h + h + b);
    cv::v_store(steps + x, b - a);
  }
  for (; x < image.cols; ++x) {
    smooth[x] = static_cast<short>(above[x] + 2 * here[x] + below[x]);
    steps[x] = static_cast<short>(below[x] - above[x]);
  }
  for (short* row : {smooth, steps}) {
    row[-1] = row[0];
    row[image.cols] = row[image.cols - 1];
  }
}

/// Sobel's gradients of row y take the place of those `side_` rows before.
void CornerResponse::addGradients(const cv::Mat& image, int y) {
  differentiate(image, y);
  short* gradients = gradients_.data() + static_cast<std::size_t>(2 * (y % side_)) * stride_;
  const Shorts zero = cv::v_setzero_s16();
  for (int x = 0; x < image.cols; x += kLanes) {
    const short* smooth = smooth_.data() + x;
    const short* steps = steps_.data() + x;
    const Shorts middle = cv::v_load(steps + 1);
    const Shorts gx = cv::v_load(smooth + 2) - cv::v_load(smooth);
    const Shorts gy = cv::v_load(steps) + middle + middle + cv::v_load(steps + 2);
    short* kept_x = gradients + x;
    short* kept_y = kept_x + stride_;
    const Shorts last_x = cv::v_load(kept_x);
    const Shorts last_y = cv::v_load(kept_y);
    const Shorts minus_last_x = zero - last_x;
    const Shorts minus_last_y = zero - last_y;
    replaceProducts(gx, last_x, gx, minus_last_x, xx_.data() + x);
    replaceProducts(gx, last_x, gy, minus_last_y, xy_.data() + x);
    replaceProducts(gy, last_y, gy, minus_last_y, yy_.data() + x);
    cv::v_store(kept_x, gx);
    cv::v_store(kept_y, gy);
  }
}

/// Sums the columns' sums along the row. Writes whole registers, so up to three values too many.
void CornerResponse::respond(int count, float* response) const {
  // A Sobel gradient is 8 grey levels for a slope of one level per pixel.
  const Floats scale = cv::v_setall_f32(1.0F / (64.0F * static_cast<float>(side_ * side_)));
  for (int x = 0; x < count; x += 4) {
    Ints xx = cv::v_load(xx_.data() + x);
    Ints xy = cv::v_load(xy_.data() + x);
    Ints yy = cv::v_load(yy_.data() + x);
    for (int k = x + 1; k < x + side_; ++k) {
      xx = xx + cv::v_load(xx_.data() + k);
      xy = xy + cv::v_load(xy_.data() + k);
      yy = yy + cv::v_load(yy_.data() + k);
    }
    cv::v_store(
        response + x,
        smallerEigenvalues(
            scale * cv::v_cvt_f32(xx), scale * cv::v_cvt_f32(xy), scale * cv::v_cvt_f32(yy)));
  }
}

}  // namespace rotrocc
