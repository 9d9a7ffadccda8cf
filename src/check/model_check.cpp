#include "check/model_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "check/cells.h"
#include "check/rig_problem.h"
#include "common/median.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

const char* const kCalibrate =
    "`rosrun rotrocc check_rig RECORDING --write-camera-info DIR` writes a corrected calibration; "
    "or recalibrate the pair with camera_calibration";

const char* const kOtherLens =
    "calibrate with more views in the corners, or with another distortion model: "
    "rational_polynomial or fisheye";

struct CauseText {
  RigCause cause;
  const char* subject;
  const char* unit;
  double factor;  ///< from the unit of RigCauses
};
constexpr CauseText kCauseTexts[] = {
    {kRoll, "roll of the right camera", "deg", kDegrees},
    {kPitch, "pitch of the right camera", "deg", kDegrees},
    {kYaw, "yaw of the right camera", "deg", kDegrees},
    {kTwist, "errors that look like a yaw, in the rows alone", "deg", kDegrees},
    {kFocal, "focal length of the right camera relative to the left", "%", 100.0},
    {kOffset, "row of the right principal point", "px", 1.0},
    {kLens, "residual radial distortion of the right lens", "(k1)", 1.0},
};

/// What a shift in the middle of the image may be instead; empty if it is not.
std::string orTurn(const StereoCamera& camera, const RigModel& model, RigCause cause) {
  const bool is_row = cause == kOffset;
  const TurnOrShift which = is_row ? model.vertical : model.horizontal;
  if (which != TurnOrShift::kEither || model.values[cause] == 0.0) return "";
  const double per_px = is_row ? kDegrees / camera.fy : -kDegrees / camera.fx;
  return std::string(", or a ") + (is_row ? "pitch" : "yaw") + " of " +
         toText(model.value(cause) * per_px, "deg") + ": the images do not show which";
}

void addCauses(const StereoCamera& camera, const RigModel& model, RigReport& report) {
  for (const CauseText& text : kCauseTexts) {
    const Estimate value = model.value(text.cause);
    // Stands for both.
    if (value.value == 0.0 && (text.cause == kPitch || text.cause == kYaw)) continue;
    const bool is_shape = (text.cause == kPitch && model.vertical != TurnOrShift::kTurn) ||
                          (text.cause == kYaw && model.horizontal != TurnOrShift::kTurn);
    const bool is_of_lens = text.cause == kTwist || is_shape;
    const Eigen::Vector2d effect_px = std::abs(value.value) * model.effects_px[text.cause];
    std::string measured =
        toText(value * text.factor, text.unit) + ", " + fixedText(effect_px.y(), 2) + " px of rows";
    if (text.cause == kOffset) {
      measured += orTurn(camera, model, kOffset);
    } else if (text.cause != kTwist) {
      measured += " and " + fixedText(effect_px.x(), 2) + " px of disparities";
    }
    // What nobody can say the cause of is not to be fixed.
    const double fix = is_shape ? std::numeric_limits<double>::infinity() : 1.0;
    report.add({"rows",
                is_shape ? "errors that look like a " +
                               std::string(text.subject, text.cause == kYaw ? 3 : 5)
                         : text.subject,
                measured,
                "row errors above half a pixel cost features, and disparity errors distort depths: "
                "the typical disparity is " +
                    fixedText(model.typical_disparity_px, 0) + " px",
                is_of_lens ? kOtherLens : kCalibrate},
               {model.severity(text.cause), kAcceptable, fix});
  }
  const Estimate both = model.severity(kBothLenses);
  report.add({"rows",
              "residual radial distortion of both lenses",
              toText(model.value(kBothLenses), "(k1)") + ", " +
                  fixedText(100.0 * kFixScale * both.value, 1) + " % error of depths and angles",
              "scale and rotation depend on where in the image the features are",
              kOtherLens},
             {both, kAcceptable, 1.0});
  const Estimate skew_s = model.value(kTimeSkew);
  const Estimate shift_px = skew_s * (10.0 / kDegrees * camera.fx);
  report.add({"time",
              "delay of the right images",
              toText(skew_s * 1e3, "ms"),
              "disparities are wrong by " + fixedText(std::abs(shift_px.value), 2) +
                  " px when the rig turns at 10 deg/s",
              "trigger both cameras with the same signal, and give both the same exposure time"},
             {shift_px, kAcceptable * model.fix_rows_px, model.fix_rows_px});
}

