#pragma once

#include "kernels/corner_kernels.h"
#include "kernels/fit_kernels.h"
#include "kernels/half_image_kernels.h"
#include "kernels/sad_kernels.h"
#include "kernels/window_kernels.h"

namespace rotrocc {

/// The inner loops over pixels and features, for one kind of processor. What they find is the same
/// for all: they add integers, and floats in no order that the width of a register decides.
struct Kernels {
  int shorts;  ///< 16-bit numbers of a register, at most kMostShorts

  decltype(&ROTROCC_INSTRUCTIONS::smoothDown) smoothDown;
  decltype(&ROTROCC_INSTRUCTIONS::smoothAlong) smoothAlong;
  decltype(&ROTROCC_INSTRUCTIONS::differentiateRow) differentiateRow;
  decltype(&ROTROCC_INSTRUCTIONS::replaceGradients) replaceGradients;
  decltype(&ROTROCC_INSTRUCTIONS::respondRow) respondRow;
  decltype(&ROTROCC_INSTRUCTIONS::highestOfColumns) highestOfColumns;
  decltype(&ROTROCC_INSTRUCTIONS::findPeaks) findPeaks;
  decltype(&ROTROCC_INSTRUCTIONS::sadCosts) sadCosts;
  decltype(&ROTROCC_INSTRUCTIONS::sadCost) sadCost;
  decltype(&ROTROCC_INSTRUCTIONS::takeWindow) takeWindow;
  decltype(&ROTROCC_INSTRUCTIONS::compareWindow) compareWindow;
  decltype(&ROTROCC_INSTRUCTIONS::fitDisparities) fitDisparities;
};

/// Numbers that a row needs beyond its end, where whole registers are read and written.
constexpr int kMostShorts = 16;

/// Those for AVX2 if the processor has it, else those for any. With cv::setUseOptimized(false), or
/// OPENCV_CPU_DISABLE=AVX2 in the environment, those for any.
const Kernels& chooseKernels();

}  // namespace rotrocc
