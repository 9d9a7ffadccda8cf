#include "features/correspondence_finder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/median.h"
#include "support/simulated_features.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

Eigen::Isometry3d step() {
  return motion({0.01, 0.0, 0.5}, {0.0, 0.02, 0.002});
}

StereoPair view(const SyntheticScene& scene, const Eigen::Isometry3d& T_world_camera) {
  StereoPair pair = scene.render(T_world_camera, 0);
  SyntheticScene::addNoise(pair, 1.5, 1);
  return pair;
}

/// A keyframe and a current frame.
struct Frames {
  Frames(CorrespondenceFinder& finder,
         const StereoPair& prev,
         const StereoPair& cur,
         const StereoCamera& camera,
         double row_offset_px = 0.0) {
    keyframe.frame = finder.makeFrame(prev);
    keyframe.row_offset_px = row_offset_px;
    finder.findCorners(keyframe);
    finder.findDepths(camera, keyframe);
    current = finder.makeFrame(cur);
  }

  Keyframe keyframe;
  FramePtr current;
};

/// All stages from two pairs to the feature set. The prediction is the true motion.
Correspondences find(const StereoPair& prev,
                     const StereoPair& cur,
                     const StereoCamera& camera,
                     const CorrespondenceFinder::Config& config = {}) {
  CorrespondenceFinder finder(config);
  const Frames frames(finder, prev, cur, camera);
  Correspondences features;
  finder.find(camera, frames.keyframe, *frames.current, step(), features);
  return features;
}

TEST(CorrespondenceFinderTest, FindsPointsOfTheSceneInBothPairs) {
  StereoCamera verged = SyntheticScene::defaultCamera();
  verged.cx_right += 12.0;  // far points have negative disparities
  for (const StereoCamera& camera : {SyntheticScene::defaultCamera(), verged}) {
    const SyntheticScene scene(camera);
    const Correspondences features =
        find(view(scene, Eigen::Isometry3d::Identity()), view(scene, step()), camera);
    ASSERT_GT(features.size(), 300u);
    std::vector<double> flow_errors_px;
    std::vector<double> disparity_errors_px;
    for (const Correspondence& feature : features) {
      const Eigen::Vector3d point_cur = scene.pointAt(step(), feature.cur_px);
      flow_errors_px.push_back((camera.project(step() * point_cur) - feature.keyframe_px).norm());
      disparity_errors_px.push_back(
          std::abs(feature.disparity_px - camera.disparity(point_cur.z())));
      EXPECT_LT((camera.project(feature.point_cur) - feature.cur_px).norm(), 1e-9);
      EXPECT_NEAR(camera.disparity(feature.point_cur.z()), feature.disparity_px, 1e-9);
    }
    // The measured accuracy of the tracker and the matcher alone.
    EXPECT_LT(median(flow_errors_px), 0.25);
    EXPECT_LT(median(disparity_errors_px), 0.25);
  }
}

/// The pair with its right image moved down.
StereoPair withRightLower(StereoPair pair, double rows) {
  SyntheticScene::lowerRight(pair, rows);
  return pair;
}

TEST(CorrespondenceFinderTest, WantsLeftAndRightOnOneRow) {
  const SyntheticScene scene;
  const StereoPair prev = view(scene, Eigen::Isometry3d::Identity());
  const StereoPair cur = view(scene, step());
  const auto good = find(prev, cur, scene.camera()).size();
  // The right image shifts down between the pairs.
  EXPECT_GT(find(prev, withRightLower(cur, 0.5), scene.camera()).size(), good / 2);
  EXPECT_LT(find(prev, withRightLower(cur, 2.0), scene.camera()).size(), good / 10);
}

TEST(CorrespondenceFinderTest, FindsFeaturesInALowerRightImage) {
  const SyntheticScene scene;
  const StereoPair prev = view(scene, Eigen::Isometry3d::Identity());
  const StereoPair cur = view(scene, step());
  const auto usual = static_cast<double>(find(prev, cur, scene.camera()).size());
  for (const double rows : {-3.0, -1.5, 1.5, 3.0}) {
    CorrespondenceFinder finder({});
    Frames frames(
        finder, withRightLower(prev, rows), withRightLower(cur, rows), scene.camera(), rows);
    Correspondences features;
    finder.find(scene.camera(), frames.keyframe, *frames.current, step(), features);
    // Interpolated rows have less noise, those at the border are missing.
    EXPECT_GT(static_cast<double>(features.size()), 0.9 * usual);
    std::vector<double> disparity_errors_px;
    for (const Correspondence& feature : features) {
      const double depth_m = scene.pointAt(step(), feature.cur_px).z();
      disparity_errors_px.push_back(
          std::abs(feature.disparity_px - scene.camera().disparity(depth_m)));
    }
    EXPECT_LT(median(disparity_errors_px), 0.25) << "as without an offset";
  }
}

TEST(CorrespondenceFinderTest, WantsTrackedAndMatchedDisparityToAgree) {
  const SyntheticScene scene;
  const StereoPair prev = view(scene, Eigen::Isometry3d::Identity());
  const StereoPair cur = view(scene, step());
  CorrespondenceFinder finder({});
  const Frames frames(finder, prev, cur, scene.camera());
  // Tracked are the surroundings of another point of the right image than the one that is matched.
  const auto featuresWith = [&](float beside_px) {
    Keyframe keyframe = frames.keyframe;
    for (cv::Point2f& right : keyframe.right_px) right.x += beside_px;
    Correspondences features;
    finder.find(scene.camera(), keyframe, *frames.current, step(), features);
    return features.size();
  };
  const std::size_t all = featuresWith(0.0F);
  EXPECT_GT(featuresWith(0.5F), all * 8 / 10);
  EXPECT_LT(featuresWith(1.5F), all / 10);
}

