#pragma once

#include "kernels/correlation_kernels.h"
#include "kernels/image_kernels.h"
#include "kernels/reprojection_kernels.h"
#include "kernels/window_kernels.h"

namespace rotrocc {

/// The inner loops over pixels and features, for one kind of processor. Results are the same for
/// all kinds: integer sums are exact, and the order of floating-point sums does not depend on the
/// register width.
struct Kernels {
  decltype(&ROTROCC_INSTRUCTIONS::smoothAlong) smoothAlong;
  decltype(&ROTROCC_INSTRUCTIONS::smoothDown) smoothDown;
  decltype(&ROTROCC_INSTRUCTIONS::differentiateRow) differentiateRow;
  decltype(&ROTROCC_INSTRUCTIONS::replaceGradients) replaceGradients;
  decltype(&ROTROCC_INSTRUCTIONS::respondRow) respondRow;
  decltype(&ROTROCC_INSTRUCTIONS::highestOfColumns) highestOfColumns;
  decltype(&ROTROCC_INSTRUCTIONS::findPeaks) findPeaks;
  decltype(&ROTROCC_INSTRUCTIONS::widenRows) widenRows;
  decltype(&ROTROCC_INSTRUCTIONS::sampleRows) sampleRows;
  decltype(&ROTROCC_INSTRUCTIONS::correlateParts) correlateParts;
  decltype(&ROTROCC_INSTRUCTIONS::multiplyWindow) multiplyWindow;
  decltype(&ROTROCC_INSTRUCTIONS::takeWindow) takeWindow;
  decltype(&ROTROCC_INSTRUCTIONS::compareWindow) compareWindow;
  decltype(&ROTROCC_INSTRUCTIONS::fitDisparities) fitDisparities;
  decltype(&ROTROCC_INSTRUCTIONS::linearize) linearize;
  decltype(&ROTROCC_INSTRUCTIONS::addProducts) addProducts;
};

/// Largest number of 16-bit values in a register. Rows need as many values beyond their end,
/// because whole registers are read and written.
constexpr int kMaxShorts = 16;

/// The kernels for AVX2 if the processor has it, otherwise those for any processor. The latter are
/// also chosen by cv::setUseOptimized(false), or by OPENCV_CPU_DISABLE=AVX2 in the environment.
const Kernels& chooseKernels();

}  // namespace rotrocc
