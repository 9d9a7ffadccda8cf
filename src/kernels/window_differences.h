#pragma once

/// WindowDifferences: sums of absolute differences to one left window, with 128-bit registers.
#include "kernels/instructions.h"

#ifdef ROTROCC_NEON
#include "kernels/window_differences_neon.h"
#else
#include "kernels/window_differences_baseline.h"
#endif
