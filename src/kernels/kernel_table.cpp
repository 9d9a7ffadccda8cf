#include "kernels/kernels.h"
#include "kernels/lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

extern const Kernels kernels;
const Kernels kernels = {kShorts,          smoothDown,   smoothAlong,       differentiateRow,
                         replaceGradients, respondRow,   highestOfColumns,  findPeaks,
                         widenRows,        sampleRows,   correlateParts,    multiplyWindow,
                         takeWindow,       takeContrast, compareWindow,     fitDisparities,
                         findResiduals,    linearise,    addColumnProducts, multiplyByDisparity};
static_assert(kShorts <= kMaxShorts);

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
