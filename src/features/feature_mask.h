#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace rotrocc {

/// Where an image has no features. Copies share their pixels.
class FeatureMask {
 public:
  /// Excludes the pixels that are not zero in `mask` (CV_8UC1; empty: none), and those closer to
  /// them than `margin_px`. There is nothing to do if it is the same image as before.
  void assign(const cv::Mat& mask, int margin_px) {
    if (mask.data == mask_.data) return;
    mask_ = mask;
    grown_.release();  // copies keep theirs
    if (mask.empty()) return;
    const cv::Size window(2 * margin_px + 1, 2 * margin_px + 1);
    cv::dilate(mask, grown_, cv::getStructuringElement(cv::MORPH_RECT, window));
  }

  /// Whether a pixel may not be used. Those outside the image may.
  bool excludes(const cv::Point2f& pixel) const {
    const cv::Point nearest(cvRound(pixel.x), cvRound(pixel.y));
    return cv::Rect({}, grown_.size()).contains(nearest) && grown_.at<uchar>(nearest) != 0;
  }

  /// Non-zero where features may be, as OpenCV's detectors expect it. Empty if that is everywhere.
  cv::Mat usable() const { return grown_.empty() ? cv::Mat() : cv::Mat(grown_ == 0); }

 private:
  cv::Mat mask_;  // as passed: while it is kept, no other has the same address
  cv::Mat grown_;
};

}  // namespace rotrocc
