#include "input/camera_clock.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/to_seconds.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kStart_s = 1.6e9;

/// An image, and the time since the one before.
struct Image {
  double off_s = 0.0;  ///< stamp minus arrival; -kStart_s: a stamp of 0
  double wait_s = kPeriod_s;
};

class CameraClockTest : public testing::Test {
 protected:
  static std::int64_t toNs(double seconds) { return std::llround(1e6 * seconds) * 1000; }

  void restart() {
    time_s_ = 0.0;
    clock_ = CameraClock("the left image");
  }

  /// The verdict: v valid; h held; j valid, and so is the one that was held; g valid, but the one
  /// that was held is a glitch; x held, another one was held and is a glitch; z, r, b: thrown.
  char take(const Image& image) {
    time_s_ += image.wait_s;
    const std::int64_t time_ns = toNs(kStart_s + time_s_);
    const Arrival arrival = {
        std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns)),
        clock_known_ ? time_ns : 0};
    const std::int64_t stamp_ns =
        image.off_s == -kStart_s ? 0 : toNs(kStart_s + time_s_ + image.off_s);
    CameraClock::Verdict verdict;
    try {
      verdict = clock_.judge(stamp_ns, arrival);
    } catch (const InputError& error) {
      said_ = error.what();
      return toString(error.reason())[std::string("stamp_").size()];
    }
    if (verdict.glitch) said_ = verdict.glitch->what();
    if (verdict.held_is_valid) clock_.add(held_ns_, arrival);
    if (verdict.held) {
      held_ns_ = stamp_ns;
    } else {
      clock_.add(stamp_ns, arrival);
    }
    return verdict.glitch          ? verdict.held ? 'x' : 'g'
           : verdict.held          ? 'h'
           : verdict.held_is_valid ? 'j'
                                   : 'v';
  }

  std::string takeAll(const std::vector<Image>& images) {
    std::string verdicts;
    for (const Image& image : images) verdicts += take(image);
    return verdicts;
  }

  bool clock_known_ = true;
  double time_s_ = 0.0;
  std::int64_t held_ns_ = 0;
  CameraClock clock_{""};
  std::string said_;  // the last message
};

