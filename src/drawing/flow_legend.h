#pragma once

#include <cstdio>
#include <string>

#include <opencv2/core.hpp>

namespace rotrocc {

/// The line below a flow picture: words and colours from left to right, as far as there is room.
class FlowLegend {
 public:
  static constexpr int kHeight_px = 24;

  /// Writes into `band`, CV_8UC3 and kHeight_px high, which becomes dark.
  explicit FlowLegend(cv::Mat band);

  void text(const std::string& words);

  /// A piece of a line with its dot, and what it means.
  void sample(const cv::Scalar& colour, const std::string& words);

  /// The colours of depths.
  void depthScale();

  /// A wider gap, between things that do not belong together.
  void space() { x_ += 2 * kGap_px; }

  /// From near (orange) to far (blue) the colour (BGR) goes with the logarithm of the depth.
  static cv::Scalar colourOfDepth(double depth_m);

  /// As printf() does.
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
