#include "rectification/image_resampler.h"

#include <algorithm>
#include <cmath>

namespace rotrocc {
namespace {

constexpr int kBits = 10;  // of a weight: the products of two and a pixel fit into 32 bits
constexpr int kOne = 1 << kBits;

/// The weight of a pixel at a distance [px] below 2.
double catmullRom(double distance) {
  const double d = std::abs(distance);
  if (d < 1.0) return 1.0 + d * d * (1.5 * d - 2.5);
  return 2.0 + d * (-4.0 + d * (2.5 - 0.5 * d));
}

std::uint8_t toGrey(int sum) {
  const int grey = (sum + (1 << (2 * kBits - 1))) >> (2 * kBits);
  return static_cast<std::uint8_t>(std::clamp(grey, 0, 255));
}

}  // namespace

ImageResampler::ImageResampler(const cv::Size& source, const cv::Size& size)
    : source_(source), size_(size), places_(static_cast<std::size_t>(size.area())) {}

/// The weights of each phase sum up to one, so that areas of one grey level keep it.
std::array<ImageResampler::Weights, ImageResampler::kPhases> ImageResampler::weightTable() {
  std::array<Weights, kPhases> table;
  for (int phase = 0; phase < kPhases; ++phase) {
    int sum = 0;
    for (int tap = 0; tap < kTaps; ++tap) {
      const double distance = tap - 1 - static_cast<double>(phase) / kPhases;
      table[phase][tap] = static_cast<std::int16_t>(std::lround(kOne * catmullRom(distance)));
      sum += table[phase][tap];
    }
    table[phase][phase < kPhases / 2 ? 1 : 2] += static_cast<std::int16_t>(kOne - sum);
  }
  return table;
}

void ImageResampler::setPlace(int x, int y, const Eigen::Vector2d& place) {
  const auto fixed = [](double position, int count) {
    const double nearest = std::max(0.0, std::min(position, count - 1.0));  // 0 for NaN
    return static_cast<int>(std::lround(nearest * kPhases));
  };
  const int column = fixed(place.x(), source_.width);
  const int row = fixed(place.y(), source_.height);
  Place& stored = places_[static_cast<std::size_t>(y) * size_.width + x];
  stored.column = static_cast<std::int16_t>(column / kPhases);
  stored.row = static_cast<std::int16_t>(row / kPhases);
  stored.column_phase = static_cast<std::uint8_t>(column % kPhases);
  stored.row_phase = static_cast<std::uint8_t>(row % kPhases);
}

std::uint8_t ImageResampler::inside(const cv::Mat& image, const Place& place) const {
  const Weights& across = weights_[place.column_phase];
  const Weights& down = weights_[place.row_phase];
  const std::uint8_t* pixels = image.ptr(place.row - 1) + place.column - 1;
  int sum = 0;
  for (int j = 0; j < kTaps; ++j, pixels += image.step) {
    sum += down[j] * (across[0] * pixels[0] + across[1] * pixels[1] + across[2] * pixels[2] +
                      across[3] * pixels[3]);
  }
  return toGrey(sum);
}

/// Repeats the pixels of the border.
std::uint8_t ImageResampler::atBorder(const cv::Mat& image, const Place& place) const {
  const Weights& across = weights_[place.column_phase];
  const Weights& down = weights_[place.row_phase];
  int sum = 0;
  for (int j = 0; j < kTaps; ++j) {
    const std::uint8_t* row = image.ptr(std::clamp(place.row - 1 + j, 0, image.rows - 1));
    for (int i = 0; i < kTaps; ++i) {
      sum += down[j] * across[i] * row[std::clamp(place.column - 1 + i, 0, image.cols - 1)];
    }
  }
  return toGrey(sum);
}

void ImageResampler::resample(const cv::Mat& image, cv::Mat& result) const {
  const Place* place = places_.data();
  for (int y = 0; y < size_.height; ++y) {
    std::uint8_t* pixels = result.ptr(y);
    for (int x = 0; x < size_.width; ++x, ++place) {
      const bool is_inside = place->column > 0 && place->column + 2 < source_.width &&
                             place->row > 0 && place->row + 2 < source_.height;
      pixels[x] = is_inside ? inside(image, *place) : atBorder(image, *place);
    }
  }
}

}  // namespace rotrocc
