#include "check/pair_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "check/image_grid.h"
#include "common/median.h"
#include "features/feature_detector.h"
#include "features/stereo_matcher.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Pairs between those whose corners are looked at.
constexpr int kCornersStep = 5;
constexpr int kFineColumns = 2 * ImageGrid::kColumns;

/// Fewer pairs whose images change do not show what stands still in them.
constexpr int kLeastPairs = 10;

/// Most features that agree, as a share, in a cell of a map that does not agree.
constexpr double kMostAgreeing = 0.15;

std::string percent(double share) {
  return toText(std::lround(100.0 * share)) + " %";
}

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : 0.0;
}

class ViewCheck : public PairCheck {
 public:
  explicit ViewCheck(const OdometryConfig& config)
      : config_(config.correspondence_finder.stereo_matcher),
        detector_(config.correspondence_finder.feature_detector) {}

  void observe(const CheckedPair& pair) override {
    camera_ = pair.camera;
    const ImageGrid grid(camera_.width, camera_.height);
    const ImageGrid fine(camera_.width, camera_.height, kFineColumns);
    map_.resize(grid.count());
    fine_map_.resize(fine.count());
    if (pairs_++ % kCornersStep == 0) countCorners(pair);
    compareWithLast(pair, fine);
    if (!pair.result.hasMotion()) return;
    for (std::size_t i = 0; i < pair.features.size(); ++i) {
      const Correspondence& feature = pair.features[i];
      const bool agrees = pair.inliers[i] != 0;
      for (Cell* cell : {&map_[grid.of(feature.cur_px.x(), feature.cur_px.y())],
                         &fine_map_[fine.of(feature.cur_px.x(), feature.cur_px.y())]}) {
        ++cell->features;
        cell->inliers += agrees ? 1 : 0;
      }
      if (agrees && i % 4 == 0) depths_m_.push_back(feature.point_cur.z());
    }
  }

  void report(const Windows& /*windows*/, RigReport& report) const override {
    if (pairs_ == 0) return;
    addDisparities(report);
    addCoverage(report);
    addDepths(report);
    addMask(report);
  }

 private:
  struct Cell {
    int corners = 0, with_depth = 0;
    int features = 0, inliers = 0;
    int still = 0;  ///< pairs in which it stays as it is, while others change
  };

  /// Why corners have no disparity.
  struct Missing {
    int too_near = 0, outside = 0, ambiguous = 0;
  };

  /// Counts the cells with texture that stay as they are while others change.
  void compareWithLast(const CheckedPair& pair, const ImageGrid& fine) {
    constexpr float kOverNoise = 2.0F;  // a change
    constexpr float kTexture = 4.0F;    // over noise
    constexpr double kChanging = 0.3;   // of the cells with texture
    constexpr double kStill_px = 0.5;
    const cv::Mat& image = pair.images.left;
    if (last_.size() != image.size()) {
      last_ = image.clone();
      return;
    }
    cv::Mat difference;
    cv::Mat coarse;
    cv::absdiff(image, last_, difference);
    const cv::Mat_<float> changes = cellMeans(difference, fine);
    cv::blur(image, coarse, {9, 9});
    cv::absdiff(image, coarse, difference);
    const cv::Mat_<float> textures = cellMeans(difference, fine);
    image.copyTo(last_);
    const float noise = noiseOf(changes, cellMeans(image, fine));
    std::vector<std::size_t> still;
    int changing = 0;
    for (std::size_t i = 0; i < changes.total(); ++i) {
      const auto cell = static_cast<int>(i);
      if (textures(cell) < kTexture * noise) continue;
      if (changes(cell) < kOverNoise * noise) {
        still.push_back(i);
      } else {
        ++changing;
      }
    }
    if (changing < kChanging * static_cast<double>(changing + static_cast<int>(still.size())))
      return;
    if (changing == 0) return;
    ++changing_pairs_;
    if (pair.result.hasMotion() && pair.flow_px < kStill_px) ++resting_pairs_;
    for (const std::size_t cell : still) ++fine_map_[cell].still;
  }

