#include "check/row_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "check/image_grid.h"
#include "common/median.h"
#include "common/to_seconds.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Features of a pair that are measured, and samples of a recording that causes are fitted to: more
/// would not change them by a tenth of their uncertainty.
constexpr std::size_t kPerPair = 60;
constexpr std::size_t kFitted = 8000;

/// Limits of the mean square effect of a cause. Matches are searched in rounded rows, so a quarter
/// of a row costs nothing; from half a row on, windows contain another row.
constexpr double kAcceptable_px = 0.1;
constexpr double kFix_px = 0.4;

constexpr double kSigmas = 3.0;
constexpr double kDegrees = 180.0 / M_PI;

const char* const kCalibrate =
    "`rosrun rotrocc check_rig RECORDING --write-camera-info DIR` writes a corrected calibration; "
    "or recalibrate the pair with camera_calibration";

const char* const kOtherLens =
    "calibrate with more views in the corners, or with another distortion model: "
    "rational_polynomial or fisheye";

struct CauseText {
  RowCause cause;
  const char* subject;
  const char* unit;
  double factor;  ///< from the unit of RowCauses
};
constexpr CauseText kCauseTexts[] = {
    {kRoll, "roll of the right camera", "deg", kDegrees},
    {kPitch, "pitch of the right camera", "deg", kDegrees},
    {kYaw, "keystone (yaw) of the right camera", "deg", kDegrees},
    {kFocal, "focal length right to left", "%", 100.0},
    {kOffset, "row of the right principal point", "px", 1.0},
    {kLens, "radial distortion left over on the right", "(k1)", 1.0},
};

/// Moves a window by a part of a pixel, for each sample by another one. Interpolation blurs the
/// noise of windows between pixels, so that these match a little better. Where images hardly move,
/// all features are at similar parts of pixels, and rows would be wrong by some hundredths.
cv::Point2f shiftOf(std::size_t sample) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  const double part = golden * static_cast<double>(sample);
  return {0.0F, static_cast<float>(part - std::floor(part) - 0.5)};
}

/// Velocity of the camera, in its own axes.
struct Twist {
  Eigen::Vector3d turn_rps, speed_mps;
};

Twist twistOf(const OdometryResult& result) {
  const double interval_s = toSeconds(result.stamp_ns - result.keyframe_stamp_ns);
  const Eigen::AngleAxisd turn(result.T_keyframe_cur.T.linear());
  const Eigen::AngleAxisd half_back(-0.5 * turn.angle(), turn.axis());
  return {turn.angle() / interval_s * turn.axis(),
          half_back * result.T_keyframe_cur.T.translation() / interval_s};
}

/// The vertical velocity of a feature in the left image when it is taken [px/s]. That of its flow
/// is lower where the camera approaches it.
double velocityOf(const Correspondence& feature, const StereoCamera& camera, const Twist& twist) {
  const Eigen::Vector3d& point = feature.point_cur;
  const Eigen::Vector3d velocity = -(twist.turn_rps.cross(point) + twist.speed_mps);
  return camera.fy * (velocity.y() - point.y() / point.z() * velocity.z()) / point.z();
}

/// Median and its standard deviation.
Estimate medianOf(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  const double scatter = kDeviationOverMedian * median(values);
  return {middle, kMedianOverMean * scatter / std::sqrt(static_cast<double>(values.size()))};
}

}  // namespace

void RowCheck::observe(const CheckedPair& pair) {
  if (!pair.result.hasMotion() || pair.features.empty()) return;
  camera_ = pair.camera;
  const Twist twist = twistOf(pair.result);
  const std::size_t step = std::max<std::size_t>(1, pair.features.size() / kPerPair);
  for (std::size_t i = 0; i < pair.features.size(); i += step) {
    if (pair.inliers[i] == 0) continue;
    const Correspondence& feature = pair.features[i];
    const cv::Point2f left = cv::Point2f(static_cast<float>(feature.cur_px.x()),
                                         static_cast<float>(feature.cur_px.y())) +
                             shiftOf(samples_.size());
    cv::Point2f right = left + cv::Point2f(-static_cast<float>(feature.disparity_px),
                                           static_cast<float>(pair.result.row_offset.applied_px));
    // Again from where it stops, up to 0.04 px before the end.
    constexpr int kSearches = 3;
    int found = 0;
    while (found < kSearches && tracker_.locate(pair.images.left, pair.images.right, left, right)) {
      ++found;
    }
    if (found < kSearches) continue;
    samples_.push_back({pair.time_s,
                        left,
                        (right.x - camera_.cx_right) / camera_.fx,
                        (left.y - camera_.cy) / camera_.fy,
                        right.y - left.y,
                        velocityOf(feature, camera_, twist)});
  }
}

