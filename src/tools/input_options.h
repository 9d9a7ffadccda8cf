#pragma once

#include <memory>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "bags/recording.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Which recording a program reads, and by which parameters.
struct InputOptions {
  std::vector<std::string> paths;
  RecordingOptions recording;
  std::string rectify = "auto";
  std::string config;
  std::vector<std::string> assignments;
};

/// What `paths` may be, for the help.
extern const char* const kRecordingHelp;

/// config and set.
boost::program_options::options_description parameterOptions(InputOptions& options);

/// left-image, right-image, rectify and calibration.
boost::program_options::options_description imageOptions(InputOptions& options);

/// The parameters of the options. Throws as loadYaml() and ParameterTable::setAssignment().
Parameters readParameters(const InputOptions& options);

/// Throws as openRecording().
std::unique_ptr<Recording> openInput(const InputOptions& options, const NodeParameters& node);

}  // namespace rotrocc
