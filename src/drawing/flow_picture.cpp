#include "rotrocc/flow_picture.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "drawing/okabe_ito.h"

namespace rotrocc {
namespace {

const cv::Scalar kNearColor = okabe_ito::kOrange;
const cv::Scalar kFarColor = okabe_ito::kSkyBlue;
constexpr double kNear_m = 5.0;
constexpr double kFar_m = 50.0;

const cv::Scalar kRotationOnly(255, 255, 255);
const cv::Scalar kOutlier(185, 60, 220);
const cv::Scalar kExpected = okabe_ito::kGreen;
const cv::Scalar kMasked(0, 30, 90);  // is added

constexpr double kBrightness = 0.65;
constexpr int kSubpixelBits = 4;

/// Smallest visible error of the flow [px].
constexpr double kVisible_px = 2.0;
/// Far outside any image; lines to points farther out might overflow.
constexpr double kFarOutside_px = 1e5;

cv::Point toSubpixel(const Eigen::Vector2d& pixel) {
  constexpr double kScale = 1 << kSubpixelBits;
  const auto clamped = [](double x) { return std::clamp(x, -kFarOutside_px, kFarOutside_px); };
  return {cvRound(kScale * clamped(pixel.x())), cvRound(kScale * clamped(pixel.y()))};
}

void drawLine(const Eigen::Vector2d& from_px,
              const Eigen::Vector2d& to_px,
              const cv::Scalar& color,
              cv::Mat& image) {
  cv::line(image, toSubpixel(from_px), toSubpixel(to_px), color, 1, cv::LINE_AA, kSubpixelBits);
}

/// A line to the present pixel of a feature, with a dot there.
void drawFlow(const Correspondence& feature, const cv::Scalar& color, cv::Mat& image) {
  const int radius = 1 << (kSubpixelBits + 1);
  drawLine(feature.keyframe_px, feature.cur_px, color, image);
  cv::circle(
      image, toSubpixel(feature.cur_px), radius, color, cv::FILLED, cv::LINE_AA, kSubpixelBits);
}

/// Color (BGR) by the logarithm of the depth, from near (orange) to far (blue).
cv::Scalar colorOfDepth(double depth_m) {
  const double share = std::log(depth_m / kNear_m) / std::log(kFar_m / kNear_m);
  const double far = std::clamp(share, 0.0, 1.0);
  return kNearColor * (1.0 - far) + kFarColor * far;
}

/// The text line below a flow picture: labels and colors from left to right.
class Legend {
 public:
  static constexpr int kHeight_px = 24;

  /// Draws into `band`, CV_8UC3 and kHeight_px high, on a dark background.
  explicit Legend(cv::Mat band) : band_(std::move(band)) { band_.setTo(cv::Scalar(35, 30, 30)); }

  void text(const std::string& words) {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
    constexpr double kFontScale = 0.42;
    const cv::Scalar color(230, 230, 230);
    int baseline = 0;
    const int width = cv::getTextSize(words, kFont, kFontScale, 1, &baseline).width;
    cv::putText(band_, words, {x_, kHeight_px - 8}, kFont, kFontScale, color, 1, cv::LINE_AA);
    x_ += width + kGap_px;
  }

  /// A sample of a flow line with its dot and label.
  void sample(const cv::Scalar& color, const std::string& words) {
    constexpr int kSample_px = 18;
    const int y = kHeight_px / 2;
    cv::line(band_, {x_, y}, {x_ + kSample_px, y}, color, 2, cv::LINE_AA);
    cv::circle(band_, {x_ + kSample_px, y}, 3, color, cv::FILLED, cv::LINE_AA);
    x_ += kSample_px + kGap_px;
    text(words);
    space();
  }

  /// The color scale of depths.
  void depthScale() {
    constexpr int kScale_px = 80;
    text(cv::format("%.0f m", kNear_m));
    for (int i = 0; i < kScale_px; ++i) {
      const double depth_m = kNear_m * std::pow(kFar_m / kNear_m, i / (kScale_px - 1.0));
      cv::line(band_, {x_ + i, 8}, {x_ + i, kHeight_px - 9}, colorOfDepth(depth_m));
    }
    x_ += kScale_px + kGap_px;
    text(cv::format("%.0f m", kFar_m));
    space();
  }

  /// A wider gap between groups.
  void space() { x_ += 2 * kGap_px; }

 private:
  static constexpr int kGap_px = 8;

  cv::Mat band_;
  int x_ = kGap_px;
};

void drawLegend(const FlowScene& scene, Legend legend) {
  legend.text(toString(scene.result.state));
  if (scene.result.hasMotion()) {
    const double speed_mps = scene.result.T_prev_cur.translation().norm() / scene.result.dt_s();
    legend.text(cv::format("%.1f m/s", speed_mps));
  }
  legend.space();
  legend.depthScale();
  legend.sample(kRotationOnly, "rotation only");
  legend.sample(kOutlier, "outlier");
  legend.sample(kExpected, "as expected");
  const StageCounts& counts = scene.result.counts;
  const std::string features = cv::format("%zu features, ", scene.features.size());
  const bool had_stage_2 = counts.translation_inliers > 0;
  legend.text(features + (had_stage_2 ? cv::format("%d fit the rotation, %d the translation",
                                                   counts.rotation_inliers,
                                                   counts.translation_inliers)
                                      : cv::format("%d fit", counts.rotation_inliers)));
  legend.space();
  legend.text(cv::format("bias %+.2f px", scene.result.disparity_bias.applied_px));
}

void drawMotion(const FlowScene& scene, cv::Mat& image) {
  const Correspondences& features = scene.features;
  // Outliers are few; draw them last, on top of the inliers.
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (scene.translation_inliers[i] == 0) continue;
    drawFlow(features[i], colorOfDepth(features[i].point_cur.z()), image);
  }
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (scene.translation_inliers[i] != 0) continue;
    const Eigen::Vector3d moved = scene.result.T_keyframe_cur.T * features[i].point_cur;
    if (scene.result.hasMotion() && moved.z() > 0.0) {
      const Eigen::Vector2d expected_px = scene.camera.project(moved);
      if ((expected_px - features[i].keyframe_px).norm() > kVisible_px) {
        drawLine(expected_px, features[i].cur_px, kExpected, image);
      }
    }
    const bool fits_rotation = scene.rotation_inliers[i] != 0;
    drawFlow(features[i], fits_rotation ? kRotationOnly : kOutlier, image);
  }
}

}  // namespace

void drawFlowPicture(const FlowScene& scene, cv::Mat& picture) {
  const cv::Mat& left = scene.pair.left;
  const cv::Mat& mask = scene.pair.left_mask;
  CV_Assert(left.type() == CV_8UC1);
  CV_Assert(scene.rotation_inliers.size() == scene.features.size());
  CV_Assert(scene.translation_inliers.size() == scene.features.size());
  picture.create(left.rows + Legend::kHeight_px, left.cols, CV_8UC3);
  cv::Mat image = picture.rowRange(0, left.rows);
  cv::cvtColor(left, image, cv::COLOR_GRAY2BGR);
  image *= kBrightness;
  if (!mask.empty()) cv::add(image, kMasked, image, mask);
  drawMotion(scene, image);
  drawLegend(scene, Legend(picture.rowRange(left.rows, picture.rows)));
}

}  // namespace rotrocc
