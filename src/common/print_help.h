#pragma once

#include <iostream>
#include <string_view>

namespace rotrocc {

/// Prints `help` if an argument asks for it, for programs without other options. Returns whether.
inline bool printHelp(int argc, char** argv, const char* help) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument != "-h" && argument != "--help") continue;
    std::cout << help;
    return true;
  }
  return false;
}

}  // namespace rotrocc
