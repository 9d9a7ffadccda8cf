#pragma once

#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

/// Smooths five rows vertically by (1 4 6 4 1).
void smoothDown(const std::uint8_t* const* rows, int columns, std::int16_t* sums);

/// Smooths every other value of the result of smoothDown() along the row, by (1 4 6 4 1) / 256 in
/// total, and rounds. Reads up to two values before the first and after the last one.
void smoothAlong(const std::int16_t* sums, int columns, std::uint8_t* out);

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