TEST(CorrespondenceFinderTest, TracksNothingBehindTheCamera) {
  const SyntheticScene scene;
  CorrespondenceFinder finder({});
  const StereoPair pair = view(scene, Eigen::Isometry3d::Identity());
  const Frames frames(finder, pair, pair, scene.camera());
  Correspondences features(1);
  const Eigen::Isometry3d beyond = motion({0.0, 0.0, 200.0}, {0.0, 0.0, 0.0});
  EXPECT_EQ(finder.find(scene.camera(), frames.keyframe, *frames.current, beyond, features), 0);
  EXPECT_TRUE(features.empty());
}

/// The corners of `all` that have a disparity and come first.
std::vector<cv::Point2f> firstWithDisparity(const StereoPair& pair,
                                            const std::vector<cv::Point2f>& all,
                                            std::size_t most) {
  Workers workers(1);
  std::vector<float> disparities_px;
  StereoMatcher({}).match(workers, {pair.left, pair.right}, all, disparities_px);
  std::vector<cv::Point2f> found;
  for (std::size_t i = 0; i < all.size() && found.size() < most; ++i) {
    if (disparities_px[i] != StereoMatcher::kNoDisparity) found.push_back(all[i]);
  }
  return found;
}

TEST(CorrespondenceFinderTest, ReplacesCornersWithoutADepth) {
  const SyntheticScene scene;
  StereoPair pair = view(scene, Eigen::Isometry3d::Identity());
  pair.right.colRange(pair.right.cols / 2, pair.right.cols).setTo(128);
  CorrespondenceFinder::Config config;
  config.feature_detector.max_features = 150;
  CorrespondenceFinder finder(config);
  Keyframe keyframe;
  keyframe.frame = finder.makeFrame(pair);
  finder.findCorners(keyframe);
  const std::vector<cv::Point2f> all = keyframe.corners;
  finder.findDepths(scene.camera(), keyframe);
  EXPECT_EQ(keyframe.points.size(), 150u);
  EXPECT_EQ(keyframe.left_px, firstWithDisparity(pair, all, 150)) << "in the order of the corners";
  ASSERT_FALSE(keyframe.left_px.empty());
  EXPECT_EQ(keyframe.corners.back(), keyframe.left_px.back()) << "no more than needed are tried";
  // Measured: 301 of 566.
  EXPECT_LT(keyframe.corners.size(), all.size());
  EXPECT_TRUE(std::equal(keyframe.corners.begin(), keyframe.corners.end(), all.begin()));
}

TEST(CorrespondenceFinderTest, TriesAllCornersIfFewHaveADepth) {
  const SyntheticScene scene;
  const StereoPair usual = view(scene, Eigen::Isometry3d::Identity());
  for (const int columns : {0, 60}) {  // that are left of the right image
    StereoPair pair = usual;
    pair.right = usual.right.clone();
    pair.right.colRange(columns, pair.right.cols).setTo(128);
    CorrespondenceFinder finder({});
    Keyframe keyframe;
    keyframe.frame = finder.makeFrame(pair);
    finder.findCorners(keyframe);
    const std::vector<cv::Point2f> all = keyframe.corners;
    finder.findDepths(scene.camera(), keyframe);
    EXPECT_EQ(keyframe.corners, all);
    EXPECT_EQ(keyframe.left_px, firstWithDisparity(pair, all, 500));
    EXPECT_EQ(keyframe.left_px.empty(), columns == 0);
  }
}

TEST(CorrespondenceFinderTest, ShiftIsHowFarTheFeaturesMoveInTheImage) {
  const SyntheticScene scene;
  const StereoCamera& camera = scene.camera();
  CorrespondenceFinder finder({});
  const Eigen::Isometry3d none = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d yaw = motion({0.0, 0.0, 0.0}, {0.0, 0.01, 0.0});
  EXPECT_EQ(finder.medianShift(camera, {}, none, yaw), 0.0);  // there are no points
  const Frames frames(finder, view(scene, none), view(scene, none), camera);
  EXPECT_EQ(finder.medianShift(camera, frames.keyframe, yaw, yaw), 0.0);
  // Yaw shifts the middle of the image by f times the angle, 3.6 px, and its sides by up to 1.7
  // times as much.
  EXPECT_GT(finder.medianShift(camera, frames.keyframe, none, yaw), 3.6);
  EXPECT_LT(finder.medianShift(camera, frames.keyframe, none, yaw), 6.2);
}

TEST(CorrespondenceFinderTest, ScalesWindowsUnlessToldNotTo) {
  const SyntheticScene scene;
  const Eigen::Isometry3d far_step = motion({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0});
  const StereoPair prev = view(scene, Eigen::Isometry3d::Identity());
  const StereoPair cur = view(scene, far_step);
  const auto medianError = [&](bool scale_windows) {
    CorrespondenceFinder::Config config;
    config.feature_tracker.scale_windows = scale_windows;
    CorrespondenceFinder finder(config);
    const Frames frames(finder, prev, cur, scene.camera());
    Correspondences features;
    finder.find(scene.camera(), frames.keyframe, *frames.current, far_step, features);
    std::vector<double> errors_px;
    for (const Correspondence& feature : features) {
      const Eigen::Vector3d point_cur = scene.pointAt(far_step, feature.cur_px);
      errors_px.push_back(
          (scene.camera().project(far_step * point_cur) - feature.keyframe_px).norm());
    }
    return median(errors_px);
  };
  EXPECT_LT(1.2 * medianError(true), medianError(false));
}

}  // namespace
}  // namespace rotrocc