  /// Change of what stands still: of the cells that change least, but for clipped ones, which have
  /// none.
  static float noiseOf(const cv::Mat_<float>& changes, const cv::Mat_<float>& grays) {
    constexpr float kDark = 8.0F;
    constexpr float kBright = 247.0F;
    constexpr float kLeast = 0.5F;  // of rounding
    std::vector<float> exposed;
    for (int row = 0; row < changes.rows; ++row) {
      for (int column = 0; column < changes.cols; ++column) {
        const float gray = grays(row, column);
        if (gray > kDark && gray < kBright) exposed.push_back(changes(row, column));
      }
    }
    return exposed.empty() ? kLeast : std::max(quantile(exposed, 0.1), kLeast);
  }

  void countCorners(const CheckedPair& pair) {
    const ImageGrid grid(camera_.width, camera_.height);
    std::vector<cv::Point2f> corners;
    detector_.detect(pair.images.left, corners);
    const RectifiedImages images = {
        pair.images.left, pair.images.right, camera_, pair.result.row_offset.applied_px};
    const StereoMatcher matcher(config_);
    for (const cv::Point2f& corner : corners) {
      Cell& cell = map_[grid.of(corner.x, corner.y)];
      ++cell.corners;
      ++corners_;
      if (matcher.match(images, corner)) {
        ++cell.with_depth;
        ++with_depth_;
      } else {
        explain(images, corner);
      }
    }
  }

  /// Searches nearer than the odometry does; other rows and what is beyond infinity have findings.
  void explain(const RectifiedImages& images, const cv::Point2f& corner) {
    const double nearest_px = camera_.fx / config_.nearest_baselines;
    StereoMatcherConfig near = config_;
    near.nearest_baselines = 0.5 * config_.nearest_baselines;
    near.min_disparity_px = nearest_px;
    const bool may_be_outside = corner.x - camera_.disparityAtInfinity() < nearest_px;
    ++(StereoMatcher(near).match(images, corner) ? missing_.too_near
       : may_be_outside                          ? missing_.outside
                                                 : missing_.ambiguous);
  }

  void addDisparities(RigReport& report) const {
    const double with_depth = share(with_depth_, corners_);
    Finding finding = {"view",
                       "corners with a disparity",
                       percent(with_depth),
                       "corners without a disparity cannot be features",
                       ""};
    const std::pair<int, const char*> reasons[] = {
        {missing_.too_near, "nearer than nearest_baselines reaches"},
        {missing_.outside, "perhaps outside of the right image"},
        {missing_.ambiguous, "ambiguous, hidden or different"}};
    for (const auto& [count, text] : reasons) {
      if (share(count, corners_) >= 0.005) {
        finding.measured += ", " + percent(share(count, corners_)) + " " + text;
      }
    }
    finding.remedy =
        2 * missing_.too_near > corners_ - with_depth_
            ? "set `nearest_baselines` to " + toText(0.5 * config_.nearest_baselines)
            : "look at rows, sharpness and exposure above; the scene may have too little texture";
    report.add(finding, {{1.0 - with_depth}, 0.5, 0.8});
    ReportTable table = {"view_map", "x_px,y_px,corners,with_depth,features,inliers", {}};
    const ImageGrid grid(camera_.width, camera_.height);
    for (std::size_t i = 0; i < map_.size(); ++i) {
      const cv::Point2d center = grid.center(i);
      table.rows.push_back({center.x,
                            center.y,
                            static_cast<double>(map_[i].corners),
                            static_cast<double>(map_[i].with_depth),
                            static_cast<double>(map_[i].features),
                            static_cast<double>(map_[i].inliers)});
    }
    report.tables.push_back(std::move(table));
  }

