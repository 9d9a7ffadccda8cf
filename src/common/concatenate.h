#pragma once

#include <sstream>
#include <string>

namespace rotrocc {

/// Prints the parts one after the other into a string.
template <class... Parts>
std::string concatenate(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

}  // namespace rotrocc
