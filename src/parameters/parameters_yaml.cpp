#include "rotrocc/parameters.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace rotrocc {
namespace {

/// Whether a text can be written to a YAML file: yaml-cpp replaces what is not UTF-8.
bool isWritable(const std::string& text) {
  return YAML::Load(YAML::Dump(YAML::Node(text))).Scalar() == text;
}

void set(const std::string& name, const std::string& text, ParameterTable& table) {
  if (!isWritable(text)) {
    throw std::invalid_argument("the value of parameter \"" + name + "\" is not UTF-8");
  }
  table.set(name, text);
}

/// Sets every scalar and list below `node`; `prefix` is the name of `node`.
void setAll(const YAML::Node& node,
            const std::string& prefix,
            ParameterTable& table,
            std::vector<std::string>& warnings) {
  if (const std::string why = whyIgnored(prefix); !why.empty()) return warnings.push_back(why);
  if (node.IsScalar()) return set(prefix, node.Scalar(), table);
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

/// Column of the comments in a YAML file.
constexpr std::size_t kCommentColumn = 34;

std::string comment(const ParameterTable::Parameter& p) {
  std::string text = "# ";
  if (!p.unit.empty()) text += "[" + p.unit + "] ";
  return text + p.description + "; " + p.range;
}

}  // namespace

std::vector<std::string> loadYaml(const std::string& path, ParameterTable& table) {
  std::vector<std::string> warnings;
  try {
    const YAML::Node root = YAML::LoadFile(path);
    if (!root.IsNull()) setAll(root, "", table, warnings);
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(path + ": " + error.what());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  for (std::string& warning : warnings) warning = path + ": " + warning;
  return warnings;
}

std::string toYaml(const ParameterTable& table) {
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
    text += line + comment(p) + "\n";
  }
  return text;
}

}  // namespace rotrocc
