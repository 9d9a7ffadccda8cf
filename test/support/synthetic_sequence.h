#pragma once

#include <string>

namespace rotrocc {

/// Writes `pairs` pairs of a drive along the street of SyntheticScene, 0.5 m and up to 1 degree
/// from each to the next at 10 Hz, with ground truth, in the layout of KittiSequence.
void writeSyntheticSequence(const std::string& directory, int pairs);

}  // namespace rotrocc
