#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

namespace rotrocc {

/// README.md first, then those of the folders docs and simulation by name.
inline std::vector<std::filesystem::path> pages() {
  namespace fs = std::filesystem;
  const fs::path root(ROOT);
  std::vector<fs::path> pages = {root / "README.md"};
  for (const char* folder : {"docs", "simulation"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(root / folder)) {
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
    }
  }
  std::sort(pages.begin() + 1, pages.end());
  return pages;
}

}  // namespace rotrocc
