#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>

#include <yaml-cpp/yaml.h>

#include "support/run_command.h"

namespace rotrocc {

/// What roslaunch would do with a launch file of the package. Nothing is started, and no master is
/// needed.
class Launched {
 public:
  /// `options` in the syntax of the shell. Throws std::runtime_error if roslaunch refuses the file.
  /// `environment` goes before the command, e.g. ROS_PACKAGE_PATH=....
  explicit Launched(const std::string& file,
                    const std::string& options = "",
                    const std::string& environment = "") {
    const CommandResult result = runCommand(
        environment + " " PYTHON " " READ_LAUNCH " " LAUNCH_DIR "/" + file + " " + options);
    const auto json = result.output.find("{\"nodes\"");
    if (result.status != 0 || json == std::string::npos) throw std::runtime_error(result.output);
    tree_ = YAML::Load(result.output.substr(json));
  }

  bool hasNode(const std::string& node) const { return bool(tree_["nodes"][node]); }

  /// A property of a node: type, args or required.
  std::string property(const std::string& node, const std::string& name) const {
    return required(required(tree_["nodes"], node), name).as<std::string>();
  }

  /// Where a node finds the topic `name`; `name` itself if it is not remapped.
  std::string topic(const std::string& node, const std::string& name) const {
    return required(tree_["nodes"], node)["remappings"][name].as<std::string>(name);
  }

  bool hasParam(const std::string& name) const { return bool(tree_["params"][name]); }
  template <class T = std::string>
  T param(const std::string& name) const {
    return required(tree_["params"], name).as<T>();
  }

  /// Whether the launch deletes what is below `name` on the parameter server before it begins.
  bool clears(const std::string& name) const {
    for (const auto& cleared : tree_["cleared"]) {
      if (cleared.as<std::string>() == name) return true;
    }
    return false;
  }

 private:
  static YAML::Node required(const YAML::Node& tree, const std::string& name) {
    if (!tree[name]) throw std::runtime_error("no " + name + " in\n" + YAML::Dump(tree));
    return tree[name];
  }

  YAML::Node tree_;
};

}  // namespace rotrocc
