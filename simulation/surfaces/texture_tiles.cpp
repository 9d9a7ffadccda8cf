#include "simulation/surfaces/texture_tiles.h"

#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

constexpr int kSize = 1024;  // [texels]

/// Extends the border of a tile periodically for drawing and filtering.
cv::Mat wrapped(const cv::Mat& tile, int border) {
  cv::Mat padded;
  cv::copyMakeBorder(tile, padded, border, border, border, border, cv::BORDER_WRAP);
  return padded;
}

/// Smooth noise of `cells` x `cells` independent values with mean 0 and a spread of about 1.
cv::Mat smoothNoise(cv::Size cells, std::uint64_t key) {
  cv::Mat values(cells, CV_32F);
  for (int row = 0; row < cells.height; ++row) {
    for (int col = 0; col < cells.width; ++col) {
      values.at<float>(row, col) = static_cast<float>(3.4 * randomUniform(key, row, col) - 1.7);
    }
  }
  constexpr int kBorder = 2;
  const int scale_x = kSize / cells.width;
  const int scale_y = kSize / cells.height;
  cv::Mat noise;
  cv::resize(wrapped(values, kBorder), noise, cv::Size(), scale_x, scale_y, cv::INTER_CUBIC);
  return noise(cv::Rect(kBorder * scale_x, kBorder * scale_y, kSize, kSize)).clone();
}

/// Noise in octaves from `coarsest` to `finest` cells, each `gain` times the previous one.
cv::Mat fractalNoise(int coarsest, int finest, double gain, std::uint64_t key) {
  cv::Mat sum = cv::Mat::zeros(kSize, kSize, CV_32F);
  double amplitude = 1.0;
  double energy = 0.0;
  for (int cells = coarsest; cells <= finest; cells *= 2) {
    sum += amplitude * smoothNoise({cells, cells}, randomBits(key, cells));
    energy += amplitude * amplitude;
    amplitude *= gain;
  }
  return sum / std::sqrt(energy);
}

/// Draws an ellipse, wrapped around the borders of the tile.
void drawWrapped(
    cv::Mat& tile, cv::Point2d center, cv::Size2d half_axes, double angle_deg, double value) {
  const double reach = std::max(half_axes.width, half_axes.height);
  for (const double dx : {-kSize, 0, kSize}) {
    for (const double dy : {-kSize, 0, kSize}) {
      const cv::Point2d at(center.x + dx, center.y + dy);
      if (at.x < -reach || at.y < -reach || at.x > kSize + reach || at.y > kSize + reach) continue;
      const cv::RotatedRect box(cv::Point2f(at),
                                cv::Size2f(2.0 * half_axes.width, 2.0 * half_axes.height),
                                static_cast<float>(angle_deg));
      cv::ellipse(tile, box, cv::Scalar(value), cv::FILLED);
    }
  }
}

struct Scatter {
  int count;
  double low, high;  // length of the half axes [texels]
  double slimness;   // longer over shorter axis
  double darkest, lightest;
};

/// Random ellipses, later ones on top and lighter.
void scatter(cv::Mat& tile, const Scatter& pieces, RandomStream random) {
  for (int i = 0; i < pieces.count; ++i) {
    const double length = random.uniform(pieces.low, pieces.high);
    const cv::Point2d center{random.uniform(0, kSize), random.uniform(0, kSize)};
    const double value = random.uniform(pieces.darkest, pieces.lightest) *
                         (0.55 + 0.45 * i / std::max(1, pieces.count - 1));
    const double angle_deg = random.uniform(0.0, 180.0);
    drawWrapped(tile, center, {length, length / pieces.slimness}, angle_deg, value);
  }
}

/// Dark random curves.
void drawCracks(cv::Mat& tile, int count, RandomStream random) {
  for (int crack = 0; crack < count; ++crack) {
    cv::Point2d at{random.uniform(0, kSize), random.uniform(0, kSize)};
    double heading = random.uniform(0.0, 2.0 * CV_PI);
    const int steps = 60 + random.index(160);
    for (int step = 0; step < steps; ++step) {
      heading += random.uniform(-0.35, 0.35);
      at += cv::Point2d(2.0 * std::cos(heading), 2.0 * std::sin(heading));
      at.x -= kSize * std::floor(at.x / kSize);
      at.y -= kSize * std::floor(at.y / kSize);
      drawWrapped(tile, at, {1.6, 1.1}, 0.0, 0.22);
    }
  }
}

Texture soften(cv::Mat tile, double sigma_px, double period_m) {
  constexpr int kBorder = 16;
  cv::Mat blurred;
  cv::GaussianBlur(wrapped(tile, kBorder), blurred, cv::Size(), sigma_px);
  return {blurred(cv::Rect(kBorder, kBorder, kSize, kSize)).clone(), period_m};
}

Texture makeAsphalt(std::uint64_t key) {
  cv::Mat tile = 0.5 + 0.1 * fractalNoise(8, 512, 1.08, key);
  cv::Mat stones = tile.clone();
  scatter(stones, {9000, 1.0, 2.6, 1.3, 0.25, 0.85}, RandomStream(key, 1));
  tile = 0.7 * tile + 0.3 * stones;
  drawCracks(tile, 9, RandomStream(key, 2));
  return soften(tile, 0.6, 9.0);
}

