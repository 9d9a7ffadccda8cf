#include "features/row_search.h"

#include <vector>

#include <gtest/gtest.h>

#include "common/median.h"
#include "features/correspondence_finder.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

/// A pair whose right image is moved down.
StereoPair withRightLower(const SyntheticScene& scene, double rows) {
  StereoPair pair = scene.render(Eigen::Isometry3d::Identity(), 0);
  SyntheticScene::addNoise(pair, 1.5, 1);
  SyntheticScene::lowerRight(pair, rows);
  return pair;
}

class RowSearchTest : public ::testing::TestWithParam<double> {
 protected:
  /// The noise of the tracker is 0.3 px, that of the median of 20 features a quarter of it.
  void expectOffset(std::vector<float> offsets_px) const {
    ASSERT_GT(offsets_px.size(), 20u);
    EXPECT_NEAR(median(offsets_px), GetParam(), 0.2);
  }

  SyntheticScene scene_;
  CorrespondenceFinder finder_{{}};
  FramePtr frame_ = finder_.makeFrame(withRightLower(scene_, GetParam()));
  RowSearch search_{{}};
  std::vector<float> offsets_px_;
};

TEST_P(RowSearchTest, FindsAnUnknownOffset) {
  Keyframe keyframe;
  keyframe.frame = frame_;
  finder_.findCorners(keyframe);
  search_.search(scene_.camera(), keyframe, offsets_px_);
  expectOffset(offsets_px_);
}

TEST_P(RowSearchTest, MeasuresAnOffsetThatIsRoughlyKnown) {
  Keyframe keyframe;
  keyframe.frame = frame_;
  keyframe.row_offset_px = GetParam();
  finder_.findCorners(keyframe);
  finder_.findDepths(scene_.camera(), keyframe);
  Correspondences features;
  finder_.find(scene_.camera(), keyframe, *frame_, Eigen::Isometry3d::Identity(), features);
  const FeatureSet all(features.size(), 1);
  for (const double error_px : {-0.5, 0.5}) {
    RowOffsets offsets;
    search_.measure(*frame_, features, all, GetParam() + error_px, offsets);
    EXPECT_EQ(offsets.features.size(), offsets.offsets_px.size());
    expectOffset(offsets.offsets_px);
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, RowSearchTest, ::testing::Values(-2.75, -1.5, 0.0, 0.5, 1.5, 3.0));

}  // namespace
}  // namespace rotrocc
