// Compares the sums over windows with their definitions in 64 bits, where they are largest.

#include "kernels/window_kernels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "features/patch.h"
#include "kernels/kernels.h"

namespace rotrocc {
namespace {

using Int = std::int64_t;

/// The largest window, and the largest change of its size: by 0.9 px at its border.
constexpr int kRadius = 25;
constexpr int kSide = 2 * kRadius + 1;
constexpr float kMaxSpread_px = 0.9F;

/// Larger than a window by its margin, and by the registers that are read beyond.
constexpr int kWidth = kSide + 40;
constexpr int kHeight = kSide + 10;
constexpr int kFirst = 3;  // row and column of the image where the window begins

/// Black and white.
cv::Mat drawn(const std::function<bool(int x, int y)>& isWhite) {
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<uchar>(y, x) = isWhite(x - kFirst, y - kFirst) ? 255 : 0;
    }
  }
  return image;
}

/// Checks and stripes of several widths, and edges at many places.
std::vector<cv::Mat> hardImages() {
  std::vector<cv::Mat> images;
  for (const int px : {1, 2, 3, 8}) {
    images.push_back(drawn([&](int x, int y) { return ((x + 9) / px + (y + 9) / px) % 2 == 0; }));
    images.push_back(drawn([&](int x, int) { return (x + 9) / px % 2 == 0; }));
    images.push_back(drawn([&](int, int y) { return (y + 9) / px % 2 == 0; }));
  }
  for (const int at : {1, 2, 9, 24, 25, 26, 42, 48, 49, 50}) {
    images.push_back(drawn([&](int x, int) { return x < at; }));
    images.push_back(drawn([&](int x, int) { return x >= at; }));
    images.push_back(drawn([&](int, int y) { return y < at; }));
    images.push_back(drawn([&](int, int y) { return y >= at; }));
  }
  return images;
}

/// A window and its sums by definition. The rounding is that of the kernels.
class Reference {
 public:
  /// Of a row.
  std::vector<Int> values, gradient_x, gradient_y, contrast;
  GradientSums gradients = {0, 0, 0, 0, 0, 0};
  ContrastSums contrasts = {0, 0, 0, 0};

  Reference(const Patch& patch, const std::vector<std::int16_t>& spread) {
    const auto rowSlope = [&](int x, int y) {
      return sample(patch, x + 2, y) - sample(patch, x, y);
    };
    const auto columnSlope = [&](int x, int y) {
      return sample(patch, x, y + 2) - sample(patch, x, y);
    };
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const Int gx = scharr(rowSlope(x, y), rowSlope(x, y + 1), rowSlope(x, y + 2));
        const Int gy = scharr(columnSlope(x, y), columnSlope(x + 1, y), columnSlope(x + 2, y));
        const Int value =
            sample(patch, x + 1, y + 1) + (4 * gx * spread[x] >> 16) + (4 * gy * spread[y] >> 16);
        values.push_back(value);
        gradient_x.push_back(gx);
        gradient_y.push_back(gy);
        gradients.value += value;
        gradients.x += gx;
        gradients.y += gy;
        gradients.xx += gx * gx;
        gradients.xy += gx * gy;
        gradients.yy += gy * gy;
      }
    }
  }

  void takeContrast(Int mean) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      contrast.push_back((values[i] - mean) >> (Window::kValueBits - Window::kContrastBits));
      contrasts.one += contrast[i];
      contrasts.square += contrast[i] * contrast[i];
      contrasts.x += contrast[i] * gradient_x[i];
      contrasts.y += contrast[i] * gradient_y[i];
    }
  }

  MismatchSums compare(const Patch& patch) const {
    MismatchSums sums = {0, 0, 0, 0, 0};
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const auto i = static_cast<std::size_t>(y * kSide + x);
        const Int excess = (sample(patch, x, y) - values[i]) >>
                           (Window::kValueBits - MismatchSums::kDifferenceBits);
        sums.one += excess;
        sums.x += excess * gradient_x[i];
        sums.y += excess * gradient_y[i];
        sums.contrast += excess * contrast[i];
        sums.square += excess * excess;
      }
    }
    return sums;
  }

 private:
  static Int sample(const Patch& patch, int x, int y) {
    const auto inRow = [&](int row) {
      const std::uint8_t* pixels = patch.pixels + row * patch.step + x;
      return 64 * Int{pixels[0]} + (128 * (Int{pixels[1]} - pixels[0]) * patch.fx >> 16);
    };
    return inRow(y) + (2 * (inRow(y + 1) - inRow(y)) * patch.fy >> 16);
  }

  static Int scharr(Int before, Int here, Int after) {
    return ((2 * here * 20480 >> 16) + ((before + after) * 12288 >> 16) + 3) >> 2;
  }
};

