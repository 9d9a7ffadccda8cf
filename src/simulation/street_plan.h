#pragma once

#include <vector>

#include "simulation/path.h"

namespace rotrocc {

/// The centre lines of the streets along a path, `right_m` beside it and `beyond_m` longer at both
/// ends. Where the path comes within `same_street_m` of a street it already has passed, it drives
/// on that street and gets no second one.
std::vector<Path> streetsAlong(const Path& path,
                               double right_m,
                               double beyond_m,
                               double same_street_m);

}  // namespace rotrocc
