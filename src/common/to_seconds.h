#pragma once

#include <cstdint>

namespace rotrocc {

/// Of a stamp, or a difference of stamps.
inline double toSeconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace rotrocc
