#include "features/keyframe.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

Keyframe withPoints(int points) {
  Keyframe keyframe;
  keyframe.row_offset_px = 0.5;
  for (int i = 0; i < points; ++i) {
    keyframe.left_px.emplace_back(i, 1.0F);
    keyframe.right_px.emplace_back(i, 2.0F);
    keyframe.points.emplace_back(i, 3.0, 4.0);
  }
  return keyframe;
}

TEST(KeyframeTest, ChoosesPointsEvenly) {
  Keyframe few = withPoints(7);  // what was there is replaced
  thinOut(withPoints(1000), 200, few);
  ASSERT_EQ(few.points.size(), 200u);
  ASSERT_EQ(few.left_px.size(), 200u);
  ASSERT_EQ(few.right_px.size(), 200u);
  EXPECT_EQ(few.row_offset_px, 0.5);
  for (std::size_t i = 0; i < few.points.size(); ++i) {
    EXPECT_EQ(few.points[i].x(), 5.0 * static_cast<double>(i));
    EXPECT_EQ(few.left_px[i].x, few.points[i].x()) << "of the same point";
    EXPECT_EQ(few.right_px[i].x, few.points[i].x());
  }
}

TEST(KeyframeTest, KeepsAllPointsIfThereAreFew) {
  Keyframe few;
  thinOut(withPoints(3), 200, few);
  EXPECT_EQ(few.points.size(), 3u);
  thinOut(withPoints(0), 200, few);
  EXPECT_EQ(few.points.size(), 0u);
}

}  // namespace
}  // namespace rotrocc
