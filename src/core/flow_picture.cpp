#include "rotrocc/flow_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

namespace rotrocc {
namespace {

// Colours (BGR) of Okabe and Ito, "Color universal design" (2002), which are as good as any on
// grey.
const cv::Scalar kNear(0, 159, 230);
const cv::Scalar kFar(233, 180, 86);
const cv::Scalar kRotationOnly(255, 255, 255);
const cv::Scalar kOutlier(185, 60, 220);
const cv::Scalar kText(230, 230, 230);
const cv::Scalar kBand(35, 30, 30);

constexpr double kBrightness = 0.65;
constexpr double kNear_m = 5.0;
constexpr double kFar_m = 50.0;
constexpr int kBand_px = 24;
constexpr int kSubpixelBits = 4;

/// Between near and far the colour goes with the logarithm of the depth.
cv::Scalar colourOfDepth(double depth_m) {
  const double share = std::log(depth_m / kNear_m) / std::log(kFar_m / kNear_m);
  const double far = std::min(std::max(share, 0.0), 1.0);
  return kNear * (1.0 - far) + kFar * far;
}

cv::Point toSubpixel(const Eigen::Vector2d& pixel) {
  constexpr double kScale = 1 << kSubpixelBits;
  return {cvRound(kScale * pixel.x()), cvRound(kScale * pixel.y())};
}

void drawFlow(const Correspondence& feature, const cv::Scalar& colour, cv::Mat& image) {
  const cv::Point cur = toSubpixel(feature.cur_px);
  cv::line(image, toSubpixel(feature.prev_px), cur, colour, 1, cv::LINE_AA, kSubpixelBits);
  cv::circle(image, cur, 1 << (kSubpixelBits + 1), colour, cv::FILLED, cv::LINE_AA, kSubpixelBits);
}

/// Writes words and colours from left to right, as far as there is room.
class Legend {
 public:
  explicit Legend(cv::Mat band) : band_(std::move(band)) { band_.setTo(kBand); }

  void text(const std::string& words) {
    int baseline = 0;
    const int width = cv::getTextSize(words, kFont, kFontScale, 1, &baseline).width;
    if (!reserve(width)) return;
    cv::putText(band_, words, {x_, kBand_px - 8}, kFont, kFontScale, kText, 1, cv::LINE_AA);
    x_ += width + kGap_px;
  }

  void sample(const cv::Scalar& colour, const std::string& words) {
    if (!reserve(kSample_px)) return;
    const int y = kBand_px / 2;
    cv::line(band_, {x_, y}, {x_ + kSample_px, y}, colour, 2, cv::LINE_AA);
    cv::circle(band_, {x_ + kSample_px, y}, 3, colour, cv::FILLED, cv::LINE_AA);
    x_ += kSample_px + kGap_px;
    text(words);
  }

  void depthScale() {
    text(format("%.0f m", kNear_m));
    if (!reserve(kScale_px)) return;
    for (int i = 0; i < kScale_px; ++i) {
      const double depth_m = kNear_m * std::pow(kFar_m / kNear_m, i / (kScale_px - 1.0));
      cv::line(band_, {x_ + i, 8}, {x_ + i, kBand_px - 9}, colourOfDepth(depth_m));
    }
    x_ += kScale_px + kGap_px;
    text(format("%.0f m", kFar_m));
  }

  template <class... Values>
  static std::string format(const char* pattern, Values... values) {
    char text[128];
    std::snprintf(text, sizeof(text), pattern, values...);
    return text;
  }

  void space() { x_ += 2 * kGap_px; }

 private:
  static constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  static constexpr double kFontScale = 0.42;
  static constexpr int kGap_px = 8;
  static constexpr int kSample_px = 18;
  static constexpr int kScale_px = 80;

  /// Once there is no room for something, there is none for what follows.
  bool reserve(int width) {
    if (x_ + width > band_.cols) x_ = band_.cols;
    return x_ < band_.cols;
  }

  cv::Mat band_;
  int x_ = kGap_px;
};

void requireFlags(const FeatureSet& set, const Correspondences& features) {
  if (set.empty() || set.size() == features.size()) return;
  throw std::invalid_argument("there are " + std::to_string(features.size()) + " features, but " +
                              std::to_string(set.size()) + " inlier flags");
}

bool contains(const FeatureSet& set, std::size_t i) {
  return !set.empty() && set[i] != 0;
}

void drawLegend(const OdometryResult& result, std::size_t features, cv::Mat band) {
  Legend legend(std::move(band));
  legend.text(toString(result.state));
  if (result.hasMotion()) {
    const double speed_mps = result.T_prev_cur.translation().norm() / result.dt_s;
    legend.text(Legend::format("%.1f m/s", speed_mps));
  }
  legend.space();
  legend.depthScale();
  legend.space();
  legend.sample(kRotationOnly, "rotation only");
  legend.space();
  legend.sample(kOutlier, "outlier");
  legend.space();
  legend.text(Legend::format("%zu features, %d fit the rotation, %d the translation",
                             features,
                             result.counts.rotation_inliers,
                             result.counts.translation_inliers));
}

}  // namespace

void drawFlowPicture(const cv::Mat& left,
                     const Correspondences& features,
                     const FeatureSet& rotation_inliers,
                     const FeatureSet& translation_inliers,
                     const OdometryResult& result,
                     cv::Mat& picture) {
  if (left.empty() || left.type() != CV_8UC1) {
    throw std::invalid_argument(
        "a flow picture needs an 8-bit grey image, not one of OpenCV type " +
        std::to_string(left.type()));
  }
  requireFlags(rotation_inliers, features);
  requireFlags(translation_inliers, features);
  picture.create(left.rows + kBand_px, left.cols, CV_8UC3);
  cv::Mat image = picture.rowRange(0, left.rows);
  cv::cvtColor(left, image, cv::COLOR_GRAY2BGR);
  image *= kBrightness;

  // The few outliers would hide under the many inliers, so they come last.
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (contains(translation_inliers, i)) {
      drawFlow(features[i], colourOfDepth(features[i].point_cur.z()), image);
    }
  }
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (contains(translation_inliers, i)) continue;
    drawFlow(features[i], contains(rotation_inliers, i) ? kRotationOnly : kOutlier, image);
  }
  drawLegend(result, features.size(), picture.rowRange(left.rows, picture.rows));
}

}  // namespace rotrocc
