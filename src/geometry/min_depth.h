#pragma once

namespace rotrocc {

/// Points nearer to the image plane than this are projected as if they were there [m]: keeps the
/// residual of a wrong match finite.
constexpr double kMinDepth_m = 0.1;

}  // namespace rotrocc
