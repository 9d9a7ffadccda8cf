#include "rotrocc/parameters.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include <yaml-cpp/yaml.h>

namespace rotrocc {
namespace {

/// Sets every scalar below `node`; `prefix` is the name of `node`.
void setAll(const YAML::Node& node, const std::string& prefix, ParameterTable& table) {
  if (node.IsScalar()) return table.set(prefix, node.Scalar());
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

/// Column of the comments in a YAML file.
constexpr std::size_t kCommentColumn = 34;

/// Escapes text for double quotes. YAML::Emitter would change invalid UTF-8.
std::string escape(const std::string& text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string escaped;
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      escaped += {'\\', c};
    } else if ((c >= 0 && c < ' ') || c == '\x7f') {
      escaped += {'\\', 'x', kHex[c / 16], kHex[c % 16]};
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// Quotes a text if YAML would read it as something else.
std::string quoteIfNeeded(const std::string& text) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/' || c == '.';
  };
  const bool is_null = text == "null" || text == "Null" || text == "NULL";
  if (!text.empty() && !is_null && std::all_of(text.begin(), text.end(), is_plain)) return text;
  return '"' + escape(text) + '"';
}

std::string comment(const ParameterTable::Parameter& p) {
  std::string text = "# ";
  if (!p.unit.empty()) text += "[" + p.unit + "] ";
  return text + p.description + "; " + p.range;
}

}  // namespace

void loadYaml(const std::string& path, ParameterTable& table) {
  try {
    const YAML::Node root = YAML::LoadFile(path);
    if (!root.IsNull()) setAll(root, "", table);
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(path + ": " + error.what());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
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
    const std::string value = is_text ? quoteIfNeeded(p.get()) : p.get();
    std::string line =
        (section.empty() ? "" : "  ") + p.name.substr(slash + 1) + ": " + value + "  ";
    if (line.size() < kCommentColumn) line.resize(kCommentColumn, ' ');
    text += line + comment(p) + "\n";
  }
  return text;
}

}  // namespace rotrocc
