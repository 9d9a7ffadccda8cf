#pragma once

#include <cstdlib>

namespace rotrocc {

/// Whether everything is ten times as slow, as with the sanitizers of scripts/sanitize, which sets
/// this. Tests that render long drives then take shorter ones.
inline bool isSlowBuild() {
  return std::getenv("ROTROCC_SLOW_BUILD") != nullptr;
}

}  // namespace rotrocc
