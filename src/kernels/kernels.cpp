#include "kernels/kernels.h"

#include <opencv2/core.hpp>

namespace rotrocc {

namespace baseline {
extern const Kernels kernels;
}
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

}  // namespace rotrocc
