#include "check/input_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/median.h"
#include "common/to_seconds.h"
#include "input/camera_clock.h"
#include "input/message_conversion.h"
#include "input/sent_calibration.h"
#include "input/to_text.h"

namespace rotrocc {
void InputCheck::observe(const RecordedMessage& message) {
  if (message.left_info) left_info_ = message.left_info;
  if (message.right_image) right_ns_.push_back(toNanoseconds(message.right_image->header.stamp));
  if (!message.left_image) return;
  left_ns_.push_back(toNanoseconds(message.left_image->header.stamp));
  ages_s_[left_ns_.back()] = toSeconds(toNanoseconds(message.time) - left_ns_.back());
}

void InputCheck::report(const StereoCamera& camera,
                        const std::string& left_out,
                        bool rectifies,
                        RigReport& report) const {
  if (!left_out.empty()) {
    report.add({"inputs",
                "left out",
                left_out,
                "each is a pair without a motion estimate",
                "look at the reasons: the node drops the same pairs"},
               kToLookAt);
  }
  const std::string values = "fx " + fixedText(camera.fx, 2) + " px, baseline " +
                             fixedText(camera.baseline_m, 4) + " m, " +
                             sizeText(camera.width, camera.height) +
                             (rectifies ? ", raw images, rectified here" : ", rectified images");
  const std::string warning = left_info_ ? calibrationWarning(*left_info_, camera) : "";
  report.add({"inputs", "camera_info", values, "", warning},
             {{warning.empty() ? 0.0 : 1.1}, 0.0, 1.0});  // after what is measured
  const std::string baseline = baselineWarning(camera.baseline_m);
  if (baseline.empty()) return;
  report.add({"inputs",
              "baseline",
              fixedText(camera.baseline_m, 4) + " m",
              "all lengths are wrong by the same factor",
              baseline},
             kToLookAt);
}

void InputCheck::reportStreams(double max_apart_s, RigReport& report) const {
  for (const bool right : {false, true}) {
    const Stamps& stamps_ns = right ? right_ns_ : left_ns_;
    const auto period_ns = periodOf(stamps_ns);
    if (!period_ns) continue;
    const double period_s = toSeconds(*period_ns);
    double lost = 0.0, longest_s = 0.0;
    for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
      const double interval_s = toSeconds(stamps_ns[i] - stamps_ns[i - 1]);
      // One that is repeated, or goes back, counts as well.
      lost += std::abs(std::round(std::max(interval_s, 0.0) / period_s) - 1.0);
      longest_s = std::max(longest_s, interval_s);
    }
    std::string measured = fixedText(1.0 / period_s, 2) + " Hz";
    if (lost > 0.0) {
      measured += ", " + toText(std::lround(lost)) + " frames are missing or out of order, up to " +
                  fixedText(longest_s, 2) + " s apart";
    }
    report.add({"inputs",
                right ? "right images" : "left images",
                measured,
                "motions across gaps are longer, so more of them are lost, especially in turns",
                "look for frames lost by the driver, the USB or network link, or the recorder"},
               {{lost / static_cast<double>(stamps_ns.size())}, 0.01, 0.1});
  }
  addStamps(max_apart_s, report);
}

void InputCheck::addStamps(double max_apart_s, RigReport& report) const {
  Stamps left_ns = left_ns_, right_ns = right_ns_;
  std::sort(left_ns.begin(), left_ns.end());
  std::sort(right_ns.begin(), right_ns.end());
  const auto period_ns = periodOf(left_ns);
  const auto matches = matchStamps(left_ns, right_ns, std::numeric_limits<std::int64_t>::max());
  if (!period_ns || matches.empty()) return;
  std::vector<double> ages_s;
  for (const auto& [stamp_ns, age_s] : ages_s_) ages_s.push_back(age_s);
  const double age_s = median(ages_s);
  // Not in folders of images, nor with another clock than that of the recorder.
  const bool has_ages = age_s != 0.0 && std::abs(age_s) < kOtherClock_s;
  ReportTable table = {"stamps", "time_s,left_minus_right_ms,age_ms,interval_ms", {}};
  std::vector<double> apart_s;
  for (const auto& [i, j] : matches) {
    apart_s.push_back(toSeconds(left_ns[i] - right_ns[j]));
    table.rows.push_back({toSeconds(left_ns[i] - left_ns.front()),
                          1e3 * apart_s.back(),
                          has_ages ? 1e3 * ages_s_.at(left_ns[i]) : NAN,
                          i > 0 ? 1e3 * toSeconds(left_ns[i] - left_ns[i - 1]) : NAN});
  }
  report.tables.push_back(std::move(table));
  constexpr double kAcceptable = 0.05, kFix = 0.25;  // periods between left and right
  const double period_s = toSeconds(*period_ns);
  const auto [least, most] = std::minmax_element(apart_s.begin(), apart_s.end());
  const double largest_s = std::max(std::abs(*least), std::abs(*most));
  const double typical_s = median(apart_s);
  const bool is_recorded = largest_s != 0.0 || has_ages;
  report.add(
      {"inputs",
       "left minus right timestamps",
       is_recorded
           ? fixedText(1e3 * typical_s, 2) + " ms, at most " + fixedText(1e3 * largest_s, 2) + " ms"
           : "not recorded: each pair has a single timestamp",
       "images from different times are not a pair: moving objects get wrong depths",
       "trigger both cameras with one signal, and use its time for both timestamps; if the images "
       "were taken at the same time, correct the timestamps, or set `max_stamp_difference_s`"},
      {{is_recorded ? typical_s : NAN},
       kAcceptable * period_s,
       std::min(kFix * period_s, max_apart_s)});
  if (!has_ages) return;
  report.add(
      {"inputs",
       "arrival delay",
       fixedText(1e3 * age_s, 0) + " ms",
       "odometry and tf arrive that much later",
       age_s > 0.0
           ? "synchronize the clocks of camera and computer, and find out what delays the images"
           : "timestamps are in the future: synchronize the clocks of camera and computer"},
      {{age_s}, 0.3, 1.0});
}

}  // namespace rotrocc