RowModel RowCheck::correctable() const {
  RowModel model = model_;
  if (!(yawShare() > 0.5)) model.causes[kYaw] = 0.0;
  return model;
}

/// The share of the yaw of the rows that disparities have; nan if that is not known. Some lenses,
/// or rectifications, make rows of the same shape. The errors of disparities by a yaw are so much
/// larger than those of rows that they are either there or not.
double RowCheck::yawShare() const {
  const double yaw_rad = model_.causes[kYaw];
  const bool is_known = kSigmas * keystone_rad_.sigma < 0.5 * std::abs(yaw_rad);
  return is_known ? keystone_rad_.value / yaw_rad : std::numeric_limits<double>::quiet_NaN();
}

void RowCheck::report(const Windows& windows, const Estimate& keystone_rad, RigReport& report) {
  std::vector<RowSample> fitted;
  std::vector<std::size_t> of_window;
  const std::size_t step = std::max<std::size_t>(1, samples_.size() / kFitted);
  for (std::size_t i = 0; i < samples_.size(); i += step) {
    fitted.push_back(samples_[i]);
    of_window.push_back(windows.of(samples_[i].time_s));
  }
  model_ = fitRows(camera_, fitted, of_window, windows.count());
  keystone_rad_ = keystone_rad;
  if (samples_.size() < kLeastSamples) {
    report.findings.push_back({"rows",
                               "row differences",
                               "too few features with a motion",
                               "",
                               "drive or carry the cameras through a scene with texture",
                               Verdict::kUnknown});
    return;
  }
  addCauses(report);
  addMap(report);
  addCourse(report);
}

void RowCheck::addCauses(RigReport& report) const {
  for (const CauseText& text : kCauseTexts) {
    const double value = text.factor * model_.causes[text.cause];
    const double sigma = text.factor * model_.sigmas[text.cause];
    const double effect_px = model_.effects_px[text.cause];
    // The offset stands for both.
    if (text.cause == kPitch && value == 0.0) continue;
    std::string measured = toText(Estimate{value, sigma}, text.unit);
    if (text.cause == kOffset && model_.may_be_pitch && value != 0.0) {
      const double px_per_degree = camera_.fy / kDegrees;
      measured += ", or a pitch of " +
                  toText(Estimate{value / px_per_degree, sigma / px_per_degree}, "deg") +
                  ": the images do not show which";
    } else {
      measured += ", " + fixedText(effect_px, 2) + " px of rows";
    }
    const bool is_of_lens = text.cause == kYaw && yawShare() <= 0.5;
    if (is_of_lens) {
      measured +=
          "; of a lens, as disparities show a yaw of " +
          toText(Estimate{kDegrees * keystone_rad_.value, kDegrees * keystone_rad_.sigma}, "deg");
    }
    report.add({"rows",
                text.subject,
                measured,
                "matches are searched in rows: features get lost from half a row on, and "
                "disparities at slanted edges are wrong by a share of it",
                is_of_lens ? kOtherLens : kCalibrate},
               {effect_px, model_.effect_sigmas_px[text.cause], kAcceptable_px, kFix_px});
  }
  const double skew_s = model_.causes[kTimeSkew];
  const double sigma_s = model_.sigmas[kTimeSkew];
  report.add({"time",
              "right images against left ones",
              toText(Estimate{1e3 * skew_s, 1e3 * sigma_s}, "ms") + " later",
              "what moves by 100 px/s has disparities that are wrong by " +
                  fixedText(100.0 * std::abs(skew_s), 2) + " px, and so has all when the rig turns",
              "trigger both cameras by the same signal, and give both the same exposure time"},
             {skew_s, sigma_s, 0.01 * kAcceptable_px, 0.01 * kFix_px});
}

