#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "check/windows.h"

namespace rotrocc {

/// The worst first. kUnknown: could not be measured.
enum class Verdict { kFix, kAcceptable, kUnknown, kGood };

/// What is known of one property of a rig.
struct Finding {
  /// "inputs", "photometry", "rows", "disparities", "time", "view" or "odometry".
  std::string section;
  std::string subject;   ///< the property, e.g. "roll of the right camera"
  std::string measured;  ///< with its uncertainty, e.g. "0.102 +- 0.003 deg"
  std::string cost;      ///< what it costs; empty if nothing
  std::string remedy;  ///< what to do; commands and lines of files in `backticks`; empty if nothing
  Verdict verdict = Verdict::kGood;
  /// How many times its limit of what must be fixed the value is: orders findings of the same
  /// verdict.
  double severity = 0.0;
};

/// Numbers for the pictures of a report.
struct ReportTable {
  std::string name;                       ///< of the file, without ".csv"
  std::string columns;                    ///< separated by commas, with their units, e.g. "time_s"
  std::vector<std::vector<double>> rows;  ///< as long as columns
};

/// A value, and the limits above which it is acceptable or to be fixed.
struct Graded {
  Estimate value;
  double acceptable, fix;
};

/// What has no size: it is there.
constexpr Graded kToFix = {{100.0}, 0.0, 1.0}, kToLookAt = {{0.9}, 0.0, 1.0};

struct RigReport {
  std::string title;    ///< what was checked
  std::string summary;  ///< its size, in one line
  std::vector<Finding> findings;
  /// The same with a corrected calibration, if one was found.
  std::optional<std::vector<Finding>> corrected;
  std::vector<ReportTable> tables;
  cv::Mat left, right;  ///< a pair, CV_8UC1; empty if there is none
  cv::Mat mask;         ///< CV_8UC1, 255 where it is proposed not to look; empty: none is proposed

  /// Adds a finding with the verdict and the severity of a graded value, whose certain size counts.
  /// A value that is known no better than the limit of fix is unknown.
  void add(Finding finding, const Graded& graded);

  /// Puts what needs fixing first, of that what others depend on, and of that the most severe.
  void sort();

  bool needsFix() const;

  /// What needs fixing first, and how, as one line of text. Call sort() first.
  std::string advice() const;
};

/// The report as a page of text.
std::string toText(const RigReport& report);

/// Writes findings.yaml, the tables as CSV files and the pictures as PNG files, which draw_report
/// draws the page from. Throws std::runtime_error if one cannot be written, and as ReportDirectory.
void writeReport(const RigReport& report, const std::string& directory);

}  // namespace rotrocc