/// A grid of stones with random brightness, rows shifted by half a stone.
cv::Mat masonry(cv::Size stones, int joint_px, double joint, double spread, std::uint64_t key) {
  cv::Mat tile(kSize, kSize, CV_32F, cv::Scalar(joint));
  const double width = static_cast<double>(kSize) / stones.width;
  const double height = static_cast<double>(kSize) / stones.height;
  for (int row = 0; row < stones.height; ++row) {
    for (int col = 0; col <= stones.width; ++col) {
      const double left = (col - 0.5 * (row % 2)) * width;
      const double value = 0.54 + spread * (randomUniform(key, row, col % stones.width) - 0.5);
      cv::rectangle(tile,
                    cv::Point2d(left + joint_px, row * height + joint_px),
                    cv::Point2d(left + width - 1, (row + 1) * height - 1),
                    cv::Scalar(value),
                    cv::FILLED);
    }
  }
  return tile;
}

Texture makePaving(std::uint64_t key) {
  const cv::Mat tile =
      masonry({10, 10}, 3, 0.26, 0.22, key) + 0.06 * fractalNoise(4, 512, 0.9, key);
  return soften(tile, 0.9, 5.0);
}

Texture makeGrass(std::uint64_t key) {
  cv::Mat tile(kSize, kSize, CV_32F, cv::Scalar(0.3));
  scatter(tile, {42000, 2.0, 9.0, 4.0, 0.25, 0.85}, RandomStream(key, 1));
  tile = tile + 0.10 * fractalNoise(2, 64, 0.9, key);
  return soften(tile, 0.8, 6.0);
}

Texture makeLeaves(std::uint64_t key) {
  cv::Mat tile(kSize, kSize, CV_32F, cv::Scalar(0.12));
  scatter(tile, {9000, 5.0, 17.0, 1.7, 0.12, 1.0}, RandomStream(key, 1));
  tile = tile + 0.13 * fractalNoise(4, 32, 0.9, key);
  return soften(tile, 1.0, 3.0);
}

Texture makePlaster(std::uint64_t key) {
  return {0.5 + 0.085 * fractalNoise(2, 512, 0.85, key), 7.0};
}

Texture makeBricks(std::uint64_t key) {
  const cv::Mat tile = masonry({8, 32}, 3, 0.75, 0.3, key) + 0.05 * fractalNoise(4, 512, 0.9, key);
  return soften(tile, 0.9, 2.4);
}

Texture makeRoofTiles(std::uint64_t key) {
  cv::Mat tile = masonry({24, 16}, 5, 0.2, 0.25, key);
  for (int row = 0; row < kSize; ++row) {
    const double along = std::fmod(row * 16.0 / kSize, 1.0);  // each row shades the next
    tile.row(row) += 0.15 * (along - 0.5);
  }
  return soften(tile + 0.07 * fractalNoise(2, 128, 0.9, key), 1.0, 5.0);
}

Texture makeBark(std::uint64_t key) {
  cv::Mat tile = cv::Mat(kSize, kSize, CV_32F, cv::Scalar(0.5));
  for (const int cells : {32, 64, 128}) {
    tile += 0.1 * smoothNoise({cells, cells / 8}, randomBits(key, cells));
  }
  return {tile, 1.5};
}

Texture makeWriting() {
  const std::vector<std::string> lines = {"BAKERY  CAFE  Hotel Post",
                                          "Zentrum 3 km  Bahnhof  P",
                                          "BOOKS & MAPS   PHARMACY",
                                          "Fresh fruit  *  OPEN 8-20",
                                          "Altstadt  Messe  Flughafen",
                                          "CINEMA  tailor  WINE BAR",
                                          "A 81  Ausfahrt 1200 m",
                                          "Florist  SHOES  Optik 24"};
  cv::Mat tile = cv::Mat::zeros(kSize, kSize, CV_32F);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto base = static_cast<int>((static_cast<double>(i) + 0.76) * kSize / 8.0);
    cv::putText(tile, lines[i], {8, base}, cv::FONT_HERSHEY_DUPLEX, 2.35, cv::Scalar(1.0), 7);
  }
  cv::flip(tile, tile, 0);  // the second coordinate of a face points up
  return soften(tile, 0.8, 1.0);
}

Texture makeBlotches(std::uint64_t key) {
  return {0.5 + 0.17 * fractalNoise(4, 256, 0.55, key), 1.0};
}

}  // namespace

TextureTiles::TextureTiles(std::uint64_t seed)
    : asphalt(makeAsphalt(randomBits(seed, 1))),
      paving(makePaving(randomBits(seed, 2))),
      grass(makeGrass(randomBits(seed, 3))),
      leaves(makeLeaves(randomBits(seed, 4))),
      plaster(makePlaster(randomBits(seed, 5))),
      bricks(makeBricks(randomBits(seed, 6))),
      roof_tiles(makeRoofTiles(randomBits(seed, 7))),
      bark(makeBark(randomBits(seed, 8))),
      writing(makeWriting()),
      blotches(makeBlotches(randomBits(seed, 9))) {}

}  // namespace rotrocc
