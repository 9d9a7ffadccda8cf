#include "features/corner_response.h"

#include <algorithm>

#include "kernels/kernels.h"

namespace rotrocc {

void CornerResponse::compute(
    const cv::Mat& image, int first_row, int last_row, int margin, cv::Mat& response) {
  stride_ = static_cast<std::size_t>(image.cols + kSide + 2 * kMaxShorts);
  for (auto* row : {&smooth_, &steps_}) row->resize(stride_);
  for (auto* sums : {&xx_, &xy_, &yy_}) sums->assign(stride_, 0);
  gradients_.assign(static_cast<std::size_t>(2 * kSide) * stride_, 0);

  response.create(last_row - first_row, image.cols + 2 * margin + kMaxShorts, CV_32F);
  const int first = std::max(first_row, (kRadius_px + kRowStep - 1) / kRowStep);
  const int last = std::min(last_row, (image.rows - kRadius_px + kRowStep - 1) / kRowStep);
  const int count = image.cols - 2 * kRadius_px;
  if (first >= last || count <= 0) {
    response.setTo(0.0F);
    return;
  }
  const Kernels& kernels = chooseKernels();
  int next = kRowStep * first - kRadius_px;  // row of the image whose gradients are added next
  for (int r = first_row; r < last_row; ++r) {
    auto* out = response.ptr<float>(r - first_row);
    auto* end = out + response.cols;
    if (r < first || r >= last) {
      std::fill(out, end, 0.0F);
      continue;
    }
    for (; next <= kRowStep * r + kRadius_px; ++next) addGradients(image, next);
    auto* inner = std::fill_n(out, margin + kRadius_px, 0.0F);
    kernels.respondRow({xx_.data(), xy_.data(), yy_.data()}, count, inner);
    std::fill(inner + count, end, 0.0F);
  }
}

/// Adds the Sobel gradients of row y and removes those of the row kSide rows before. smooth_ and
/// steps_ start one pixel to the left of the image; pixels outside repeat the border.
void CornerResponse::addGradients(const cv::Mat& image, int y) {
  const Kernels& kernels = chooseKernels();
  std::int16_t* smooth = smooth_.data() + 1;
  std::int16_t* steps = steps_.data() + 1;
  kernels.differentiateRow(image.ptr<uchar>(std::max(y - 1, 0)),
                           image.ptr<uchar>(y),
                           image.ptr<uchar>(std::min(y + 1, image.rows - 1)),
                           image.cols,
                           smooth,
                           steps);
  for (std::int16_t* values : {smooth, steps}) {
    values[-1] = values[0];
    values[image.cols] = values[image.cols - 1];
  }
  std::int16_t* gradients = gradients_.data() + static_cast<std::size_t>(2 * (y % kSide)) * stride_;
  kernels.replaceGradients(smooth_.data(),
                           steps_.data(),
                           image.cols,
                           gradients,
                           gradients + stride_,
                           {xx_.data(), xy_.data(), yy_.data()});
}

}  // namespace rotrocc
