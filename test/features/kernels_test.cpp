#include "kernels/kernels.h"

#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "support/run_command.h"

namespace rotrocc {
namespace {

TEST(KernelsTest, AreThoseOfTheProcessorUnlessToldOtherwise) {
#ifdef AVX2_OBJECTS
  const bool has_avx2 = cv::checkHardwareSupport(CV_CPU_AVX2);
#else
  const bool has_avx2 = false;
#endif
  const Kernels* widest = &chooseKernels();
  cv::setUseOptimized(false);
  EXPECT_EQ(&chooseKernels() != widest, has_avx2);
  cv::setUseOptimized(true);
  EXPECT_EQ(&chooseKernels(), widest);
}

#ifdef AVX2_OBJECTS
/// If they defined other functions, the linker might use them for all processors. OpenCV's
/// intrinsics remain functions if nothing is optimized.
TEST(KernelsTest, OfAvx2DefineNoFunctionThatOthersMightCall) {
  const CommandResult names = runCommand("nm --defined-only --extern-only " AVX2_OBJECTS);
  ASSERT_EQ(names.status, 0) << names.output;
  std::istringstream lines(names.output);
  int functions = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string address, type, name;
    if (!(words >> address >> type >> name)) continue;  // file name
    if (type != "T" && type != "W") continue;           // data
    const bool own = name.find("7rotrocc4avx2") != std::string::npos;
    EXPECT_TRUE(own || name.find("2cv8hal_AVX2") != std::string::npos) << line;
    ++functions;
  }
  EXPECT_GT(functions, 2) << names.output;
}
#endif

}  // namespace
}  // namespace rotrocc
