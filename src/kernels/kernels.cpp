#include "kernels/kernels.h"

#include <opencv2/core.hpp>

#include "kernels/lanes.h"

namespace rotrocc {
namespace ROTROCC_INSTRUCTIONS {

static_assert(kShorts <= kMaxShorts);

extern const Kernels kernels;
const Kernels kernels = {smoothAlong,
                         smoothDown,
                         differentiateRow,
                         replaceGradients,
                         respondRow,
                         highestOfColumns,
                         findPeaks,
                         widenRows,
                         sampleRows,
                         correlateParts,
                         multiplyWindow,
                         takeWindow,
                         compareWindow,
                         fitDisparities,
                         linearize,
                         addProducts};

}  // namespace ROTROCC_INSTRUCTIONS

#if !CV_AVX2
#ifdef ROTROCC_HAS_AVX2
namespace avx2 {
extern const Kernels kernels;
}
#endif

const Kernels& chooseKernels() {
#ifdef ROTROCC_HAS_AVX2
  if (cv::checkHardwareSupport(CV_CPU_AVX2)) return avx2::kernels;
#endif
  return baseline::kernels;
}
#endif

}  // namespace rotrocc
