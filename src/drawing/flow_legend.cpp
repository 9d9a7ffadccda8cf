#include "drawing/flow_legend.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "drawing/okabe_ito.h"

namespace rotrocc {
namespace {

const cv::Scalar kNear = okabe_ito::kOrange;
const cv::Scalar kFar = okabe_ito::kSkyBlue;
const cv::Scalar kText(230, 230, 230);
const cv::Scalar kBand(35, 30, 30);

constexpr double kNear_m = 5.0;
constexpr double kFar_m = 50.0;

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.42;
constexpr int kSample_px = 18;
constexpr int kScale_px = 80;

}  // namespace

FlowLegend::FlowLegend(cv::Mat band) : band_(std::move(band)) {
  band_.setTo(kBand);
}

void FlowLegend::text(const std::string& words) {
  int baseline = 0;
  const int width = cv::getTextSize(words, kFont, kFontScale, 1, &baseline).width;
  if (!reserve(width)) return;
  cv::putText(band_, words, {x_, kHeight_px - 8}, kFont, kFontScale, kText, 1, cv::LINE_AA);
  x_ += width + kGap_px;
}

void FlowLegend::sample(const cv::Scalar& colour, const std::string& words) {
  if (!reserve(kSample_px)) return;
  const int y = kHeight_px / 2;
  cv::line(band_, {x_, y}, {x_ + kSample_px, y}, colour, 2, cv::LINE_AA);
  cv::circle(band_, {x_ + kSample_px, y}, 3, colour, cv::FILLED, cv::LINE_AA);
  x_ += kSample_px + kGap_px;
  text(words);
}

void FlowLegend::depthScale() {
  text(format("%.0f m", kNear_m));
  if (!reserve(kScale_px)) return;
  for (int i = 0; i < kScale_px; ++i) {
    const double depth_m = kNear_m * std::pow(kFar_m / kNear_m, i / (kScale_px - 1.0));
    cv::line(band_, {x_ + i, 8}, {x_ + i, kHeight_px - 9}, colourOfDepth(depth_m));
  }
  x_ += kScale_px + kGap_px;
  text(format("%.0f m", kFar_m));
}

cv::Scalar FlowLegend::colourOfDepth(double depth_m) {
  const double share = std::log(depth_m / kNear_m) / std::log(kFar_m / kNear_m);
  const double far = std::min(std::max(share, 0.0), 1.0);
  return kNear * (1.0 - far) + kFar * far;
}

/// Once an element does not fit, the following ones are omitted.
bool FlowLegend::reserve(int width_px) {
  if (x_ + width_px > band_.cols) x_ = band_.cols;
  return x_ < band_.cols;
}

}  // namespace rotrocc
