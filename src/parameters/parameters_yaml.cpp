#include "rotrocc/parameters.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "common/read_yaml.h"

namespace rotrocc {
namespace {

/// Sets every scalar and list below `node`; `prefix` is the name of `node`.
void setAll(const YAML::Node& node, const std::string& prefix, ParameterTable& table) {
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
    setAll(entry.second, prefix.empty() ? name : prefix + "/" + name, table);
  }
}

}  // namespace

void loadYaml(const std::string& path, ParameterTable& table) {
  try {
    const YAML::Node root = readYaml(path);
    if (!root.IsNull()) setAll(root, "", table);
  } catch (const std::exception& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
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
