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

/// The largest window.
constexpr int kRadius = 25;
constexpr int kSide = 2 * kRadius + 1;

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

/// Sums over the pixels of a window, in 64 bits.
Int sumOf(const std::function<Int(int x, int y)>& value) {
  Int sum = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) sum += value(x, y);
  }
  return sum;
}

/// A value of each pixel of a window.
auto pixelsOf(const Window::Rows& rows) {
  return [&rows](int x, int y) -> Int { return rows[y * Window::kStride + x]; };
}

Patch patchOf(const cv::Mat& image, int margin) {
  return {image.ptr<uchar>(kFirst - margin) + kFirst - margin,
          static_cast<std::ptrdiff_t>(image.step),
          0,
          0};
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

  static void expectExactSums(const cv::Mat& image) {
    const Kernels& kernels = chooseKernels();
    Window window = {};
    window.side = kSide;
    std::fill_n(window.mask, kSide, std::int16_t{-1});
    const auto value = pixelsOf(window.values);
    const auto gx = pixelsOf(window.gradient_x);
    const auto gy = pixelsOf(window.gradient_y);
    const auto contrast = pixelsOf(window.contrast);
    const auto products = [](const auto& a, const auto& b) {
      return sumOf([&](int x, int y) { return a(x, y) * b(x, y); });
    };
    const WindowSums sums = kernels.takeWindow(patchOf(image, 1), window);
    expectSame(sums,
               WindowSums{sumOf(gx),
                          sumOf(gy),
                          sumOf(contrast),
                          products(gx, gx),
                          products(gx, gy),
                          products(gy, gy),
                          products(contrast, gx),
                          products(contrast, gy),
                          products(contrast, contrast)});
    constexpr int kToContrast = Window::kValueBits - Window::kContrastBits;
    EXPECT_EQ(contrast(1, 2), (value(1, 2) - value(kRadius, kRadius)) >> kToContrast);
    // The image that differs most from the window where it is steep.
    const cv::Mat steep = drawn([&](int x, int y) {
      if (std::min(x, y) < 0 || std::max(x, y) >= kSide) return false;
      return gx(x, y) + gy(x, y) > 0;
    });
    for (const cv::Mat& other : {image, cv::Mat(255 - image), steep, cv::Mat(255 - steep)}) {
      const auto excess = [&](int x, int y) {
        const Int pixel = other.at<uchar>(y + kFirst, x + kFirst);
        return ((pixel << Window::kValueBits) - value(x, y)) >>
               (Window::kValueBits - MismatchSums::kDifferenceBits);
      };
      expectSame(kernels.compareWindow(patchOf(other, 0), window),
                 MismatchSums{sumOf(excess),
                              products(excess, gx),
                              products(excess, gy),
                              products(excess, contrast),
                              products(excess, excess)});
    }
  }
};

TEST_P(WindowKernelsTest, DoNotOverflow) {
  for (const cv::Mat& image : hardImages()) expectExactSums(image);
}

INSTANTIATE_TEST_SUITE_P(Optimized, WindowKernelsTest, ::testing::Bool());

}  // namespace
}  // namespace rotrocc
