#pragma once

#include <cstdio>
#include <cstdlib>

namespace rotrocc {

/// What must hold of an answer, whatever came in; else the fuzzer has found something.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace rotrocc
