#include "features/correspondence_finder.h"

#include <algorithm>
#include <cmath>
#include <utility>
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

const SyntheticScene& scene() {
  static const SyntheticScene scene;
  return scene;
}

/// Views of the scene before and after step().
const StereoPair& before() {
  static const StereoPair pair = view(scene(), Eigen::Isometry3d::Identity());
  return pair;
}

const StereoPair& after() {
  static const StereoPair pair = view(scene(), step());
  return pair;
}

Keyframe makeKeyframe(CorrespondenceFinder& finder,
                      const StereoPair& pair,
                      const StereoCamera& camera) {
  Keyframe keyframe;
  keyframe.frame = finder.makeFrame(pair);
  finder.findCorners(keyframe);
  finder.findDepths(camera, FeatureDetectorConfig().max_features, keyframe);
  return keyframe;
}

/// All stages from two pairs to the feature set. The prediction is the true motion.
Correspondences find(const StereoPair& prev,
                     const StereoPair& cur,
                     const StereoCamera& camera,
                     const Eigen::Isometry3d& T_prev_cur = step(),
                     const CorrespondenceFinder::Config& config = {}) {
  CorrespondenceFinder finder(config);
  const Keyframe keyframe = makeKeyframe(finder, prev, camera);
  Correspondences features;
  finder.find(camera, keyframe, *finder.makeFrame(cur), T_prev_cur, features);
  return features;
}

double medianFlowError(const SyntheticScene& scene,
                       const Correspondences& features,
                       const Eigen::Isometry3d& T_prev_cur) {
  std::vector<double> errors_px;
  for (const Correspondence& feature : features) {
    const Eigen::Vector3d point_cur = scene.pointAt(T_prev_cur, feature.cur_px);
    errors_px.push_back(
        (scene.camera().project(T_prev_cur * point_cur) - feature.keyframe_px).norm());
  }
  return median(errors_px);
}

TEST(CorrespondenceFinderTest, FindsPointsOfTheSceneInBothPairs) {
  StereoCamera verged = SyntheticScene::defaultCamera();
  verged.cx_right += 12.0;  // far points have negative disparities
  for (const StereoCamera& camera : {SyntheticScene::defaultCamera(), verged}) {
    const SyntheticScene scene(camera);
    const Correspondences features =
        find(view(scene, Eigen::Isometry3d::Identity()), view(scene, step()), camera);
    ASSERT_GT(features.size(), 300u);
    std::vector<double> disparity_errors_px;
    for (const Correspondence& feature : features) {
      const double depth_m = scene.pointAt(step(), feature.cur_px).z();
      disparity_errors_px.push_back(std::abs(feature.disparity_px - camera.disparity(depth_m)));
      EXPECT_LT((camera.project(feature.point_cur) - feature.cur_px).norm(), 1e-9);
      EXPECT_NEAR(camera.disparity(feature.point_cur.z()), feature.disparity_px, 1e-9);
    }
    // The measured accuracy of the tracker and the matcher alone.
    EXPECT_LT(medianFlowError(scene, features, step()), 0.25);
    EXPECT_LT(median(disparity_errors_px), 0.25);
  }
}

/// The right image shifts down between the pairs.
TEST(CorrespondenceFinderTest, WantsLeftAndRightOnOneRow) {
  const auto countWithRightLower = [](double rows) {
    StereoPair cur = after();
    SyntheticScene::lowerRight(cur, rows);
    return find(before(), cur, scene().camera()).size();
  };
  const auto good = find(before(), after(), scene().camera()).size();
  EXPECT_GT(countWithRightLower(0.5), good / 2);
  EXPECT_LT(countWithRightLower(2.0), good / 10);
}

TEST(CorrespondenceFinderTest, WantsTrackedAndMatchedDisparityToAgree) {
  CorrespondenceFinder finder({});
  const Keyframe usual = makeKeyframe(finder, before(), scene().camera());
  const FramePtr current = finder.makeFrame(after());
  // Tracked are the surroundings of another point of the right image than the one that is matched.
  const auto featuresWith = [&](float beside_px) {
    Keyframe keyframe = usual;
    for (cv::Point2f& right : keyframe.right_px) right.x += beside_px;
    Correspondences features;
    finder.find(scene().camera(), keyframe, *current, step(), features);
    return features.size();
  };
  const std::size_t all = featuresWith(0.0F);
  EXPECT_GT(featuresWith(0.5F), all * 8 / 10);
  EXPECT_LT(featuresWith(1.5F), all / 10);
}

