#pragma once

#include <cstdio>
#include <string>

#include <opencv2/core.hpp>

namespace rotrocc {

/// The text line below a flow picture: labels and colours from left to right, as far as they fit.
class FlowLegend {
 public:
  static constexpr int kHeight_px = 24;

  /// Draws into `band`, CV_8UC3 and kHeight_px high, on a dark background.
  explicit FlowLegend(cv::Mat band);

  void text(const std::string& words);

  /// A sample of a flow line with its dot and label.
  void sample(const cv::Scalar& colour, const std::string& words);

  /// The colour scale of depths.
  void depthScale();

  /// A wider gap between groups.
  void space() { x_ += 2 * kGap_px; }

  /// Colour (BGR) by the logarithm of the depth, from near (orange) to far (blue).
  static cv::Scalar colourOfDepth(double depth_m);

  /// Like printf().
  template <class... Values>
  static std::string format(const char* pattern, Values... values) {
    char text[128];
    std::snprintf(text, sizeof(text), pattern, values...);
    return text;
  }

 private:
  static constexpr int kGap_px = 8;

  bool reserve(int width_px);

  cv::Mat band_;
  int x_ = kGap_px;
};

}  // namespace rotrocc
