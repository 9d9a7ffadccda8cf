#pragma once

#include <cstdio>
#include <cstdlib>

namespace rotrocc {

/// A condition that must hold for any input. If it does not, the fuzzer has found an error.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace rotrocc
