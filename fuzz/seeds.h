#pragma once

#include <map>
#include <string>

namespace rotrocc {

/// Inputs by name.
using Seeds = std::map<std::string, std::string>;

/// Valid inputs of a fuzzer: "files" or "odometry". Throws std::invalid_argument for another name,
/// and std::runtime_error if the default parameters cannot be read.
Seeds seedsOf(const std::string& fuzzer);

}  // namespace rotrocc