  void addCoverage(RigReport& report) const {
    const auto seen = std::count_if(map_.begin(), map_.end(), [&](const Cell& cell) {
      return cell.inliers * 20 > pairs_;  // in each 20th pair
    });
    const double empty = 1.0 - static_cast<double>(seen) / static_cast<double>(map_.size());
    report.add({"view",
                "coverage",
                "features in " + percent(1.0 - empty) + " of the image",
                "in part of an image, rotation and translation look the same",
                "turn the cameras to where there is texture, or use wider lenses"},
               {{empty}, 0.5, 0.8});
  }

  void addDepths(RigReport& report) const {
    std::vector<double> depths_m = depths_m_;
    if (depths_m.empty()) return;
    const double near_m = quantile(depths_m, 0.1);
    const double middle_m = quantile(depths_m, 0.5);
    const double far_m = quantile(depths_m, 0.9);
    const double typical_px = camera_.fx * camera_.baseline_m / middle_m;
    report.add({"view",
                "depths",
                fixedText(middle_m, 1) + " m in the middle, 80 % between " + fixedText(near_m, 1) +
                    " and " + fixedText(far_m, 1) + " m; a disparity of " +
                    fixedText(typical_px, 1) + " px",
                "distances are as accurate as the near depths",
                "a longer baseline, a longer focal length, or look lower"},
               {{1.0 / typical_px}, 0.4, 1.0});
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
         "motion towards zero",
         "look at `mask.png` of the report, and if it is the robot itself or a reflection, set "
         "the parameter `mask` to it"},
        {{masked}, kAcceptable, 0.05});
    if (masked <= kAcceptable) return;
    cv::resize(cells, report.mask, {camera_.width, camera_.height}, 0, 0, cv::INTER_NEAREST);
  }

  /// Cells of the fine map that stand still while the rest changes, one pixel each, and whose
  /// features do not agree with the motion, unless that is theirs. Single ones are not the robot.
  cv::Mat standingStill() const {
    const ImageGrid fine(camera_.width, camera_.height, kFineColumns);
    cv::Mat cells = cv::Mat::zeros(fine.size(), CV_8UC1);
    if (changing_pairs_ < kLeastPairs) return cells;
    const bool follows_robot =
        2 * resting_pairs_ > changing_pairs_ && resting_pairs_ >= kLeastPairs;
    for (std::size_t i = 0; i < fine_map_.size(); ++i) {
      const Cell& cell = fine_map_[i];
      const bool disagrees = share(cell.inliers, cell.features) < kMostAgreeing;
      const bool stands_still = share(cell.still, changing_pairs_) > 0.5;
      if (stands_still && (follows_robot || disagrees)) cells.data[i] = 255;
    }
    const cv::Mat plus = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
    cv::Mat closed;
    cv::morphologyEx(cells, closed, cv::MORPH_CLOSE, plus, {-1, -1}, 1, cv::BORDER_REPLICATE);
    cv::Mat labels, statistics, centroids;
    const int parts = cv::connectedComponentsWithStats(closed, labels, statistics, centroids, 4);
    constexpr int kLeastCells = 4;
    for (int part = 1; part < parts; ++part) {
      if (statistics.at<int>(part, cv::CC_STAT_AREA) < kLeastCells) closed.setTo(0, labels == part);
    }
    return closed;
  }

  StereoMatcherConfig config_;
  FeatureDetector detector_;
  StereoCamera camera_;
  std::vector<Cell> map_, fine_map_;  // of ImageGrid and of twice as many columns
  Missing missing_;
  cv::Mat last_;                                // left image
  int changing_pairs_ = 0, resting_pairs_ = 0;  // whose images change; of these, without a motion
  int pairs_ = 0;
  int corners_ = 0, with_depth_ = 0;
  std::vector<double> depths_m_;
};

}  // namespace

std::unique_ptr<PairCheck> makeViewCheck(const OdometryConfig& config) {
  return std::make_unique<ViewCheck>(config);
}

}  // namespace rotrocc
