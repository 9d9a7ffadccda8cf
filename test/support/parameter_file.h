#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

#include "rotrocc/parameter_table.h"

namespace rotrocc {

/// The table as config/default.yaml has it: unit, range and description of each parameter as a
/// comment.
inline std::string toYaml(const ParameterTable& table) {
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
