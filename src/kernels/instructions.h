#pragma once

/// The sources of this folder are compiled once for any processor and, on x86, once more for AVX2,
/// each time into a namespace of their own. Those for AVX2 must not contain inline functions of
/// other namespaces, nor templates of the standard library: the linker keeps one of several copies
/// of such a function, which then might be one that only some processors can run.
#ifdef ROTROCC_AVX2
#define ROTROCC_INSTRUCTIONS avx2
#else
#define ROTROCC_INSTRUCTIONS baseline
#endif
