#pragma once

/// Registers of 16-bit integers (Shorts), 32-bit ones (Ints, half as many) and floats (Floats), as
/// wide as the processor has them, and what the kernels do with them.
#include "kernels/instructions.h"

#ifdef ROTROCC_AVX2
#include "kernels/lanes_avx2.h"
#else
#include "kernels/lanes_baseline.h"
#endif
