#pragma once

#include <cstdlib>

namespace rotrocc {

/// Whether the build is about ten times slower, as with scripts/sanitize, which sets this. Tests
/// that render long drives then use shorter ones.
inline bool isSlowBuild() {
  return std::getenv("ROTROCC_SLOW_BUILD") != nullptr;
}

}  // namespace rotrocc
