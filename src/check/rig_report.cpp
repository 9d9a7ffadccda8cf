#include "check/rig_report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <yaml-cpp/yaml.h>
#include <boost/algorithm/string/case_conv.hpp>

#include "check/pair_check.h"
#include "files/csv_file.h"
#include "files/image_file.h"
#include "files/report_directory.h"

namespace rotrocc {
namespace {

/// Of what belongs to a finding.
const std::string kIndent(12, ' ');

const char* const kNotSeen =
    "This check cannot detect a wrong baseline, or an equal error in both focal lengths.";

const char* toString(Verdict verdict) {
  constexpr const char* kNames[] = {"fix", "acceptable", "unknown", "good"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Verdict judge(const Graded& graded) {
  const double certain = graded.value.certain();
  if (!std::isfinite(certain)) return Verdict::kUnknown;
  if (certain > graded.fix) return Verdict::kFix;
  if (certain > graded.acceptable) return Verdict::kAcceptable;
  return graded.value.sigma > graded.fix ? Verdict::kUnknown : Verdict::kGood;
}

std::string toText(const std::vector<Finding>& findings) {
  std::string text;
  std::set<std::string> said;
  for (const Finding& finding : findings) {
    const std::string verdict = boost::to_upper_copy<std::string>(toString(finding.verdict));
    text += cv::format("%-11s ", verdict.c_str()) + finding.section + ": " + finding.subject +
            ": " + finding.measured + '\n';
    if (finding.verdict == Verdict::kGood || finding.remedy.empty()) continue;
    if (!said.insert(finding.cost + finding.remedy).second) {
      text += kIndent + "-> as above\n";
      continue;
    }
    if (!finding.cost.empty()) text += kIndent + finding.cost + '\n';
    text += kIndent + "-> " + finding.remedy + '\n';
  }
  return text;
}

YAML::Node toYaml(const std::vector<Finding>& findings) {
  YAML::Node list(YAML::NodeType::Sequence);
  for (const Finding& finding : findings) {
    YAML::Node entry;
    entry["section"] = finding.section;
    entry["subject"] = finding.subject;
    entry["measured"] = finding.measured;
    entry["cost"] = finding.cost;
    entry["verdict"] = toString(finding.verdict);
    entry["remedy"] = finding.remedy;
    list.push_back(entry);
  }
  return list;
}

/// The verdict, and what depends on what: matches on the images, rows and delays on matches,
/// disparities on rows and delays, and all the rest on disparities.
std::pair<Verdict, int> rankOf(const Finding& finding) {
  static const std::map<std::string, int> kRanks = {
      {"inputs", 0}, {"photometry", 0}, {"rows", 1}, {"time", 1}, {"disparities", 2}, {"view", 3}};
  const auto rank = kRanks.find(finding.subject == kMasked ? "inputs" : finding.section);
  return {finding.verdict, rank == kRanks.end() ? 4 : rank->second};
}

}  // namespace

void RigReport::add(Finding finding, const Graded& graded) {
  finding.verdict = judge(graded);
  const double limit = std::isfinite(graded.fix) ? graded.fix : graded.acceptable;
  finding.severity = std::isfinite(graded.value.value) ? std::abs(graded.value.value) / limit : 0.0;
  if (finding.verdict == Verdict::kGood || finding.verdict == Verdict::kUnknown) {
    finding.remedy.clear();
    finding.cost.clear();
  }
  findings.push_back(std::move(finding));
}

bool RigReport::needsFix() const {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.verdict == Verdict::kFix;
  });
}

std::string RigReport::advice() const {
  const auto first = std::find_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.verdict <= Verdict::kAcceptable && !finding.remedy.empty();
  });
  if (first == findings.end()) {
    return findings.empty() || findings.front().verdict == Verdict::kGood
               ? "Nothing to do."
               : "Nothing to fix; some properties could not be measured.";
  }
  const std::string prefix = first->verdict == Verdict::kFix
                                 ? "To fix first: "
                                 : "Nothing needs fixing. Largest remaining error: ";
  return prefix + first->subject + ": " + first->measured + ". To do: " + first->remedy + ".";
}

void RigReport::sort() {
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    if (rankOf(a) != rankOf(b)) return rankOf(a) < rankOf(b);
    return a.verdict != Verdict::kGood && a.severity > b.severity;
  });
}

std::string toText(const RigReport& report) {
  std::ostringstream text;
  text << report.title << '\n' << report.summary << "\n\n";
  text << report.advice() << "\n\n" << toText(report.findings) << '\n';
  text << kNotSeen << '\n';
  std::map<Verdict, int> counts;
  for (const Finding& finding : report.findings) ++counts[finding.verdict];
  text << counts[Verdict::kFix] << " to fix, " << counts[Verdict::kAcceptable] << " acceptable, "
       << counts[Verdict::kGood] << " good, " << counts[Verdict::kUnknown] << " unknown\n";
  if (report.corrected) {
    text << "\nWith the corrected calibration:\n\n" << toText(*report.corrected);
  }
  return text.str();
}

void writeReport(const RigReport& report, const std::string& directory) {
  ReportDirectory files(directory);
  YAML::Node page;
  page["title"] = report.title;
  page["summary"] = report.summary;
  page["advice"] = report.advice();
  page["not_seen"] = kNotSeen;
  page["findings"] = toYaml(report.findings);
  if (report.corrected) page["corrected"] = toYaml(*report.corrected);
  const std::string path = files.path("findings.yaml");
  std::ofstream file(path);
  file << page << '\n';
  if (!file.flush()) throw std::runtime_error(path + " cannot be written");
  for (const ReportTable& table : report.tables) {
    CsvFile csv(files.path(table.name + ".csv"), table.columns);
    for (const std::vector<double>& row : table.rows) csv.row(row);
  }
  const std::pair<const char*, const cv::Mat&> pictures[] = {
      {"left.png", report.left}, {"right.png", report.right}, {"mask.png", report.mask}};
  for (const auto& [name, picture] : pictures) {
    if (!picture.empty()) writeImage(files.path(name), picture);
  }
}

}  // namespace rotrocc