/// Row differences, and what the model leaves of them. Windows of time have errors of the rig in
/// common, but not errors of matches: the square of a cell's mean, minus the variance of the mean,
/// has no noise.
void addRows(const StereoCamera& camera,
             const std::vector<PairSamples>& pairs,
             const RigModel& model,
             const Windows& windows,
             ModelRest& rest,
             RigReport& report) {
  const ImageGrid grid = mapOf(camera.width, camera.height);
  const RigDisplacement displacement(camera, model.causes);
  std::vector<std::vector<double>> measured_px(grid.count());
  std::vector<std::vector<TimedValue>> rests_px(grid.count());  // by the model
  for (const PairSamples& pair : pairs) {
    for (const RigSample& sample : pair.samples) {
      if (!std::isfinite(sample.row_px)) continue;
      const std::size_t cell = grid.cell(sample.left_px.x, sample.left_px.y);
      measured_px[cell].push_back(sample.row_px);
      rests_px[cell].push_back({pair.time_s, sample.row_px - displacement.of(sample).y()});
    }
  }
  std::vector<double> rows_px, squares_px2;
  ReportTable table = {"rows_map", "x_px,y_px,row_px,sigma_px,model_px", {}};
  for (std::size_t i = 0; i < grid.count(); ++i) {
    if (measured_px[i].size() < kLeastInCell) continue;
    const cv::Point2d center = grid.center(i);
    const double row_px = median(measured_px[i]);
    const Estimate left = overWindows(rests_px[i], windows, kLeastInCell);
    table.rows.push_back({center.x, center.y, row_px, left.sigma, row_px - left.value});
    rows_px.push_back(row_px);
    if (std::isfinite(left.sigma)) {
      squares_px2.push_back(left.value * left.value - left.sigma * left.sigma);
    }
  }
  report.tables.push_back(std::move(table));
  if (rows_px.empty()) return;
  rest.rows_px = cv::norm(rows_px) / std::sqrt(static_cast<double>(rows_px.size()));
  const auto [square_px2, sigma_px2] = meanOf(squares_px2);
  const double left_px = std::sqrt(std::max(square_px2, 0.0));
  rest.unexplained_px = {left_px, sigma_px2 / std::max(2.0 * left_px, std::sqrt(sigma_px2))};
  report.add({"rows",
              "unexplained row differences",
              toText(rest.unexplained_px, "px") + " of " + fixedText(rest.rows_px, 2) +
                  " px (rms over the image)",
              "the lenses have errors of another shape",
              kOtherLens},
             {rest.unexplained_px, 2.0 * kAcceptable * model.fix_rows_px, model.fix_rows_px});
}

void addCourse(const char* name,
               const char* columns,
               const std::vector<Estimate>& course,
               const Windows& windows,
               RigReport& report) {
  ReportTable table = {name, columns, {}};
  for (std::size_t w = 0; w < course.size(); ++w) {
    const auto& [value, sigma] = course[w];
    if (std::isfinite(sigma)) table.rows.push_back({windows.middle_s(w), value, sigma});
  }
  report.tables.push_back(std::move(table));
}

/// What the model does not explain at one time: a rig that bends, or that was hit. A plane over the
/// image, as a rotation makes it: kOffset, kRoll and kFocal. Returns whether it is little.
bool addRowsOverTime(const StereoCamera& camera,
                     const RigModel& model,
                     const std::vector<std::vector<Estimate>>& courses,
                     const Windows& windows,
                     double rows_px,
                     RigReport& report) {
  addCourse("rows_time", "time_s,row_px,sigma_px", courses[0], windows, report);
  // The middle, and at half of the image in x and y, where the mean square is a third of that at
  // the border.
  const double rms_px = 0.5 / std::sqrt(3.0);
  const Estimate middle = scatterBeyondNoise(courses[0]);
  const Estimate in_x = scatterBeyondNoise(courses[1]) * (rms_px * camera.width);
  const Estimate in_y = scatterBeyondNoise(courses[2]) * (rms_px * camera.height);
  const Estimate motion_px = {std::hypot(middle.value, in_x.value, in_y.value),
                              std::hypot(middle.sigma, in_x.sigma, in_y.sigma)};
  report.add({"rows",
              kRowsOverTime,
              "vary by " + fixedText(motion_px.value, 2) + " px (rms)",
              "no calibration fits a rig that bends",
              "mount both cameras on one stiff bar, and fix lenses and connectors"},
             {motion_px, kAcceptable * model.fix_rows_px, model.fix_rows_px});
  return motion_px.value < std::max(kAcceptable * model.fix_rows_px, 0.5 * rows_px);
}

