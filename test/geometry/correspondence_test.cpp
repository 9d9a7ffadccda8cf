#include "rotrocc/correspondence.h"

#include <gtest/gtest.h>

#include "simulation/kitti_camera.h"

namespace rotrocc {
namespace {

Correspondence withDisparity(double disparity_px) {
  Correspondence feature;
  feature.cur_px = {700.0, 200.0};
  feature.disparity_px = disparity_px;
  return feature;
}

TEST(CorrespondenceTest, TriangulatesAndDropsWhatIsAtOrBeyondInfinity) {
  // As after a change of the disparity bias: some disparities are no longer above that of infinity.
  StereoCamera camera = kittiCamera();
  camera.cx_right -= 3.0;
  ASSERT_NEAR(camera.disparityAtInfinity(), 3.0, 1e-9);
  Correspondences features = {
      withDisparity(2.0), withDisparity(40.0), withDisparity(camera.disparityAtInfinity())};
  triangulate(camera, features);
  ASSERT_EQ(features.size(), 1u);
  const Eigen::Vector3d& point = features.front().point_cur;
  EXPECT_NEAR(camera.disparity(point.z()), 40.0, 1e-9);
  EXPECT_LT((camera.project(point) - features.front().cur_px).norm(), 1e-9);
}

}  // namespace
}  // namespace rotrocc
