#pragma once

/// Registers of 16-bit integers (Shorts), 32-bit integers (Ints, half as many) and floats (Floats),
/// in the width of the processor, and the operations that the kernels need.
#include "kernels/instructions.h"

#if defined ROTROCC_AVX2
#include "kernels/lanes_avx2.h"
#else
#include "kernels/lanes_baseline.h"
#endif