/// The pixels within the side.
std::vector<Int> pixelsOf(const Window::Rows& rows) {
  std::vector<Int> pixels;
  for (int y = 0; y < kSide; ++y) {
    const std::int16_t* row = rows + y * Window::kStride;
    pixels.insert(pixels.end(), row, row + kSide);
  }
  return pixels;
}

/// The image that differs most from the window where it is steep.
cv::Mat opposite(const Reference& reference) {
  return drawn([&](int x, int y) {
    if (std::min(x, y) < 0 || std::max(x, y) >= kSide) return false;
    const auto i = static_cast<std::size_t>(y * kSide + x);
    return reference.gradient_x[i] + reference.gradient_y[i] > 0;
  });
}

Patch patchOf(const cv::Mat& image, int margin, float fraction) {
  return {image.ptr<uchar>(kFirst - margin) + kFirst - margin,
          static_cast<std::ptrdiff_t>(image.step),
          fractionOf(fraction),
          fractionOf(fraction)};
}

/// Of structs that consist of sums.
template <class Sums>
void expectSame(const Sums& sums, const Sums& expected) {
  EXPECT_EQ(std::memcmp(&sums, &expected, sizeof(Sums)), 0);
}

/// With the kernels for 128 bits, and the widest that the processor has.
class WindowKernelsTest : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override { cv::setUseOptimized(GetParam()); }
  void TearDown() override { cv::setUseOptimized(true); }

  static void expectExactSums(const cv::Mat& image, float fraction, float spread_px) {
    std::vector<std::int16_t> spread;
    for (int i = -kRadius; i <= kRadius; ++i) {
      spread.push_back(fractionOf(spread_px * static_cast<float>(i) / kRadius));
    }
    const Kernels& kernels = chooseKernels();
    Window window = {};
    window.side = kSide;
    std::fill_n(window.mask, kSide, std::int16_t{-1});
    std::copy(spread.begin(), spread.end(), window.spread);
    const Patch patch = patchOf(image, 1, fraction);
    Reference expected(patch, spread);
    const GradientSums gradients = kernels.takeWindow(patch, window);
    ASSERT_EQ(pixelsOf(window.values), expected.values);
    ASSERT_EQ(pixelsOf(window.gradient_x), expected.gradient_x);
    ASSERT_EQ(pixelsOf(window.gradient_y), expected.gradient_y);
    expectSame(gradients, expected.gradients);

    const auto mean = static_cast<std::int16_t>(gradients.value / (kSide * kSide));
    expected.takeContrast(mean);
    const ContrastSums contrasts = kernels.takeContrast(mean, window);
    ASSERT_EQ(pixelsOf(window.contrast), expected.contrast);
    expectSame(contrasts, expected.contrasts);

    const cv::Mat steep = opposite(expected);
    for (const cv::Mat& other : {image, cv::Mat(255 - image), steep, cv::Mat(255 - steep)}) {
      const Patch compared = patchOf(other, 0, fraction);
      expectSame(kernels.compareWindow(compared, window), expected.compare(compared));
    }
  }
};

TEST_P(WindowKernelsTest, DoNotOverflow) {
  const std::vector<cv::Mat> images = hardImages();
  for (std::size_t i = 0; i < images.size(); ++i) {
    for (const float fraction : {0.0F, 0.4F}) {
      for (const float spread_px : {-kMaxSpread_px, 0.0F, kMaxSpread_px}) {
        SCOPED_TRACE(::testing::Message() << i << ' ' << fraction << ' ' << spread_px);
        expectExactSums(images[i], fraction, spread_px);
        if (HasFailure()) return;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Optimized, WindowKernelsTest, ::testing::Bool());

}  // namespace
}  // namespace rotrocc
