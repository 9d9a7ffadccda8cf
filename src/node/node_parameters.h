#pragma once

#include <stdexcept>
#include <string>

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "rotrocc/parameters.h"

namespace rotrocc {

/// A parameter that is unknown, invalid or in conflict with another one.
class RejectedParameter : public std::invalid_argument {
 public:
  RejectedParameter(const std::string& name, const std::string& why)
      : std::invalid_argument(why), name_(name) {}

  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

/// The parameters in the namespace of `private_nh`, with defaults for missing ones. Throws
/// std::invalid_argument as setParameters() and requireFrames() do, with the command that deletes
/// the parameter from the server.
Parameters readParameters(const ros::NodeHandle& private_nh);

/// Throws RejectedParameter with the name on invalid or conflicting frames.
void requireFrames(const NodeParameters& node);

/// Sets every parameter of `tree`, whose structs are the sections of the table, but for those that
/// libraries read; or those below the section or parameter `name`. Throws RejectedParameter with
/// name and range on an unknown parameter, a wrong type or a value out of range.
void setParameters(XmlRpc::XmlRpcValue tree, ParameterTable& table, const std::string& name = "");

}  // namespace rotrocc