TEST(CorrespondenceFinderTest, TracksNothingBehindTheCamera) {
  const Eigen::Isometry3d beyond = motion({0.0, 0.0, 200.0}, {0.0, 0.0, 0.0});
  EXPECT_TRUE(find(before(), before(), scene().camera(), beyond).empty());
}

/// The corners of `all` that have a disparity and come first.
std::vector<cv::Point2f> firstWithDisparity(const StereoPair& pair,
                                            const std::vector<cv::Point2f>& all,
                                            std::size_t most) {
  const StereoCamera camera = scene().camera();
  const RectifiedImages images = {pair.left, pair.right, camera};
  std::vector<cv::Point2f> found;
  for (std::size_t i = 0; i < all.size() && found.size() < most; ++i) {
    if (StereoMatcher({}).match(images, all[i])) found.push_back(all[i]);
  }
  return found;
}

TEST(CorrespondenceFinderTest, ReplacesCornersWithoutADepth) {
  // The columns that are left of the right image, and how many features are wanted.
  for (const auto& [columns, wanted] : {std::pair(310, 150), {60, 500}, {0, 500}}) {
    StereoPair pair = before();
    pair.right = pair.right.clone();
    pair.right.colRange(columns, pair.right.cols).setTo(128);
    CorrespondenceFinder::Config config;
    config.feature_detector.max_features = wanted;
    CorrespondenceFinder finder(config);
    Keyframe keyframe;
    keyframe.frame = finder.makeFrame(pair);
    finder.findCorners(keyframe);
    const std::vector<cv::Point2f> all = keyframe.corners;
    finder.findDepths(scene().camera(), wanted, keyframe);
    const auto expected = firstWithDisparity(pair, all, static_cast<std::size_t>(wanted));
    EXPECT_EQ(keyframe.left_px, expected) << "in the order of the corners";
    EXPECT_EQ(keyframe.points.size(), expected.size());
    EXPECT_EQ(expected.empty(), columns == 0);
    const bool is_enough = static_cast<int>(expected.size()) == wanted;
    EXPECT_EQ(is_enough, columns == 310);
    if (!is_enough) {
      EXPECT_EQ(keyframe.corners, all) << "all are tried";
      continue;
    }
    EXPECT_EQ(keyframe.corners.back(), keyframe.left_px.back()) << "no more than needed are tried";
    // Measured: 301 of 566.
    EXPECT_LT(keyframe.corners.size(), all.size());
    EXPECT_TRUE(std::equal(keyframe.corners.begin(), keyframe.corners.end(), all.begin()));
  }
}

TEST(CorrespondenceFinderTest, ShiftIsHowFarTheFeaturesMoveInTheImage) {
  CorrespondenceFinder finder({});
  const Keyframe keyframe = makeKeyframe(finder, before(), scene().camera());
  const auto shift = [&](const Keyframe& keyframe, double from_rad, double to_rad) {
    return finder.medianShift(scene().camera(),
                              keyframe,
                              motion({0.0, 0.0, 0.0}, {0.0, from_rad, 0.0}),
                              motion({0.0, 0.0, 0.0}, {0.0, to_rad, 0.0}));
  };
  EXPECT_EQ(shift({}, 0.0, 0.01), 0.0);  // there are no points
  EXPECT_EQ(shift(keyframe, 0.01, 0.01), 0.0);
  // Yaw shifts the middle of the image by f times the angle, 3.6 px, and its sides by up to 1.7
  // times as much.
  EXPECT_GT(shift(keyframe, 0.0, 0.01), 3.6);
  EXPECT_LT(shift(keyframe, 0.0, 0.01), 6.2);
}

TEST(CorrespondenceFinderTest, ScalesWindows) {
  const Eigen::Isometry3d far_step = motion({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0});
  const StereoPair cur = view(scene(), far_step);
  const auto features = find(before(), cur, scene().camera(), far_step);
  EXPECT_LT(medianFlowError(scene(), features, far_step), 0.26);  // without, above 0.28
}

}  // namespace
}  // namespace rotrocc
