#pragma once

#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc::ROTROCC_INSTRUCTIONS {

/// Smooths five rows downwards by (1 4 6 4 1).
void smoothDown(const std::uint8_t* const* rows, int columns, std::int16_t* sums);

/// Smooths every other number of what smoothDown() made along the row, by (1 4 6 4 1) / 256 in all,
/// and rounds. Reads up to two numbers before the first one and after the last one.
void smoothAlong(const std::int16_t* sums, int columns, std::uint8_t* out);

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