/// Returns whether a calibration can describe the bias: not if it moves for certain, by half of it.
bool addBias(const StereoCamera& camera,
             const RigModel& model,
             const std::vector<Estimate>& course_px,
             double applied_px,
             RigReport& report) {
  const double typical_px = model.typical_disparity_px;
  const Estimate motion_px = scatterBeyondNoise(course_px);
  Estimate bias_px = model.value(kBias);
  const bool lasts =
      !(motion_px.certain() > 0.0) ||
      motion_px.value < std::max(kFixScale * typical_px, 0.5 * std::abs(bias_px.value));
  if (!lasts) bias_px.sigma = std::hypot(bias_px.sigma, motion_px.value);
  const double at_10_m = 10.0 * bias_px.value / (camera.fx * camera.baseline_m);
  report.add(
      {"disparities",
       "disparity bias",
       "disparities are " + toText(bias_px.value < 0.0 ? bias_px * -1.0 : bias_px, "px too ") +
           (bias_px.value < 0.0 ? "large" : "small") + orTurn(camera, model, kBias) +
           "; depths of 10 m are off by " + fixedText(100.0 * at_10_m, 1) + " %",
       "without a correction " + fixedText(std::abs(100.0 * bias_px.value / typical_px), 1) +
           " m in 100 m, at the disparity of the mean depth, " + fixedText(typical_px, 1) +
           " px; the odometry corrects " + fixedText(applied_px, 2) + " px of it",
       kCalibrate},
      {bias_px * (1.0 / typical_px), kAcceptable * kFixScale, kFixScale});
  report.add({"disparities",
              "disparity bias over time",
              "varies by " + fixedText(motion_px.value, 2) + " px (rms)",
              "the scale changes while the rig bends",
              "mount both cameras on one stiff bar"},
             {motion_px * (1.0 / typical_px), kAcceptable * kFixScale, kFixScale});
  return lasts;
}

}  // namespace

ModelRest checkModel(const StereoCamera& camera,
                     const std::vector<PairSamples>& pairs,
                     const RigModel& model,
                     const Windows& windows,
                     double applied_px,
                     RigReport& report) {
  ModelRest rest;
  if (!std::isfinite(model.sigmas[kRoll])) {
    report.findings.push_back({"rows",
                               "rows, disparities and time",
                               "too few features with a motion",
                               "",
                               "drive or carry the cameras through a scene with texture",
                               Verdict::kUnknown});
    return rest;
  }
  addCauses(camera, model, report);
  addRows(camera, pairs, model, windows, rest, report);
  RigProblem problem(camera, pairs, windows);
  problem.values = model.values;
  problem.is_of_turn[kOffset] = model.vertical == TurnOrShift::kTurn;
  problem.is_of_turn[kBias] = model.horizontal == TurnOrShift::kTurn;
  constexpr std::size_t kMostWindows = 100;
  const Windows fine(windows.duration_s(), pairs.size(), kMostWindows);
  const auto planes = problem.courses({kOffset, kRoll, kFocal}, fine);
  const auto biases_px = problem.courses({kBias}, windows)[0];
  addCourse("bias_time", "time_s,bias_px,sigma_px", biases_px, windows, report);
  const bool rows_last = addRowsOverTime(camera, model, planes, fine, rest.rows_px, report);
  const bool bias_lasts = addBias(camera, model, biases_px, applied_px, report);
  rest.is_constant = rows_last && bias_lasts;
  return rest;
}

}  // namespace rotrocc
