#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <opencv2/core.hpp>

#include "files/read_yaml.h"

namespace rotrocc {

/// A map in a YAML file. Its functions throw std::runtime_error "PATH: KEY WHAT" if a value is
/// missing or of another kind.
///
/// camera_calibration_parsers reads such files, too, but does not say what is wrong, and ends the
/// program if a matrix has another size.
class YamlMap {
 public:
  explicit YamlMap(const std::string& path) : path_(path) {
    try {
      map_ = readYaml(path);
    } catch (const YAML::Exception& error) {
      throw std::runtime_error(path + " is not YAML: " + error.what());
    }
    if (!map_.IsMap()) throw std::runtime_error(path + " has no keys: is it the right file?");
  }

  YamlMap section(const std::string& key) const {
    const YAML::Node node = find(key);
    if (!node.IsMap()) fail(key, "is not a map");
    return {path_ + ": " + key, node};
  }

  bool has(const std::string& key) const { return map_[key].IsDefined(); }

  /// Of the file, and the keys of sections.
  const std::string& path() const { return path_; }

  std::string text(const std::string& key) const {
    const YAML::Node node = find(key);
    if (!node.IsScalar()) fail(key, "is not a value");
    return node.Scalar();
  }

  /// `otherwise` if there is no such key.
  std::string text(const std::string& key, const std::string& otherwise) const {
    return map_[key].IsDefined() ? text(key) : otherwise;
  }

  /// Finite numbers, `count` of them unless that is 0: one, a list, a list of rows, or the list
  /// `data` of a matrix.
  std::vector<double> numbers(const std::string& key, std::size_t count = 0) const {
    const YAML::Node node = find(key);
    std::vector<double> numbers;
    append(key, node.IsMap() ? node["data"] : node, numbers);
    if (count == 0 || numbers.size() == count) return numbers;
    fail(key, cv::format("has %zu numbers instead of %zu", numbers.size(), count));
  }

  /// Image sizes: integers from 1 to 1e5.
  std::vector<int> pixels(const std::string& key, std::size_t count = 1) const {
    std::vector<int> pixels;
    for (const double value : numbers(key, count)) {
      if (!(value >= 1.0 && value <= 1e5 && value == std::floor(value))) {
        fail(key, cv::format("is %g, not a number of pixels", value));
      }
      pixels.push_back(static_cast<int>(value));
    }
    return pixels;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw std::runtime_error(path_ + ": " + key + " " + what);
  }

 private:
  YamlMap(const std::string& path, const YAML::Node& map) : path_(path), map_(map) {}

  YAML::Node find(const std::string& key) const {
    const YAML::Node node = map_[key];
    if (!node.IsDefined()) fail(key, "is missing");
    return node;
  }

  void append(const std::string& key, const YAML::Node& node, std::vector<double>& numbers) const {
    if (node.IsDefined() && node.IsSequence()) {
      for (const YAML::Node& entry : node) append(key, entry, numbers);
      return;
    }
    double number = 0.0;
    const bool is_number = node.IsDefined() && YAML::convert<double>::decode(node, number);
    if (!is_number || !std::isfinite(number)) {
      fail(key, cv::format("has a value that is not a finite number, after %zu", numbers.size()));
    }
    numbers.push_back(number);
  }

  std::string path_;
  YAML::Node map_;
};

}  // namespace rotrocc
