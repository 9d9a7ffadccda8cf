#include "simulation/stress/image_stress.h"

#include <cmath>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/counter_random.h"
#include "simulation/require_range.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr int kPairsPerGain = 5;
constexpr double kFog = 110.0;  // grey level that everything has without contrast

/// Factors around 1, so that neither side of a step is all black or all white.
double gainOf(const ImageStress& stress, int pair) {
  const bool bright = pair / kPairsPerGain % 2 == 1;
  return std::sqrt(bright ? stress.gain_step : 1.0 / stress.gain_step);
}

/// Takes the texture away from a part of the image, without an edge.
void makePlain(cv::Mat& light, double share) {
  constexpr double kTexture_px = 12.0;  // coarser brightness stays
  cv::Mat plain;
  cv::GaussianBlur(light, plain, {}, kTexture_px);
  const double border = share * light.cols;
  for (int y = 0; y < light.rows; ++y) {
    for (int x = 0; x < light.cols; ++x) {
      const double kept = smoothStep(border - kTexture_px, border + kTexture_px, x + 0.5);
      float& pixel = light.at<float>(y, x);
      pixel = static_cast<float>(mix(plain.at<float>(y, x), pixel, kept));
    }
  }
}

/// Where a pixel looks through a drop, which shows its surroundings small and upside down.
void putDrop(cv::Mat& places, const cv::Point2d& centre, double radius) {
  constexpr double kShrink = 3.0;
  const cv::Point low(static_cast<int>(centre.x - radius), static_cast<int>(centre.y - radius));
  const cv::Point high(static_cast<int>(centre.x + radius) + 2,
                       static_cast<int>(centre.y + radius) + 2);
  const cv::Rect box = cv::Rect(low, high) & cv::Rect({0, 0}, places.size());
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      const cv::Point2d off = cv::Point2d(x, y) - centre;
      if (off.ddot(off) > radius * radius) continue;
      const cv::Point2d seen = centre - kShrink * off;
      places.at<cv::Vec2f>(y, x) =
          cv::Vec2f(static_cast<float>(seen.x), static_cast<float>(seen.y));
    }
  }
}

/// Drops stay where they are on their lens. Those of other cameras are elsewhere.
cv::Mat throughDrops(const cv::Mat& light, double share, std::uint64_t seed, bool right) {
  cv::Mat places(light.size(), CV_32FC2);
  for (int y = 0; y < places.rows; ++y) {
    for (int x = 0; x < places.cols; ++x) {
      places.at<cv::Vec2f>(y, x) = cv::Vec2f(static_cast<float>(x), static_cast<float>(y));
    }
  }
  RandomStream random(seed, right ? 0xD20B1 : 0xD20B0);
  // Drops overlap each other: the share that is still free falls exponentially.
  double area = -std::log(1.0 - share) * static_cast<double>(light.total());
  while (area > 0.0) {
    const double radius = random.uniform(0.015, 0.1) * light.rows;
    const double x = random.uniform(0.0, light.cols);
    putDrop(places, {x, random.uniform(0.0, light.rows)}, radius);
    area -= CV_PI * radius * radius;
  }
  cv::Mat seen;
  cv::remap(light, seen, places, {}, cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
  return seen;
}

cv::Mat throughJpeg(const cv::Mat& image, int quality) {
  std::vector<uchar> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

/// From light [grey levels] to grey levels.
cv::Mat measured(const cv::Mat& light, double noise_sigma, std::uint64_t key) {
  cv::Mat image(light.size(), CV_8UC1);
  std::uint64_t pixel = 0;
  for (int y = 0; y < light.rows; ++y) {
    for (int x = 0; x < light.cols; ++x, ++pixel) {
      const double noise = noise_sigma * gaussian(randomBits(key + pixel));
      image.at<uchar>(y, x) = cv::saturate_cast<uchar>(light.at<float>(y, x) + noise);
    }
  }
  return image;
}

}  // namespace

void ImageStress::check() const {
  requireRange("share without texture", plain_share, 0.0, 1.0);
  requireRange("share of drops", drop_share, 0.0, 0.95);
  requireRange("gain step", gain_step, 1.0, 1000.0);
  requireRange("contrast", contrast, 0.0, 1.0);
  requireRange("right gain", right_gain, 0.0, 1000.0);
  requireRange("right offset [grey levels]", right_offset, -255.0, 255.0);
  requireRange("noise [grey levels]", noise_sigma, 0.0, 200.0);
  requireRange("JPEG quality", jpeg_quality, 0, 100);
}

cv::Mat stressed(const cv::Mat& image, const ImageStress& stress, int pair, bool right) {
  cv::Mat light;
  image.convertTo(light, CV_32F);
  if (stress.plain_share > 0.0) makePlain(light, stress.plain_share);
  if (stress.drop_share > 0.0) light = throughDrops(light, stress.drop_share, stress.seed, right);
  light *= gainOf(stress, pair);
  light = cv::min(light, 255.0);
  light = kFog + stress.contrast * (light - kFog);
  if (right) light = stress.right_gain * light + stress.right_offset;
  const auto frame = 2 * static_cast<std::uint64_t>(pair) + (right ? 1 : 0);
  const cv::Mat grey = measured(light, stress.noise_sigma, randomBits(stress.seed, 0x57E55, frame));
  return stress.jpeg_quality > 0 ? throughJpeg(grey, stress.jpeg_quality) : grey;
}

}  // namespace rotrocc
