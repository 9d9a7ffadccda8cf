#include "rotrocc/flow_picture.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "simulation/kitti_camera.h"
#include "support/expect_error.h"

namespace rotrocc {
namespace {

class FlowPictureTest : public testing::Test {
 protected:
  FlowPictureTest() {
    addFeature({100, 50}, {130, 50}, 5.0);
    addFeature({100, 100}, {130, 100}, 50.0);
    addFeature({100, 150}, {130, 150}, 20.0);
    addFeature({100, 180}, {130, 180}, 20.0);
    result_.state = State::kOk;
    result_.stamp_ns = 100'000'000;
  }

  void addFeature(const Eigen::Vector2d& keyframe_px,
                  const Eigen::Vector2d& cur_px,
                  double depth_m) {
    Correspondence feature;
    feature.keyframe_px = keyframe_px;
    feature.cur_px = cur_px;
    feature.point_cur = {0.0, 0.0, depth_m};
    features_.push_back(feature);
  }

  void draw() {
    drawFlowPicture({pair_, camera_, features_, rotation_inliers_, translation_inliers_, result_},
                    picture_);
  }

  cv::Vec3b colorAt(int x, int y) const { return picture_.at<cv::Vec3b>(y, x); }

  const StereoCamera camera_ = kittiCamera();
  StereoPair pair_ = {0, cv::Mat(200, 640, CV_8UC1, cv::Scalar(100)), {}};
  Correspondences features_;
  FeatureSet rotation_inliers_ = {1, 1, 1, 0};
  FeatureSet translation_inliers_ = {1, 1, 0, 0};
  OdometryResult result_;
  cv::Mat picture_;
};

TEST_F(FlowPictureTest, IsTheDarkenedImageWithALineBelow) {
  draw();
  EXPECT_EQ(picture_.type(), CV_8UC3);
  EXPECT_EQ(picture_.cols, 640);
  EXPECT_GT(picture_.rows, 200);
  EXPECT_LT(picture_.rows, 240);
  EXPECT_EQ(colorAt(300, 100), cv::Vec3b(65, 65, 65));
  const unsigned char* memory = picture_.data;
  draw();
  EXPECT_EQ(picture_.data, memory) << "memory is used again";
}

TEST_F(FlowPictureTest, TintsWhatIsMasked) {
  pair_.left_mask = cv::Mat(pair_.left.size(), CV_8UC1, cv::Scalar(0));
  pair_.left_mask.colRange(300, 640).setTo(1);
  draw();
  EXPECT_EQ(colorAt(299, 100), cv::Vec3b(65, 65, 65));
  EXPECT_EQ(colorAt(300, 100), cv::Vec3b(65, 95, 155));
}

TEST_F(FlowPictureTest, ColorsTellDepthAndStage) {
  draw();
  // The dot at the current position.
  EXPECT_EQ(colorAt(130, 50), cv::Vec3b(0, 159, 230)) << "near: orange";
  EXPECT_EQ(colorAt(130, 100), cv::Vec3b(233, 180, 86)) << "far: blue";
  EXPECT_EQ(colorAt(130, 150), cv::Vec3b(255, 255, 255)) << "rotation alone: white";
  const cv::Vec3b outlier = colorAt(130, 180);
  EXPECT_GT(outlier[2], outlier[1]) << "magenta";
  EXPECT_GT(outlier[0], outlier[1]) << "magenta";
}

TEST_F(FlowPictureTest, TextSaysTheState) {
  draw();
  const cv::Mat ok = picture_.clone();
  result_.state = State::kDegraded;
  draw();
  const cv::Rect image({0, 0}, pair_.left.size());
  EXPECT_EQ(cv::norm(ok(image), picture_(image), cv::NORM_INF), 0.0);
  const cv::Rect text(0, pair_.left.rows, 100, picture_.rows - pair_.left.rows);
  EXPECT_GT(cv::norm(ok(text), picture_(text), cv::NORM_INF), 100.0);
}

TEST_F(FlowPictureTest, WithoutEstimateAllAreOutliers) {
  rotation_inliers_.assign(features_.size(), 0);
  translation_inliers_ = rotation_inliers_;
  draw();
  EXPECT_EQ(colorAt(130, 50), colorAt(130, 180));
}

TEST_F(FlowPictureTest, AnyFlowAndSmallImagesAreDrawn) {
  pair_.left = cv::Mat(20, 30, CV_8UC1, cv::Scalar(100));
  addFeature({-500, 7000}, {1e5, -1e5}, 1e-3);
  rotation_inliers_.push_back(1);
  translation_inliers_.push_back(1);
  draw();
  EXPECT_EQ(picture_.cols, 30);
}

TEST_F(FlowPictureTest, AnOutlierShowsWhatFlowTheMotionExpected) {
  // Without motion, a static point keeps its position, which is 40 px from where this one came
  // from.
  result_.T_keyframe_cur.T = Eigen::Isometry3d::Identity();
  features_[3].cur_px = {300, 150};
  features_[3].keyframe_px = {260, 150};
  features_[3].point_cur = 20.0 * camera_.ray({340, 150});
  draw();
  const cv::Vec3b expected = colorAt(320, 150);
  EXPECT_GT(expected[1], expected[0]) << "green";
  EXPECT_GT(expected[1], expected[2]) << "green";
  result_.state = State::kLost;
  draw();
  EXPECT_EQ(colorAt(320, 150), cv::Vec3b(65, 65, 65)) << "without a motion nothing is expected";
}

TEST_F(FlowPictureTest, RejectsWhatDoesNotFit) {
  rotation_inliers_.pop_back();
  EXPECT_THROW(draw(), cv::Exception);
  rotation_inliers_.push_back(0);
  pair_.left = cv::Mat();
  EXPECT_THROW(draw(), cv::Exception);
}

}  // namespace
}  // namespace rotrocc