TEST_F(CameraClockTest, JudgesEachStamp) {
  const struct {
    const char* what;
    int before;  ///< images in time before
    std::vector<Image> images;
    std::string verdicts;
    const char* said = "";
    double set_s = 0.0;  ///< see CameraClock::set_ns()
  } rows[] = {
      {"stamp 0", 3, {{-kStart_s}, {}}, "zv", "has the stamp 0: set header.stamp in the driver"},
      {"repeated", 3, {{-0.1}, {}}, "rv", "has the same stamp as the previous one, 1600000000.300"},
      {"repeated and held", 3, {{5.0}, {4.9}, {}}, "hrg"},
      {"overtaken", 3, {{-0.15}, {}, {-0.15}, {}}, "bvbv", "1600000000.450 s, 0.05 s before the"},
      {"a glitch far ahead", 3, {{3e9}, {}}, "hg", "3e+09 s after the previous one, but the next"},
      {"the first stamp far ahead", 0, {{100.0}, {}}, "hg", "100 s after the clock, but the next"},
      {"a clock far ahead", 0, {{100.0}, {100.0}, {100.0}}, "hjv"},
      {"the computer's clock is set back", 80, {{60.0, -59.9}, {60.0}, {60.0}}, "hjv"},
      {"the clock is set far ahead", 80, {{37.0}, {37.0}, {37.0}}, "hjv", "", 37.0},
      {"a glitch ahead", 80, {{5.0}, {}, {}}, "hgv", "5.1 s after the previous one, but the next"},
      {"a glitch behind", 80, {{-5.0}, {}, {}}, "hgv", "4.9 s before the previous one"},
      {"a glitch by a few periods", 80, {{0.35}, {}, {}}, "hgv", "0.45 s after"},
      {"two glitches", 3, {{2.0}, {7.0}, {}}, "hxg"},
      {"a glitch before a gap", 3, {{2.0}, {0.0, 6.0}}, "hg"},
      {"a gap", 3, {{0.0, 3.0}, {}}, "vv"},
      {"the stamps alone jump ahead", 80, {{5.0}, {5.0}, {5.0}}, "hjv", "", 5.0},
      {"the stamps alone jump back", 80, {{-5.0}, {-5.0}, {-5.0}}, "hjv", "", -5.0},
      {"a step after a few images", 3, {{3.0}, {3.0}, {3.0}}, "hjv", "", 3.0},
      {"a loop, while the clock goes on", 80, {{-8.0}, {-8.0}}, "vv"},
      {"an earlier run", 80, {{-100.0}, {-100.0}}, "vv"},
      {"stamps and clock go back", 80, {{0.0, -4.0}, {}}, "vv"},
      {"a short loop, while the clock goes on", 6, {{-0.6}, {-0.6}, {-0.6}, {-0.6}}, "bbvv"},
      {"a short loop of the clock, too", 6, {{0.0, -0.5}, {}}, "vv"},
      {"a link stands, then brings what it kept",
       20,
       {{-0.9, 1.0}, {-0.8, 0.0}, {0.0, 0.9}},
       "vvv"},
      {"a fast replay with lost images",
       20,
       {{0.09, 0.01}, {0.18, 0.01}, {0.67, 0.01}, {0.76, 0.01}, {0.85, 0.01}},
       "vvhjv"},
  };
  for (const auto& [what, before, images, verdicts, said, set_s] : rows) {
    SCOPED_TRACE(what);
    restart();
    EXPECT_EQ(takeAll(std::vector<Image>(static_cast<std::size_t>(before))),
              std::string(static_cast<std::size_t>(before), 'v'));
    EXPECT_EQ(takeAll(images), verdicts);
    EXPECT_NE(said_.find(said), std::string::npos) << said_;
    EXPECT_NEAR(toSeconds(clock_.set_ns()), set_s, 1e-6);
  }
}

/// As in simulated time before the first /clock.
TEST_F(CameraClockTest, WithoutRosTimeTheSteadyClockTells) {
  clock_known_ = false;
  restart();
  EXPECT_EQ(takeAll({{}, {}, {0.0, 3.0}, {20.0}, {20.0}, {}, {}, {}}), "vvvhjhjv");
  EXPECT_FALSE(clock_.age_s());
  clock_known_ = true;
  EXPECT_EQ(takeAll({{-0.2, 0.5}, {-0.2}}), "vv");
  EXPECT_NEAR(*clock_.age_s(), 0.2, 1e-6);
}

TEST_F(CameraClockTest, KnowsPeriodAgeAndScatter) {
  restart();
  EXPECT_FALSE(clock_.age_s());
  EXPECT_EQ(clock_.stampScatter_s() + clock_.arrivalScatter_s(), 0.0);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const double late_s = 0.02 + 0.005 * std::abs(normal(random));
    const double trigger_s = i * kPeriod_s;
    const double jitter_s = 1e-3 * normal(random);
    if (i % 3 == 2) continue;  // a lost image
    const double wait_s = trigger_s + late_s - time_s_;
    EXPECT_EQ(take({jitter_s - late_s, wait_s}), 'v');
    if (i < 30) continue;
    // From 32 images, the deviation is known to a third at 3 standard deviations; the quantiles of
    // half of a normal distribution of 5 ms have a spread of 2.9 ms.
    EXPECT_NEAR(toSeconds(*clock_.period_ns()), kPeriod_s, 2e-3);
    EXPECT_NEAR(clock_.stampScatter_s(), 1e-3, 0.7e-3);
    EXPECT_NEAR(clock_.arrivalScatter_s(), 3e-3, 2e-3);
    EXPECT_NEAR(*clock_.age_s(), 0.02, 3e-3);
  }
  takeAll({{-60.0}, {-60.0}});
  EXPECT_NEAR(*clock_.age_s(), 60.0, 0.01);
  EXPECT_NEAR(toSeconds(*clock_.period_ns()), kPeriod_s, 2e-3);
}

}  // namespace
}  // namespace rotrocc
