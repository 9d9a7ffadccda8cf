#include "check/sharpness.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

/// Energy of the gradients of an image after a Gaussian of a variance, without that of the noise,
/// relative to that of its large structures: falls with the variance.
class Sharpness {
 public:
  explicit Sharpness(const ImagePatches& patches)
      : noise2_(patches.noise_gray * patches.noise_gray), patches_(patches.areas) {
    patches.image.convertTo(image_, CV_32F);
  }

  double after(double variance_px2) const {
    const cv::Mat kernel = gaussian(variance_px2);
    double fine = 0.0;
    double coarse = 0.0;
    for (const cv::Rect& patch : patches_) {
      cv::Mat blurred, x, y, large, large_x, large_y;
      cv::sepFilter2D(image_(patch), blurred, CV_32F, kernel, kernel);
      cv::Sobel(blurred, x, CV_32F, 1, 0, 1, 0.5);
      cv::Sobel(blurred, y, CV_32F, 0, 1, 1, 0.5);
      cv::GaussianBlur(blurred, large, {}, kCoarse_px);
      cv::Sobel(large, large_x, CV_32F, 1, 0, 1, 0.5);
      cv::Sobel(large, large_y, CV_32F, 0, 1, 1, 0.5);
      fine += x.dot(x) + y.dot(y);
      coarse += large_x.dot(large_x) + large_y.dot(large_y);
    }
    const double pixels = static_cast<double>(patches_.size()) * patches_.front().area();
    fine -= 2.0 * pixels * noise2_ * noiseLeft(kernel);
    return fine / std::max(coarse, 1e-9);
  }

 private:
  static constexpr double kCoarse_px = 3.0;

  /// That of a lens, by its transfer function exp(-v w^2 / 2) up to the Nyquist frequency: a
  /// sampled Gaussian of less than half a pixel hardly blurs.
  static cv::Mat gaussian(double variance_px2) {
    constexpr int kFrequencies = 64;
    const int radius = std::max(8, cvCeil(4.0 * std::sqrt(variance_px2)));
    cv::Mat kernel = cv::Mat::zeros(2 * radius + 1, 1, CV_32F);
    for (int k = 0; k < kFrequencies; ++k) {
      const double frequency = M_PI * (k + 0.5) / kFrequencies;
      const double share = std::exp(-0.5 * variance_px2 * frequency * frequency) / kFrequencies;
      for (int i = -radius; i <= radius; ++i) {
        kernel.at<float>(radius + i) += static_cast<float>(share * std::cos(frequency * i));
      }
    }
    return kernel;
  }

  /// Variance of the central difference of white noise of variance 1 after the kernel.
  static double noiseLeft(const cv::Mat& kernel) {
    cv::Mat padded, slope;
    cv::copyMakeBorder(kernel, padded, 2, 2, 0, 0, cv::BORDER_CONSTANT);
    cv::Sobel(padded, slope, CV_32F, 0, 1, 1, 0.5);
    return slope.dot(slope) * kernel.dot(kernel);
  }

  cv::Mat image_;
  double noise2_;
  const std::vector<cv::Rect>& patches_;
};

/// Variance of the Gaussian that makes `sharp` as blurred as `blurred` is [px^2].
double blurBetween(const Sharpness& sharp, const Sharpness& blurred) {
  constexpr double kMost_px2 = 16.0;
  const double target = blurred.after(0.0);
  double low = 0.0;
  double high = kMost_px2;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (sharp.after(middle) > target ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double blurOfRight_px2(const ImagePatches& left_patches, const ImagePatches& right_patches) {
  const Sharpness left(left_patches);
  const Sharpness right(right_patches);
  const bool right_is_blurred = left.after(0.0) > right.after(0.0);
  return right_is_blurred ? blurBetween(left, right) : -blurBetween(right, left);
}

}  // namespace rotrocc