void RowCheck::addMap(RigReport& report) {
  const ImageGrid grid(camera_.width, camera_.height);
  std::vector<std::vector<double>> rows_px(grid.count());
  std::vector<double> models_px(grid.count(), 0.0);
  double squares = 0.0;
  for (const RowSample& sample : samples_) {
    const std::size_t cell = grid.of(sample.left_px.x, sample.left_px.y);
    rows_px[cell].push_back(sample.row_px);
    models_px[cell] += rowOf(camera_, model_.causes, sample);
  }
  ReportTable table = {"rows_map", "x_px,y_px,count,row_px,sigma_px,model_px", {}};
  double cells = 0.0;
  double left_over = 0.0;
  for (std::size_t cell = 0; cell < grid.count(); ++cell) {
    const auto count = static_cast<double>(rows_px[cell].size());
    const cv::Point2d centre = grid.centre(cell);
    if (count < ImageGrid::kLeast) continue;
    const Estimate row = medianOf(rows_px[cell]);
    const double model_px = models_px[cell] / count;
    table.rows.push_back({centre.x, centre.y, count, row.value, row.sigma, model_px});
    squares += row.value * row.value;
    left_over += std::max(std::pow(row.value - model_px, 2) - row.sigma * row.sigma, 0.0);
    cells += 1.0;
  }
  report.tables.push_back(std::move(table));
  if (cells == 0.0) return;
  rms_px_ = std::sqrt(squares / cells);
  remainder_px_ = std::sqrt(left_over / cells);
  report.add(
      {"rows",
       "row differences that none of these explains",
       fixedText(remainder_px_, 2) + " px of " + fixedText(rms_px_, 2) + " px (rms over the image)",
       "smooth errors of the lenses",
       kOtherLens},
      {remainder_px_, 0.0, 2.0 * kAcceptable_px, kFix_px});
}

/// Second by second, what the model does not explain: a rig that bends, or that was hit.
void RowCheck::addCourse(RigReport& report) {
  std::map<int, std::vector<double>> seconds;
  for (const RowSample& sample : samples_) {
    seconds[static_cast<int>(sample.time_s)].push_back(sample.row_px -
                                                       rowOf(camera_, model_.causes, sample));
  }
  ReportTable table = {"rows_time", "time_s,row_px,sigma_px", {}};
  std::vector<double> medians;
  double squares = 0.0;
  double variances = 0.0;
  double largest_step_px = 0.0;
  double step_s = 0.0;
  for (const auto& [second, values] : seconds) {
    if (values.size() < 2 * ImageGrid::kLeast) continue;
    const Estimate row = medianOf(values);
    table.rows.push_back({second + 0.5, row.value, row.sigma});
    if (!medians.empty() && std::abs(row.value - medians.back()) > largest_step_px) {
      largest_step_px = std::abs(row.value - medians.back());
      step_s = second;
    }
    medians.push_back(row.value);
    squares += row.value * row.value;
    variances += row.sigma * row.sigma;
  }
  report.tables.push_back(std::move(table));
  if (medians.size() < 3) return;
  const auto count = static_cast<double>(medians.size());
  const double motion_px = std::sqrt(std::max(squares - variances, 0.0) / count);
  const auto [least, most] = std::minmax_element(medians.begin(), medians.end());
  const double range_px = *most - *least;
  constexpr double kJumpShare = 0.8;
  const bool jumps = largest_step_px > kJumpShare * range_px;
  Finding finding = {
      "rows",
      "row differences over time",
      "move by " + fixedText(motion_px, 2) + " px (rms), within " + fixedText(range_px, 2) + " px",
      "no calibration fits a rig that moves: turn rates and depths change with it",
      "mount both cameras on one stiff bar, and fix lenses and connectors"};
  if (jumps) finding.measured += ", most of it in one step at " + fixedText(step_s, 0) + " s";
  report.add(finding, {motion_px, std::sqrt(variances) / count, kAcceptable_px, kFix_px});
  is_constant_ = motion_px < std::max(kAcceptable_px, 0.5 * rms_px_);
}

}  // namespace rotrocc
