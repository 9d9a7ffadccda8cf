#include "node/node_parameters.h"

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "input/to_text.h"

namespace rotrocc {
namespace {

/// A value as text for the table, with all digits. XmlRpcValue has non-const conversions only.
std::string textOf(const std::string& name, XmlRpc::XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeDouble:
      return exactText(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    default:
      throw std::invalid_argument("parameter " + name + " is neither a value nor a section");
  }
}

/// Sets a value or a list.
void setOne(const std::string& name, XmlRpc::XmlRpcValue value, ParameterTable& table) {
  try {
    if (value.getType() != XmlRpc::XmlRpcValue::TypeArray) {
      return table.set(name, textOf(name, value));
    }
    std::vector<std::string> elements;
    for (int i = 0; i < value.size(); ++i) elements.push_back(textOf(name, value[i]));
    table.setList(name, elements);
  } catch (const std::invalid_argument& error) {
    throw RejectedParameter(name, error.what());
  }
}

/// Of image_transport: its plugins write parameters below the topics of images, which may be in the
/// private namespace, and below the names of transports.
bool isOfImageTransport(const std::string& name, const XmlRpc::XmlRpcValue& value) {
  static const std::set<std::string> kSections = {
      "left", "right", "flow", "compressed", "compressedDepth", "theora"};
  return value.getType() == XmlRpc::XmlRpcValue::TypeStruct && kSections.count(name) > 0;
}

void requireFrame(const std::string& name, const std::string& frame, bool may_be_empty = false) {
  if (frame.empty() ? may_be_empty : frame.front() != '/') return;
  throw RejectedParameter(
      name,
      "parameter " + name + " is \"" + frame + "\", but must be a tf frame without leading slash");
}

void requireDifferent(const std::string& name,
                      const std::string& frame,
                      const std::string& other_name,
                      const std::string& other_frame) {
  if (frame != other_frame) return;
  throw RejectedParameter(
      name,
      "parameters " + name + " and " + other_name + " are both \"" + frame + "\", but must differ");
}

}  // namespace

Parameters readParameters(const ros::NodeHandle& private_nh) {
  const std::string& ns = private_nh.getNamespace();
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
  const auto reject = [&ns](const std::string& name, const std::string& why) {
    // Parameters stay on the server when a node ends, so the user may not know of this one.
    throw std::invalid_argument(why + ". If it is left from an earlier run: rosparam delete " + ns +
                                "/" + name);
  };
  try {
    XmlRpc::XmlRpcValue tree;
    if (private_nh.getParam(ns, tree)) setParameters(tree, table);
    requireFrames(parameters.node);
  } catch (const RejectedParameter& error) {
    reject(error.name(), error.what());
  }
  return parameters;
}

void requireFrames(const NodeParameters& node) {
  requireFrame("odom_frame", node.odom_frame);
  requireFrame("base_frame", node.base_frame);
  requireFrame("camera_frame", node.camera_frame, true);
  requireFrame("guess_frame", node.guess_frame, true);
  requireDifferent("odom_frame", node.odom_frame, "base_frame", node.base_frame);
  requireDifferent("guess_frame", node.guess_frame, "odom_frame", node.odom_frame);
  requireDifferent("guess_frame", node.guess_frame, "base_frame", node.base_frame);
  if (!node.guess_frame.empty() && !node.guess_topic.empty()) {
    throw RejectedParameter("guess_topic",
                            "parameters guess_frame and guess_topic are both set, but only one "
                            "odometry is used: set guess_topic only if that sends no tf");
  }
  if (!node.guess_frame.empty() && node.invert_tf) {
    throw RejectedParameter(
        "invert_tf",
        "parameter invert_tf cannot be combined with guess_frame: the published transform is then "
        "odom_frame to guess_frame");
  }
}

void setParameters(XmlRpc::XmlRpcValue tree, ParameterTable& table, const std::string& name) {
  if (name == "diagnostic_period" || isOfImageTransport(name, tree)) return;
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return setOne(name, tree, table);
  for (auto& [key, child] : tree) {
    setParameters(child, table, name.empty() ? key : name + "/" + key);
  }
}

}  // namespace rotrocc
