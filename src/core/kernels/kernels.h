#pragma once

#include "sad_kernels.h"
#include "window_kernels.h"

namespace rotrocc {

/// The inner loops over pixels, for one kind of processor. What they find is the same for all:
/// they add integers, and floats in no order that the width of a register decides.
struct Kernels {
  int shorts;  ///< 16-bit numbers of a register
  GradientSums (*takeWindow)(const Patch&, Window);
  MismatchSums (*compareWindow)(const Patch&, const Window&);
  void (*sadCosts)(const SadSearch&, std::int16_t* costs);
  int (*sadCost)(const SadSearch&, int k);
};

/// Those for AVX2 if the processor has it, else those for any. With cv::setUseOptimized(false), or
/// OPENCV_CPU_DISABLE=AVX2 in the environment, those for any.
const Kernels& chooseKernels();

}  // namespace rotrocc
