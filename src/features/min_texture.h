#pragma once

namespace rotrocc {

/// The smaller eigenvalue of the second moments of the gradients below which a window cannot be
/// located: (grey levels / px)^2. Six times what rounding to whole grey levels makes: its variance
/// of 1/12 gives Sobel and Scharr gradients one of 1/64.
constexpr float kMinTexture = 0.1F;

}  // namespace rotrocc
