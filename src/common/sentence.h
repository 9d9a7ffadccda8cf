#pragma once

#include <sstream>
#include <string>

namespace rotrocc {

/// The parts, printed one after the other.
template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

}  // namespace rotrocc
