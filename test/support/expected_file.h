#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "support/read_file.h"

namespace rotrocc {

/// Expects that the content of a generated file of the source tree is `text`. With
/// ROTROCC_UPDATE_FILES=1 in the environment the file is written instead.
inline void expectFileHolds(const std::string& path, const std::string& text) {
  const char* update = std::getenv("ROTROCC_UPDATE_FILES");
  if (update != nullptr && std::string(update) == "1") {
    std::ofstream(path) << text;
    return;
  }
  EXPECT_EQ(readFile(path), text) << path
                                  << " is out of date: run this test with ROTROCC_UPDATE_FILES=1";
}

}  // namespace rotrocc
