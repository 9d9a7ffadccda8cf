#include "node/live_parameters.h"

#include <stdexcept>
#include <utility>

#include <ros/init.h>

#include "input/to_text.h"
#include "node/advertise.h"

namespace rotrocc {
namespace {

using Parameter = ParameterTable::Parameter;
using Type = Parameter::Type;

bool isLive(const Parameter& parameter) {
  return parameter.name.find('/') != std::string::npos;
}

std::string sectionOf(const Parameter& parameter) {
  return parameter.name.substr(0, parameter.name.find('/'));
}

const char* typeName(Type type) {
  switch (type) {
    case Type::kInt:
      return "int";
    case Type::kDouble:
      return "double";
    case Type::kBool:
      return "bool";
    case Type::kText:
      break;
  }
  return "str";
}

template <class Entry, class Value>
Entry makeEntry(const std::string& name, const Value& value) {
  Entry entry;
  entry.name = name;
  entry.value = value;
  return entry;
}

void append(const std::string& name,
            Type type,
            const std::string& value,
            dynamic_reconfigure::Config& config) {
  switch (type) {
    case Type::kInt:
      config.ints.push_back(makeEntry<dynamic_reconfigure::IntParameter>(name, std::stoi(value)));
      break;
    case Type::kDouble:
      config.doubles.push_back(
          makeEntry<dynamic_reconfigure::DoubleParameter>(name, std::stod(value)));
      break;
    case Type::kBool:
      config.bools.push_back(makeEntry<dynamic_reconfigure::BoolParameter>(name, value == "true"));
      break;
    case Type::kText:
      config.strs.push_back(makeEntry<dynamic_reconfigure::StrParameter>(name, value));
      break;
  }
}

/// The drop-down list of rqt_reconfigure: a Python dictionary.
std::string choiceMenu(const Parameter& parameter) {
  if (parameter.choices.empty()) return "";
  std::string entries;
  for (const std::string& choice : parameter.choices) {
    entries += (entries.empty() ? "" : ", ") + std::string("{'name': '") + choice +
               "', 'value': '" + choice + "', 'type': 'str', 'description': ''}";
  }
  return "{'enum_description': '', 'enum': [" + entries + "]}";
}

dynamic_reconfigure::ParamDescription describe(const Parameter& parameter) {
  dynamic_reconfigure::ParamDescription description;
  description.name = parameter.name;
  description.type = typeName(parameter.type);
  description.description =
      (parameter.unit.empty() ? "" : "[" + parameter.unit + "] ") + parameter.description;
  description.edit_method = choiceMenu(parameter);
  return description;
}

dynamic_reconfigure::Group makeGroup(const std::string& name, int id) {
  dynamic_reconfigure::Group group;
  group.name = name;
  group.id = id;
  group.parent = 0;
  return group;
}

void appendGroupState(const dynamic_reconfigure::Group& group,
                      dynamic_reconfigure::Config& config) {
  dynamic_reconfigure::GroupState state;
  state.name = group.name;
  state.state = true;
  state.id = group.id;
  state.parent = group.parent;
  config.groups.push_back(state);
}

}  // namespace

dynamic_reconfigure::ConfigDescription describeLiveParameters(Parameters parameters) {
  dynamic_reconfigure::ConfigDescription description;
  description.groups.push_back(makeGroup("Default", 0));
  const ParameterTable table = makeParameterTable(parameters);
  for (const Parameter& parameter : table.parameters()) {
    if (!isLive(parameter)) continue;
    if (description.groups.back().name != sectionOf(parameter)) {
      const int id = static_cast<int>(description.groups.size());
      description.groups.push_back(makeGroup(sectionOf(parameter), id));
    }
    description.groups.back().parameters.push_back(describe(parameter));
    append(parameter.name, parameter.type, parameter.min, description.min);
    append(parameter.name, parameter.type, parameter.max, description.max);
  }
  for (const dynamic_reconfigure::Group& group : description.groups) {
    appendGroupState(group, description.min);
    appendGroupState(group, description.max);
  }
  description.dflt = toConfig({});
  return description;
}

dynamic_reconfigure::Config toConfig(Parameters parameters) {
  dynamic_reconfigure::Config config;
  auto group = makeGroup("Default", 0);
  appendGroupState(group, config);
  const ParameterTable table = makeParameterTable(parameters);
  for (const Parameter& parameter : table.parameters()) {
    if (!isLive(parameter)) continue;
    if (group.name != sectionOf(parameter)) {
      group = makeGroup(sectionOf(parameter), group.id + 1);
      appendGroupState(group, config);
    }
    append(parameter.name, parameter.type, parameter.get(), config);
  }
  return config;
}

void applyConfig(const dynamic_reconfigure::Config& config, Parameters& parameters) {
  Parameters changed = parameters;
  ParameterTable table = makeParameterTable(changed);
  const auto set = [&](const std::string& name, const std::string& value) {
    if (name.find('/') == std::string::npos) {
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
                               Handler on_change,
                               Log log)
    : private_nh_(private_nh),
      parameters_(parameters),
      on_change_(std::move(on_change)),
      log_(std::move(log)),
      descriptions_(advertise<dynamic_reconfigure::ConfigDescription>(
          private_nh, "parameter_descriptions", 1, true)),
      updates_(advertise<dynamic_reconfigure::Config>(private_nh, "parameter_updates", 1, true)),
      service_(advertiseService(private_nh, "set_parameters", &LiveParameters::onSet, this)) {
  if (ros::isShuttingDown()) return;  // there are no publishers during shutdown
  descriptions_.publish(describeLiveParameters(parameters_));
  updates_.publish(toConfig(parameters_));
}

bool LiveParameters::onSet(dynamic_reconfigure::Reconfigure::Request& request,
                           dynamic_reconfigure::Reconfigure::Response& response) {
  try {
    applyConfig(request.config, parameters_);
    store(request.config);
    on_change_(parameters_.odometry);
  } catch (const std::exception& error) {
    log_.warn(std::string("parameters not changed: ") + error.what());
  }
  response.config = toConfig(parameters_);
  updates_.publish(response.config);
  return true;
}

/// Stores changes on the parameter server, for the next start and for other nodes.
void LiveParameters::store(const dynamic_reconfigure::Config& config) {
  for (const auto& entry : config.ints) private_nh_.setParam(entry.name, entry.value);
  for (const auto& entry : config.doubles) private_nh_.setParam(entry.name, entry.value);
  for (const auto& entry : config.bools) private_nh_.setParam(entry.name, entry.value != 0);
  for (const auto& entry : config.strs) private_nh_.setParam(entry.name, entry.value);
}

}  // namespace rotrocc
