#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "rotrocc/parameters.h"

namespace rotrocc {

/// The parameters in the namespace of `private_nh`, with defaults for missing ones. Throws
/// std::invalid_argument as setParameters() and requireFrames() do.
Parameters readParameters(const ros::NodeHandle& private_nh);

/// Throws std::invalid_argument with the name on invalid or conflicting frames.
void requireFrames(const NodeParameters& node);

/// Sets every parameter of `tree`, whose structs are the sections of the table. Throws
/// std::invalid_argument with name and range on an unknown parameter, a wrong type or a value out
/// of range.
void setParameters(const XmlRpc::XmlRpcValue& tree, ParameterTable& table);

}  // namespace rotrocc
