#pragma once

#include <string>
#include <vector>

namespace rotrocc {

/// The scenarios in which a car or a hand moves along a street by day.
inline std::vector<std::string> streetNames() {
  return {"city", "motorway", "slip_road", "parking", "shake", "handheld"};
}

}  // namespace rotrocc
