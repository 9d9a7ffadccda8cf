#pragma once

#include <functional>
#include <string>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

#include "input/log.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// The parameters of the estimator, all that have a section, as dynamic_reconfigure shows them:
/// names, ranges and descriptions from the parameter table, so no .cfg file is needed.
dynamic_reconfigure::ConfigDescription describeLiveParameters(Parameters parameters);
dynamic_reconfigure::Config toConfig(Parameters parameters);

/// Applies `config` to `parameters`. Throws std::invalid_argument and changes nothing on an unknown
/// name, one that cannot be changed live, or a value out of range.
void applyConfig(const dynamic_reconfigure::Config& config, Parameters& parameters);

/// Serves these to rqt_reconfigure, dynparam and the like in the namespace of `private_nh`, and
/// keeps the parameter server up to date.
class LiveParameters {
 public:
  /// `on_change` gets the whole configuration after each change.
  LiveParameters(ros::NodeHandle& private_nh,
                 const Parameters& parameters,
                 std::function<void(const OdometryConfig&)> on_change,
                 Log log);

 private:
  dynamic_reconfigure::Config set(const dynamic_reconfigure::Config& config);

  ros::NodeHandle private_nh_;
  Parameters parameters_;
  std::function<void(const OdometryConfig&)> on_change_;
  Log log_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::ServiceServer service_;
};

}  // namespace rotrocc
