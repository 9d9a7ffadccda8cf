#include "rotrocc/parameters.h"

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "common/read_yaml.h"

namespace rotrocc {
namespace {

/// Parameters of earlier releases, by section.
constexpr const char* kRemoved = R"(
"": [lost_speed_sigma_mps, lost_turn_rate_sigma_rps]
feature_detector: [block_radius_px, border_px, cell_size_px, min_response, nms_radius_px]
feature_tracker: [levels, max_disparity_difference_px, max_iterations, max_vertical_px,
  min_step_px, startup_levels]
keyframe_selector: [max_parallax_px, min_seen_share]
motion_check: [degraded_depth_share, degraded_information_share, degraded_relative_sigma,
  degraded_rival_share, degraded_rotation_share, degraded_start_share, degraded_survivor_share,
  degraded_translation_share]
motion_estimator: [comparison_iterations, deviation_factor, mean_factor, retry_share,
  rotation_drop_share, rotation_max_iterations, translation_drop_share, translation_max_iterations]
motion_model: [max_age_s]
stereo_calibrator: [flex_px, noise_ratio, prior_sigma_px, robust_factor, shared_error_ratio,
  significance, steady_pairs]
stereo_matcher: [max_mean_difference, uniqueness]
visual_odometry: [settled_px]
)";

/// Sets every scalar and list below `node`; `prefix` is the name of `node`.
void setAll(const YAML::Node& node,
            const std::string& prefix,
            ParameterTable& table,
            std::vector<std::string>& warnings) {
  if (const std::string why = whyIgnored(prefix); !why.empty()) return warnings.push_back(why);
  if (node.IsScalar()) {
    // Could not be written: yaml-cpp replaces what is not UTF-8.
    if (YAML::Load(YAML::Dump(YAML::Node(node.Scalar()))).Scalar() != node.Scalar()) {
      throw std::invalid_argument("the value of parameter \"" + prefix + "\" is not UTF-8");
    }
    return table.set(prefix, node.Scalar());
  }
  if (node.IsSequence()) return table.setList(prefix, node.as<std::vector<std::string>>());
  if (!node.IsMap()) {
    throw std::invalid_argument("parameter \"" + prefix + "\" is neither a value nor a section");
  }
  // A recursive alias would never end.
  if (prefix.find('/') != std::string::npos) {
    throw std::invalid_argument("\"" + prefix + "\" must be a value: sections cannot be nested");
  }
  for (const auto& entry : node) {
    const auto name = entry.first.as<std::string>();
    setAll(entry.second, prefix.empty() ? name : prefix + "/" + name, table, warnings);
  }
}

}  // namespace

std::string whyIgnored(const std::string& name) {
  using Sections = std::map<std::string, std::vector<std::string>>;
  static const auto kSections = YAML::Load(kRemoved).as<Sections>();
  for (const auto& [section, leaves] : kSections) {
    for (const std::string& leaf : leaves) {
      if (name != (section.empty() ? leaf : section + "/" + leaf)) continue;
      return "parameter " + name + " no longer exists and is ignored: delete it";
    }
  }
  return "";
}

std::vector<std::string> loadYaml(const std::string& path, ParameterTable& table) {
  std::vector<std::string> warnings;
  try {
    const YAML::Node root = readYaml(path);
    if (!root.IsNull()) setAll(root, "", table, warnings);
  } catch (const std::exception& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  for (std::string& warning : warnings) warning = path + ": " + warning;
  return warnings;
}

std::string toYaml(const ParameterTable& table) {
  constexpr std::size_t kCommentColumn = 34;
  std::string text;
  std::string section;
  for (const ParameterTable::Parameter& p : table.parameters()) {
    const auto slash = p.name.find('/');
    const std::string its_section = slash == std::string::npos ? "" : p.name.substr(0, slash);
    if (its_section != section) text += "\n" + its_section + ":\n";
    section = its_section;
    const bool is_text = p.type == ParameterTable::Parameter::Type::kText;
    const std::string value = is_text ? YAML::Dump(YAML::Node(p.get())) : p.get();
    std::string line =
        (section.empty() ? "" : "  ") + p.name.substr(slash + 1) + ": " + value + "  ";
    if (line.size() < kCommentColumn) line.resize(kCommentColumn, ' ');
    const std::string unit = p.unit.empty() ? "" : "[" + p.unit + "] ";
    text += line + "# " + unit + p.description + "; " + p.range + "\n";
  }
  return text;
}

}  // namespace rotrocc
