#pragma once

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <yaml-cpp/yaml.h>
#include <boost/algorithm/string/replace.hpp>

namespace rotrocc {

/// Reads a YAML file, without the header line "%YAML:1.0" of OpenCV's. Throws std::runtime_error if
/// it cannot be read, and YAML::Exception if it is not valid.
inline YAML::Node readYaml(const std::string& path) {
  std::ifstream file(path);
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (!file.is_open() || file.bad()) throw std::runtime_error("cannot read " + path);
  if (text.compare(0, 6, "%YAML:") == 0) text.erase(0, text.find('\n'));
  // In brackets and braces, yaml-cpp 0.6 does not return from a colon before "]" or the end.
  boost::algorithm::replace_all(text, ":]", ": ]");
  return YAML::Load(text + '\n');
}

}  // namespace rotrocc
