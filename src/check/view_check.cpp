#include "check/pair_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "check/cells.h"
#include "features/image_noise.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Of the map, twice as fine as others: the robot itself may be narrow.
constexpr int kColumns = 2 * kMapColumns;

/// Fewer pairs whose images change do not show what stands still in them.
constexpr int kLeastPairs = 10;

/// Most features that agree, as a share, in a cell of a map that does not agree.
constexpr float kMostAgreeing = 0.15F;

std::string percent(double share) {
  return toText(std::lround(100.0 * share)) + " %";
}

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

class ViewCheck : public PairCheck {
 public:
  void observe(const CheckedPair& pair) override {
    camera_ = pair.camera;
    const ImageGrid grid = mapOf(camera_.width, camera_.height, kColumns);
    if (features_.empty()) {
      for (cv::Mat_<float>* map : {&features_, &inliers_, &still_, &agreeing_})
        *map = cv::Mat_<float>::zeros(grid.size());
    }
    ++pairs_;
    corners_ += pair.result.counts.corners;
    with_depth_ += pair.result.counts.with_depth;
    const bool moves_apart = compareWithLast(pair, grid);
    if (!pair.result.hasMotion()) return;
    for (std::size_t i = 0; i < pair.features.size(); ++i) {
      const Eigen::Vector2d& pixel = pair.features[i].cur_px;
      const auto cell = static_cast<int>(grid.cell(pixel.x(), pixel.y()));
      features_(cell) += 1.0F;
      const float inlier = pair.inliers[i] != 0 ? 1.0F : 0.0F;
      inliers_(cell) += inlier;
      if (moves_apart) agreeing_(cell) += inlier - kMostAgreeing;
    }
  }

  void report(const Windows& /*windows*/, RigReport& report) const override {
    addDisparities(report);
    addCoverage(report);
    addMask(report);
  }

 private:
  /// Counts the cells with texture that stay as they are while others change. Returns whether
  /// others change, and the motion is theirs.
  bool compareWithLast(const CheckedPair& pair, const ImageGrid& grid) {
    constexpr double kOfDifference = 1.13;  // its mean size over the deviation of one image
    constexpr float kOverNoise = 2.0F;      // texture, and changes
    constexpr double kStill = 0.15;         // over texture, a change beyond noise
    constexpr double kChanging = 0.3;       // of the cells with texture
    constexpr double kStill_px = 0.5;
    const cv::Mat& image = pair.images.left;
    cv::Mat last = std::exchange(last_, image.clone());
    if (last.empty()) return false;
    cv::Mat difference;
    last.convertTo(last, CV_8U, cv::mean(image)[0] / std::max(cv::mean(last)[0], 1.0));
    cv::absdiff(image, last, difference);
    const cv::Mat_<float> changes = cellMeans(difference, grid);
    const cv::Mat_<float> textures = detailOf(image, grid);
    const auto noise = static_cast<float>(kOfDifference * std::sqrt(noiseVariance(image)));
    const cv::Mat textured = textures >= kOverNoise * noise;
    const cv::Mat moved = kStill * textures;
    const cv::Mat still = textured & (changes.mul(changes) < moved.mul(moved) + noise * noise);
    const int changing = cv::countNonZero(textured & ~still & (changes >= kOverNoise * noise));
    if (changing == 0 || changing < kChanging * cv::countNonZero(textured)) return false;
    ++changing_pairs_;
    cv::add(still_, 1.0, still_, still);
    return pair.flow_px >= kStill_px;
  }

  void addDisparities(RigReport& report) const {
    const double with_depth = share(with_depth_, corners_);
    report.add(
        {"view",
         "corners with a disparity",
         percent(with_depth),
         "corners without a disparity cannot be features",
         "look at rows, sharpness and exposure above; the scene may have too little texture, "
         "or be nearer than `nearest_baselines` reaches"},
        {{1.0 - with_depth}, 0.5, 0.8});
    ReportTable table = {"view_map", "x_px,y_px,features,inliers", {}};
    const ImageGrid grid = mapOf(camera_.width, camera_.height, kColumns);
    for (std::size_t i = 0; i < grid.count(); ++i) {
      const cv::Point2d center = grid.center(i);
      const auto cell = static_cast<int>(i);
      table.rows.push_back({center.x, center.y, features_(cell), inliers_(cell)});
    }
    report.tables.push_back(std::move(table));
  }

  void addCoverage(RigReport& report) const {
    // In each 80th pair; a cell of other maps is four times as large.
    const int seen = cv::countNonZero(inliers_ > pairs_ / 80.0);
    const double empty = 1.0 - share(seen, static_cast<int>(inliers_.total()));
    report.add({"view",
                "coverage",
                "features in " + percent(1.0 - empty) + " of the image",
                "in part of an image, rotation and translation look the same",
                "turn the cameras to where there is texture, or use wider lenses"},
               {{empty}, 0.5, 0.8});
  }

  void addMask(RigReport& report) const {
    constexpr double kAcceptable = 0.02;
    const cv::Mat cells = standingStill();
    const double masked = share(cv::countNonZero(cells), static_cast<int>(cells.total()));
    report.add(
        {"view",
         kMasked,
         percent(masked) + " of the image",
         "whatever moves with the cameras looks stationary: its features are rejected, or pull the "
         "motion toward zero",
         "look at `mask.png` of the report, and if it is the robot itself or a reflection, set "
         "the parameter `mask` to it"},
        {{masked}, kAcceptable, 0.05});
    if (masked <= kAcceptable) return;
    cv::resize(cells, report.mask, {camera_.width, camera_.height}, 0, 0, cv::INTER_NEAREST);
  }

  /// Cells that stand still while the rest changes, one pixel each, and whose features do not agree
  /// with the motion of the rest. Single ones are not the robot.
  cv::Mat standingStill() const {
    if (changing_pairs_ < kLeastPairs) return cv::Mat::zeros(still_.size(), CV_8UC1);
    const cv::Mat cells = (still_ > 0.5 * changing_pairs_) & (agreeing_ <= 0.0F);
    const cv::Mat plus = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
    cv::Mat closed;
    cv::morphologyEx(cells, closed, cv::MORPH_CLOSE, plus, {-1, -1}, 1, cv::BORDER_REPLICATE);
    return withoutSmallParts(closed, 4);
  }

  StereoCamera camera_;
  cv::Mat_<float> features_, inliers_;  // in each cell
  cv::Mat_<float> still_;               // pairs in which a cell stays as it is, while others change
  cv::Mat last_;                        // left image
  cv::Mat_<float> agreeing_;  // features in motion that agree beyond kMostAgreeing of them
  int changing_pairs_ = 0;    // whose images change
  int pairs_ = 0, corners_ = 0, with_depth_ = 0;
};

}  // namespace

std::unique_ptr<PairCheck> makeViewCheck() {
  return std::make_unique<ViewCheck>();
}

}  // namespace rotrocc
