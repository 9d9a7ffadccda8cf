/// Measures the time of each stage of the pipeline for one stereo pair. With ROTROCC_KITTI_DIR, the
/// pairs are those of its clip 06_000_050, otherwise a rendered street of the same size.

#include <cstdlib>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

#include "features/correspondence_finder.h"
#include "geometry/kitti_camera.h"
#include "motion/motion_estimator.h"
#include "motion/outlier_rejection.h"
#include "rotrocc/kitti.h"
#include "rotrocc/visual_odometry.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

struct Drive {
  StereoCamera camera;
  std::vector<StereoPair> pairs;
};

Drive readKitti(const std::string& directory) {
  const KittiSequence sequence(directory);
  Drive drive;
  drive.camera = sequence.camera();
  for (int i = 0; i < sequence.size(); ++i) {
    drive.pairs.push_back({sequence.stamp_ns(i), sequence.readLeft(i), sequence.readRight(i)});
  }
  return drive;
}

Drive renderStreet() {
  const StereoCamera camera = kittiCamera();
  const SyntheticScene scene(camera);
  Drive drive{camera, {}};
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.translation().z() = i;
    drive.pairs.push_back(scene.render(T_world_camera, i * 100'000'000LL));
  }
  return drive;
}

const Drive& drive() {
  static const Drive drive = [] {
    const char* kitti = std::getenv("ROTROCC_KITTI_DIR");
    return kitti != nullptr ? readKitti(std::string(kitti) + "/06_000_050") : renderStreet();
  }();
  return drive;
}

/// The third pair of the drive as a keyframe, the fourth as the current frame, and the motion
/// between the two pairs before.
struct Middle {
  CorrespondenceFinder finder{CorrespondenceFinder::Config{}};
  Keyframe keyframe;
  FramePtr current;
  Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
  Correspondences features;

  Middle() {
    VisualOdometry odometry{VisualOdometry::Config{}};
    for (std::size_t i = 0; i < 3; ++i) {
      T_prev_cur = odometry.process(drive().pairs[i], drive().camera).T_prev_cur;
    }
    keyframe.frame = finder.makeFrame(drive().pairs[2]);
    current = finder.makeFrame(drive().pairs[3]);
    finder.findCorners(keyframe);
    finder.findDepths(drive().camera, keyframe);
  }

  int find() { return finder.find(drive().camera, keyframe, *current, T_prev_cur, features); }
};

void pyramids(benchmark::State& state) {
  Middle middle;
  for (auto _ : state) benchmark::DoNotOptimize(middle.finder.makeFrame(drive().pairs[3]));
}

void corners(benchmark::State& state) {
  Middle middle;
  for (auto _ : state) middle.finder.findCorners(middle.keyframe);
  state.counters["corners"] = static_cast<double>(middle.keyframe.corners.size());
}

void disparities(benchmark::State& state) {
  Middle middle;
  middle.finder.findCorners(middle.keyframe);
  const std::vector<cv::Point2f> corners = middle.keyframe.corners;
  for (auto _ : state) {
    middle.keyframe.corners = corners;  // those that are not needed are removed
    middle.finder.findDepths(drive().camera, middle.keyframe);
  }
  state.counters["matched"] = static_cast<double>(middle.keyframe.points.size());
}

void tracking(benchmark::State& state) {
  Middle middle;
  for (auto _ : state) state.counters["tracked"] = middle.find();
  state.counters["features"] = static_cast<double>(middle.features.size());
}

void estimation(benchmark::State& state) {
  Middle middle;
  middle.find();
  MotionEstimator estimator{MotionEstimator::Config{}};
  MotionEstimator::Estimate estimate;
  for (auto _ : state) {
    estimate = estimator.estimate(drive().camera, middle.features, middle.T_prev_cur, 0.1);
  }
  state.counters["inliers"] = count(estimate.translation_inliers);
}

/// The complete odometry, over the whole drive.
void odometry(benchmark::State& state) {
  for (auto _ : state) {
    VisualOdometry odometry{VisualOdometry::Config{}};
    for (const StereoPair& pair : drive().pairs) {
      benchmark::DoNotOptimize(odometry.process(pair, drive().camera));
    }
  }
  const auto pairs = static_cast<double>(drive().pairs.size());
  state.counters["per_pair"] = benchmark::Counter(
      pairs, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Two of seven pairs are upside down: mean times of pairs that are found by the first try, that
/// are lost, and that are found later.
void failures(benchmark::State& state) {
  double sums_ms[3] = {};
  int counts[3] = {};
  for (auto _ : state) {
    VisualOdometry odometry{VisualOdometry::Config{}};
    for (std::size_t i = 0; i < drive().pairs.size(); ++i) {
      StereoPair pair = drive().pairs[i];
      if (i % 7 == 4 || i % 7 == 5) {
        cv::flip(drive().pairs[i].left, pair.left, 0);
        cv::flip(drive().pairs[i].right, pair.right, 0);
      }
      const OdometryResult result = odometry.process(pair, drive().camera);
      if (i < 2) continue;  // the start
      const int kind = !result.hasMotion() ? 1 : (result.counts.tries == 1 ? 0 : 2);
      sums_ms[kind] += result.times.total_ms;
      ++counts[kind];
    }
  }
  state.counters["usual_ms"] = sums_ms[0] / counts[0];
  state.counters["lost_ms"] = sums_ms[1] / counts[1];
  state.counters["recovered_ms"] = sums_ms[2] / counts[2];
}

BENCHMARK(pyramids)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(corners)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(disparities)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(tracking)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(estimation)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(failures)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(odometry)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace rotrocc

BENCHMARK_MAIN();
