#pragma once

/// The sources in this folder are compiled once for any processor and, on x86, again for AVX2, each
/// time into a separate namespace. The compiler vectorizes plain loops. The sources for AVX2 must
/// not contain inline functions of other namespaces, nor templates of the standard library: the
/// linker keeps only one of several copies of such a function, and this might be a copy that not
/// all processors can execute.
#ifndef ROTROCC_INSTRUCTIONS
#define ROTROCC_INSTRUCTIONS baseline
#endif
