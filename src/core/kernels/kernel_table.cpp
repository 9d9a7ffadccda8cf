#include "kernels.h"
#include "lanes.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

extern const Kernels kernels;
const Kernels kernels = {kShorts, takeWindow, compareWindow, sadCosts, sadCost};

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
