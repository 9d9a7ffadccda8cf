#include "sequences/yaml_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "common/read_yaml.h"

namespace rotrocc {
namespace {

YAML::Node parse(const std::string& path) {
  try {
    YAML::Node root = readYaml(path);
    if (root.IsMap()) return root;
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(path + " is not YAML: " + error.what());
  }
  throw std::runtime_error(path + " has no keys: is it the right file?");
}

}  // namespace

YamlFile::YamlFile(const std::string& path) : path_(path), root_(parse(path)) {}

void YamlFile::fail(const std::string& key, const std::string& what) const {
  throw std::runtime_error(path_ + ": " + key + " " + what);
}

YamlFile YamlFile::section(const std::string& key) const {
  const YAML::Node node = find(key);
  if (!node.IsMap()) fail(key, "is not a map");
  return {path_ + ": " + key, node};
}

YAML::Node YamlFile::find(const std::string& key) const {
  YAML::Node node = root_[key];
  if (!node.IsDefined()) fail(key, "is missing");
  return node;
}

std::string YamlFile::text(const std::string& key) const {
  const YAML::Node node = find(key);
  if (!node.IsScalar()) fail(key, "is not a value");
  return node.Scalar();
}

int YamlFile::pixels(const std::string& key) const {
  constexpr double kMax = 1e5;
  double value = 0.0;
  if (!YAML::convert<double>::decode(find(key), value) || !(value >= 1.0 && value <= kMax) ||
      value != std::floor(value)) {
    fail(key, "is not a number of pixels");
  }
  return static_cast<int>(value);
}

std::vector<double> YamlFile::numbers(const std::string& key) const {
  YAML::Node list = find(key);
  if (list.IsMap()) list.reset(list["data"]);
  if (!list.IsDefined() || !list.IsSequence()) fail(key, "is not a list of numbers");
  std::vector<double> numbers;
  const auto append = [&](const YAML::Node& entry) {
    double number = 0.0;
    if (!entry.IsScalar() || !YAML::convert<double>::decode(entry, number) ||
        !std::isfinite(number)) {
      fail(key, cv::format("has a value that is not a finite number, after %zu", numbers.size()));
    }
    numbers.push_back(number);
  };
  for (const YAML::Node& entry : list) {
    if (!entry.IsSequence()) append(entry);
    if (entry.IsSequence()) std::for_each(entry.begin(), entry.end(), append);
  }
  return numbers;
}

std::vector<double> YamlFile::numbers(const std::string& key, std::size_t count) const {
  std::vector<double> values = numbers(key);
  if (values.size() != count) {
    fail(key, cv::format("has %zu numbers instead of %zu", values.size(), count));
  }
  return values;
}

}  // namespace rotrocc
