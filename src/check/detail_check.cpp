#include "check/pair_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "check/cells.h"
#include "common/median.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Pairs between those that are compared.
constexpr int kStep = 5;

/// Fewer show what one camera sees past an edge, and the other one does not.
constexpr int kLeastPairs = 5 * kStep;

/// How much stronger edges between blocks of eight columns are than those elsewhere, as a share.
double blockEdges(const cv::Mat& image) {
  constexpr int kBlock = 8;
  cv::Mat edges, columns;
  cv::absdiff(image.colRange(1, image.cols), image.colRange(0, image.cols - 1), edges);
  cv::reduce(edges, columns, 0, cv::REDUCE_SUM, CV_64F);
  const int blocks = columns.cols / kBlock;
  std::vector<double> phases;
  cv::reduce(columns.colRange(0, blocks * kBlock).reshape(0, blocks), phases, 0, cv::REDUCE_SUM);
  const double most = *std::max_element(phases.begin(), phases.end());
  const double typical = median(phases);
  return typical > 0.0 ? most / typical - 1.0 : 0.0;
}

class DetailCheck : public PairCheck {
 public:
  void observe(const CheckedPair& pair) override {
    if (!pair.has_moved || pairs_++ % kStep != 0) return;
    width_ = pair.images.left.cols;
    const ImageGrid grid = mapOf(width_, pair.images.left.rows);
    const cv::Mat* images[] = {&pair.images.left, &pair.images.right};
    const cv::Mat saturated = (*images[0] == 255) | (*images[1] == 255);
    const cv::Mat exposed = cellMeans(saturated, grid) < 0.1 * 255.0;
    for (int side = 0; side < 2; ++side) {
      blocks_[side].push_back({pair.time_s, blockEdges(*images[side])});
      cv::Mat& sum = detail_[side];
      cv::Mat detail = detailOf(*images[side], grid);
      detail.setTo(0.0, ~exposed);
      sum = sum.empty() ? detail : cv::Mat(sum + detail);
    }
  }

  void report(const Windows& windows, RigReport& report) const override {
    if (detail_[1].empty()) return;
    constexpr double kStrong = 0.3;  // takes detail away
    for (int side = 0; side < 2; ++side) {
      const Estimate blocks = overWindows(blocks_[side], windows);
      report.add(
          {"photometry",
           side == 0 ? "compression, left" : "compression, right",
           "edges between blocks are " + toText(blocks * 100.0, "%") + " stronger than others",
           "block corners are detected instead of scene corners",
           "raise the compression quality, or record uncompressed images"},
          {blocks, kStrong, 1.0});
      // What is near is elsewhere in the other image, which has such parts, too.
      const bool is_near = !report.mask.empty() || cv::countNonZero(blurredParts(1 - side)) > 0;
      if (blocks.value < kStrong && pairs_ >= kLeastPairs && !is_near) addSmudge(side, report);
    }
  }

 private:
  /// Where an image shows less than half of the detail of the other one, over the whole recording.
  cv::Mat blurredParts(int side) const {
    constexpr double kLess = 0.5;
    cv::Mat ratios;
    cv::divide(detail_[side], detail_[1 - side], ratios);
    ratios.setTo(1.0, detail_[1 - side] == 0.0);
    std::vector<float> sorted(ratios.begin<float>(), ratios.end<float>());
    return withoutSmallParts(ratios < kLess * median(sorted), 2);
  }

  void addSmudge(int side, RigReport& report) const {
    const cv::Mat blurred = blurredParts(side);
    const cv::Moments place = cv::moments(blurred, true);
    const double share = place.m00 / static_cast<double>(blurred.total());
    const std::string name = side == 0 ? "left" : "right";
    std::string measured = toText(std::lround(100.0 * share)) + " % of the " + name + " image";
    if (share > 0.0) {
      const double cell_px = static_cast<double>(width_) / blurred.cols;
      const double x = (place.m10 / place.m00 + 0.5) * cell_px;
      const double y = (place.m01 / place.m00 + 0.5) * cell_px;
      measured += ", around x " + toText(std::lround(x)) + ", y " + toText(std::lround(y));
    }
    report.add({"photometry",
                "regions with less than half the detail, " + name,
                measured,
                "features there have no disparity or a wrong one",
                "clean the " + name + " lens, and remove what is in front of it"},
               {{share}, 0.01, 0.025});
  }

  int pairs_ = 0, width_ = 0;
  std::vector<TimedValue> blocks_[2];  // left, right
  cv::Mat detail_[2];                  // sums of detailOf()
};

}  // namespace

std::unique_ptr<PairCheck> makeDetailCheck() {
  return std::make_unique<DetailCheck>();
}

}  // namespace rotrocc
