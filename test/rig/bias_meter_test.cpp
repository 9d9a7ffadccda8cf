#include "rig/bias_meter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

Eigen::Isometry3d ahead() {
  return motion({0.0, 0.0, 1.2}, {0.0, 0.01, 0.0});
}

double none(const Eigen::Vector2d&) {
  return 0.0;
}

double onePixel(const Eigen::Vector2d&) {
  return 1.0;
}

template <class Error>
Correspondences features(const Eigen::Isometry3d& T, unsigned seed, const Error& error_px) {
  Correspondences found = biasedFeatures(T, seed, {0.12, 0.06}, error_px);
  triangulate(kittiCamera(), found);
  return found;
}

BiasMeasurement measure(const Correspondences& found, const Eigen::Isometry3d& start) {
  const auto measurement = BiasMeter().measure(kittiCamera(), found, start);
  EXPECT_TRUE(measurement);
  return measurement.value_or(BiasMeasurement());
}

TEST(BiasMeterTest, MeasuresTheBiasWithinItsNoise) {
  for (const double bias_px : {-2.0, 0.0, 0.5, 3.0}) {
    const auto found = features(ahead(), 1, [&](const Eigen::Vector2d&) { return bias_px; });
    const BiasMeasurement measurement = measure(found, ahead());
    EXPECT_NEAR(measurement.bias_px, bias_px, 3.0 * std::sqrt(measurement.noise_px2));
    EXPECT_LT(measurement.noise_px2, 0.1 * 0.1);
  }
}

TEST(BiasMeterTest, DependsLittleOnTheStart) {
  const auto found = features(ahead(), 2, onePixel);
  const BiasMeasurement near = measure(found, ahead());
  const BiasMeasurement far = measure(found, ahead() * motion({0.0, 0.0, 0.1}, {0.0, 0.0, 0.0}));
  EXPECT_NEAR(near.bias_px, far.bias_px, 0.02);
}

double variance(const BiasMeasurement& measurement) {
  return measurement.noise_px2 + measurement.shared_px2;
}

TEST(BiasMeterTest, CoversErrorsThatNeighborsShare) {
  double squares = 0.0;
  constexpr unsigned kPairs = 100;
  for (unsigned seed = 0; seed < kPairs; ++seed) {
    std::mt19937 generator(seed + 100);
    std::normal_distribution<double> error(0.0, 0.15);  // 1.3 times the noise of a flow
    std::array<double, SharedErrorGrid::kCells> errors_px;
    for (double& error_px : errors_px) error_px = error(generator);
    const auto ofCell = [&](const Eigen::Vector2d& pixel) {
      return errors_px[SharedErrorGrid(kittiCamera()).cell(pixel.x(), pixel.y())];
    };
    const BiasMeasurement measurement = measure(features(ahead(), seed, ofCell), ahead());
    squares += measurement.bias_px * measurement.bias_px / variance(measurement) / kPairs;
  }
  // The smooth errors that the model has, too, are missing here. The scatter of a mean of 100
  // squares is 0.14.
  EXPECT_GT(squares, 0.3);
  EXPECT_LT(squares, 1.3);
}

/// Features as a car sees them: near ones at the bottom of the image, far ones in the middle.
template <class Error>
Correspondences onARoad(unsigned seed, const Error& error_px) {
  Correspondences found = features(ahead(), seed, error_px);
  const auto isElsewhere = [](const Correspondence& feature) {
    const double y = 2.0 * feature.cur_px.y() / kittiCamera().height - 1.0;
    return (std::abs(y) > 0.5) != (feature.point_cur.z() < 15.0);
  };
  found.erase(std::remove_if(found.begin(), found.end(), isElsewhere), found.end());
  return found;
}

TEST(BiasMeterTest, ASmoothErrorIsNoBias) {
  constexpr double kBorder_px = 0.12 * kSmoothRatio;  // the first is the noise of a flow
  for (const int axis : {0, 1}) {
    const auto parabola_px = [axis](const Eigen::Vector2d& pixel) {
      const int side_px = axis == 0 ? kittiCamera().width : kittiCamera().height;
      const double place = 2.0 * pixel[axis] / side_px - 1.0;
      return kBorder_px * place * place;
    };
    const BiasMeasurement of_parabola = measure(onARoad(1, parabola_px), ahead());
    EXPECT_LT(std::abs(of_parabola.bias_px), 2.0 * std::sqrt(variance(of_parabola))) << axis;
  }

  // A bias is still one.
  const auto biased = onARoad(1, onePixel);
  const BiasMeasurement bias = measure(biased, ahead());
  EXPECT_NEAR(bias.bias_px, 1.0, 3.0 * std::sqrt(variance(bias)));
}

TEST(BiasMeterTest, StandstillAndFewFeaturesSayNothing) {
  const Eigen::Isometry3d rest = Eigen::Isometry3d::Identity();
  const auto at_rest = features(rest, 5, onePixel);
  BiasMeter meter;
  EXPECT_FALSE(meter.measure(kittiCamera(), at_rest, rest));
  Correspondences few = features(ahead(), 4, none);
  few.resize(20);
  EXPECT_FALSE(meter.measure(kittiCamera(), few, ahead()));
}

}  // namespace
}  // namespace rotrocc
