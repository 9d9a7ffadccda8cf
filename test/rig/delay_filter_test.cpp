#include "rig/delay_filter.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;

/// Features of a camera that nods, with flows of up to 8 px. What `lens` times a polynomial of
/// their place moves their rows by is not noise; one feature in eight is an outlier.
class Rig {
 public:
  explicit Rig(double delay_s, double speed = 1.0, double lens_px = 0.0)
      : delay_s_(delay_s), speed_(speed), lens_px_(lens_px) {}

  /// A pair of images whose sides are `scale` times those of the camera.
  std::vector<RowSample> pair(const StereoCamera& camera, double scale) {
    std::uniform_real_distribution<double> place(-0.5, 0.5);
    std::normal_distribution<double> noise_px(0.0, 0.2);
    const double down_px = speed_ * 4.0 * std::sin(0.7 * pairs_++);
    std::vector<RowSample> samples;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d at(place(generator_), place(generator_));
      const double flow_px = down_px + speed_ * 8.0 * at.y() * place(generator_);
      const double lens_px = lens_px_ * (1.0 + at.x() - 2.0 * at.y() * at.y());
      const double row_px = i % 8 == 0 ? 3.0 : noise_px(generator_);
      const Eigen::Vector2d px(camera.cx + at.x() * camera.width,
                               camera.cy + at.y() * camera.height);
      samples.push_back(
          {px,
           Eigen::Vector2d(0.0, scale * flow_px),
           static_cast<float>(scale * (row_px + lens_px + flow_px * delay_s_ / kPeriod_s))});
    }
    return samples;
  }

 private:
  double delay_s_, speed_, lens_px_;
  int pairs_ = 0;
  std::mt19937 generator_{1};
};

const StereoCamera& camera() {
  static const StereoCamera camera = SyntheticScene::defaultCamera();
  return camera;
}

void drive(int pairs, Rig rig, DelayFilter& filter) {
  for (int i = 0; i < pairs; ++i) filter.add(camera(), kPeriod_s, rig.pair(camera(), 1.0));
}

/// Noise of 0.2 px over a thousand flows of about 3 px is 0.2 ms.
constexpr double kError_s = 1e-3;

TEST(DelayFilterTest, FindsADelayInSpiteOfLensesAndWrongFeatures) {
  for (const double delay_s : {-0.01, 0.01}) {
    DelayFilter filter;
    drive(60, Rig(delay_s, 1.0, 0.5), filter);
    const RightDelay& delay = filter.delay();
    EXPECT_NEAR(delay.estimated_s, delay_s, kError_s);
    EXPECT_LT(delay.sigma_s, std::abs(delay_s) / 4.0);
    EXPECT_NEAR(delay.applied_s, delay.estimated_s, 1e-4) << "6 standard deviations: as a whole";
  }
}

TEST(DelayFilterTest, AppliesNothingWithoutADelay) {
  DelayFilter filter;
  EXPECT_EQ(filter.delay().applied_s, 0.0);
  drive(60, Rig(0.0, 1.0, 0.5), filter);
  EXPECT_NEAR(filter.delay().estimated_s, 0.0, 2.0 * filter.delay().sigma_s);
  EXPECT_NEAR(filter.delay().applied_s, 0.0, 1e-4);
}

/// A quarter of its features would fit half a period, as fast ones in saturated parts of an image
/// do.
TEST(DelayFilterTest, WrongRowsOfTheFirstPairAreNoDelay) {
  Rig rig(0.0);
  DelayFilter filter;
  std::vector<RowSample> first = rig.pair(camera(), 1.0);
  for (std::size_t i = 0; i < first.size(); i += 4) {
    first[i].flow_px.y() = 20.0;
    first[i].offset_px = 10.0F;
  }
  filter.add(camera(), kPeriod_s, first);
  for (int i = 0; i < 30; ++i) {
    filter.add(camera(), kPeriod_s, rig.pair(camera(), 1.0));
    EXPECT_NEAR(filter.delay().applied_s, 0.0, 1e-3) << i;
  }
}

TEST(DelayFilterTest, KnowsNothingAtRest) {
  DelayFilter filter;
  drive(60, Rig(0.0, 0.0, 0.5), filter);
  EXPECT_GT(filter.delay().sigma_s, 0.09 * kPeriod_s) << "as before";
  EXPECT_NEAR(filter.delay().applied_s, 0.0, 1e-4);
  DelayFilter exact;
  std::vector<RowSample> samples(20, {{1.0, 2.0}, {0.0, 0.0}, 0.0F});
  for (int i = 0; i < 3; ++i) exact.add(camera(), kPeriod_s, samples);
  EXPECT_EQ(exact.delay().applied_s, 0.0) << "in images without noise";
}

TEST(DelayFilterTest, FollowsACameraThatIsRestarted) {
  DelayFilter filter;
  drive(60, Rig(0.01), filter);
  drive(500, Rig(-0.01), filter);
  EXPECT_NEAR(filter.delay().estimated_s, -0.01, 2.0 * filter.delay().sigma_s);
  EXPECT_LT(filter.delay().applied_s, -0.005);
}

TEST(DelayFilterTest, DoesNotDependOnTheSizeOfImages) {
  Rig rig(0.01);
  Rig same(0.01);
  DelayFilter filter;
  DelayFilter other;
  for (int i = 0; i < 60; ++i) {
    filter.add(camera(), kPeriod_s, rig.pair(camera(), 1.0));
    const int level = i < 30 ? 0 : 1;
    const StereoCamera halved = camera().halved(level);
    other.add(halved, kPeriod_s, same.pair(halved, std::ldexp(1.0, -level)));
  }
  EXPECT_NEAR(filter.delay().estimated_s, other.delay().estimated_s, 1e-5);
}

}  // namespace
}  // namespace rotrocc
