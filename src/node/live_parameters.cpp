#include "node/live_parameters.h"

#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include <dynamic_reconfigure/config_tools.h>
#include <ros/init.h>

#include "input/to_text.h"
#include "node/advertise.h"

namespace rotrocc {
namespace {

using dynamic_reconfigure::Config;
using dynamic_reconfigure::ConfigTools;
using dynamic_reconfigure::Group;
using Parameter = ParameterTable::Parameter;

bool isLive(const std::string& parameter) {
  return parameter.find('/') != std::string::npos;
}

void append(const Parameter& parameter, const std::string& value, Config& config) {
  const std::string& name = parameter.name;
  switch (parameter.type) {
    case Parameter::Type::kInt:
      return ConfigTools::appendParameter(config, name, std::stoi(value));
    case Parameter::Type::kDouble:
      return ConfigTools::appendParameter(config, name, std::stod(value));
    case Parameter::Type::kBool:
      return ConfigTools::appendParameter(config, name, value == "true");
    case Parameter::Type::kText:
      return ConfigTools::appendParameter(config, name, value);
  }
}

dynamic_reconfigure::ParamDescription describe(const Parameter& parameter) {
  static const std::map<Parameter::Type, std::string> kTypes = {
      {Parameter::Type::kInt, "int"},
      {Parameter::Type::kDouble, "double"},
      {Parameter::Type::kBool, "bool"},
      {Parameter::Type::kText, "str"}};
  std::string choices;
  for (const std::string& choice : parameter.choices) {
    choices += (choices.empty() ? "" : ", ") + std::string("{'name': '") + choice +
               "', 'value': '" + choice + "', 'type': 'str', 'description': ''}";
  }
  dynamic_reconfigure::ParamDescription description;
  description.name = parameter.name;
  description.type = kTypes.at(parameter.type);
  description.description =
      (parameter.unit.empty() ? "" : "[" + parameter.unit + "] ") + parameter.description;
  // The drop-down list of rqt_reconfigure: a Python dictionary.
  if (!choices.empty()) {
    description.edit_method = "{'enum_description': '', 'enum': [" + choices + "]}";
  }
  return description;
}

/// One group for each section.
std::vector<Group> makeGroups(const ParameterTable& table) {
  std::vector<Group> groups(1);
  groups.front().name = "Default";
  for (const Parameter& parameter : table.parameters()) {
    if (!isLive(parameter.name)) continue;
    const std::string section = parameter.name.substr(0, parameter.name.find('/'));
    if (groups.back().name != section) {
      groups.emplace_back();
      groups.back().name = section;
      groups.back().id = static_cast<int>(groups.size()) - 1;
    }
    groups.back().parameters.push_back(describe(parameter));
  }
  return groups;
}

/// A value of each live parameter, and the states of all groups.
Config makeConfig(const ParameterTable& table,
                  const std::function<std::string(const Parameter&)>& value) {
  struct {
    bool state = true;
  } const open;
  Config config;
  for (const Group& group : makeGroups(table)) {
    ConfigTools::appendGroup(config, group.name, group.id, group.parent, open);
  }
  for (const Parameter& parameter : table.parameters()) {
    if (isLive(parameter.name)) append(parameter, value(parameter), config);
  }
  return config;
}

/// "a/b from 1 to 2, ..."; empty if all are equal.
std::string changes(Parameters before, Parameters after) {
  const ParameterTable old = makeParameterTable(before);
  const ParameterTable table = makeParameterTable(after);
  std::string text;
  for (std::size_t i = 0; i < table.parameters().size(); ++i) {
    const std::string was = old.parameters()[i].get();
    const std::string is = table.parameters()[i].get();
    if (is == was) continue;
    text += (text.empty() ? "" : ", ") + table.parameters()[i].name + " from " + was + " to " + is;
  }
  return text;
}

}  // namespace

dynamic_reconfigure::ConfigDescription describeLiveParameters(Parameters parameters) {
  const ParameterTable table = makeParameterTable(parameters);
  dynamic_reconfigure::ConfigDescription description;
  description.groups = makeGroups(table);
  description.min = makeConfig(table, [](const Parameter& parameter) { return parameter.min; });
  description.max = makeConfig(table, [](const Parameter& parameter) { return parameter.max; });
  description.dflt = toConfig({});
  return description;
}

Config toConfig(Parameters parameters) {
  return makeConfig(makeParameterTable(parameters),
                    [](const Parameter& parameter) { return parameter.get(); });
}

void applyConfig(const Config& config, Parameters& parameters) {
  Parameters changed = parameters;
  ParameterTable table = makeParameterTable(changed);
  const auto set = [&](const std::string& name, const std::string& value) {
    if (!isLive(name)) {
      throw std::invalid_argument("\"" + name + "\" cannot be changed while the odometry runs");
    }
    table.set(name, value);
  };
  for (const auto& entry : config.ints) set(entry.name, toText(entry.value));
  for (const auto& entry : config.doubles) set(entry.name, exactText(entry.value));
  for (const auto& entry : config.bools) set(entry.name, entry.value ? "true" : "false");
  for (const auto& entry : config.strs) set(entry.name, entry.value);
  parameters = changed;
}

LiveParameters::LiveParameters(ros::NodeHandle& private_nh,
                               const Parameters& parameters,
                               std::function<void(const OdometryConfig&)> on_change,
                               Log log)
    : private_nh_(private_nh),
      parameters_(parameters),
      on_change_(std::move(on_change)),
      log_(std::move(log)),
      descriptions_(advertise<dynamic_reconfigure::ConfigDescription>(
          private_nh, "parameter_descriptions", 1, true)),
      updates_(advertise<dynamic_reconfigure::Config>(private_nh, "parameter_updates", 1, true)),
      service_(advertiseService<dynamic_reconfigure::Reconfigure>(
          private_nh, "set_parameters", [this](auto& request, auto& response) {
            response.config = set(request.config);
            return true;
          })) {
  if (ros::isShuttingDown()) return;  // there are no publishers during shutdown
  descriptions_.publish(describeLiveParameters(parameters_));
  updates_.publish(toConfig(parameters_));
}

/// Returns all values, whether they have changed or not.
Config LiveParameters::set(const Config& config) {
  try {
    Parameters changed = parameters_;
    applyConfig(config, changed);
    on_change_(changed.odometry);  // may reject them, too
    // For the next start and for other nodes.
    for (const auto& entry : config.ints) private_nh_.setParam(entry.name, entry.value);
    for (const auto& entry : config.doubles) private_nh_.setParam(entry.name, entry.value);
    for (const auto& entry : config.bools) private_nh_.setParam(entry.name, entry.value != 0);
    for (const auto& entry : config.strs) private_nh_.setParam(entry.name, entry.value);
    const std::string what = changes(parameters_, changed);
    if (!what.empty()) log_.info("parameters changed: " + what);
    parameters_ = changed;
  } catch (const std::exception& error) {
    log_.warn(std::string("parameters not changed: ") + error.what());
  }
  const Config all = toConfig(parameters_);
  updates_.publish(all);
  return all;
}

}  // namespace rotrocc
