#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace rotrocc {

/// A map of values and lists of numbers in a YAML file, also if its first line is "%YAML:1.0" as
/// OpenCV writes it, which is not YAML.
class YamlFile {
 public:
  /// Throws std::runtime_error with the path if the file is missing or not a map.
  explicit YamlFile(const std::string& path);

  /// A map in this one. Throws std::runtime_error with path and key if it is missing or no map.
  YamlFile section(const std::string& key) const;

  bool has(const std::string& key) const { return root_[key].IsDefined(); }

  /// These throw std::runtime_error with path and key if the value is missing or of another kind.
  std::string text(const std::string& key) const;

  /// An image size: an integer from 1 to 1e5.
  int pixels(const std::string& key) const;

  /// Finite numbers: a list, a list of rows, or the list `data` of a matrix.
  std::vector<double> numbers(const std::string& key) const;

  /// As many as `count`.
  std::vector<double> numbers(const std::string& key, std::size_t count) const;

  /// With that of a section: "PATH: KEY".
  const std::string& path() const { return path_; }

  /// Throws std::runtime_error "PATH: KEY WHAT".
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  YamlFile(const std::string& path, const YAML::Node& root) : path_(path), root_(root) {}
  YAML::Node find(const std::string& key) const;

  std::string path_;
  YAML::Node root_;
};

}  // namespace rotrocc
