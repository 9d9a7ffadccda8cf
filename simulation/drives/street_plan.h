#pragma once

#include <vector>

#include "simulation/street/path.h"

namespace rotrocc {

/// The centre lines of the streets along a path, `right_m` beside it and `beyond_m` longer at both
/// ends. Where the path comes within `same_street_m` of an earlier street, it reuses that street.
std::vector<Path> streetsAlong(const Path& path,
                               double right_m,
                               double beyond_m,
                               double same_street_m);

}  // namespace rotrocc
