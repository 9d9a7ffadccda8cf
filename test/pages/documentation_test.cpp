// The links of the README and the pages.

#include <cctype>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "pages/pages.h"
#include "support/read_file.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// As GitHub makes it of a heading.
std::string anchorOf(const std::string& heading) {
  std::string anchor;
  for (const unsigned char letter : heading) {
    if (letter == ' ') anchor += '-';
    if (std::isalnum(letter) != 0 || letter == '-' || letter == '_') {
      anchor += static_cast<char>(std::tolower(letter));
    }
  }
  return anchor;
}

bool hasAnchor(const fs::path& page, const std::string& anchor) {
  std::istringstream text(readFile(page));
  for (std::string line; std::getline(text, line);) {
    if (line.rfind('#', 0) == 0 && anchorOf(line.substr(line.find(' ') + 1)) == anchor) return true;
  }
  return false;
}

TEST(DocumentationTest, LinksLeadSomewhere) {
  static const std::regex link(R"(\]\(([^)#\s]*)(?:#([^)\s]*))?\))");
  int links = 0;
  for (const fs::path& page : pages()) {
    const std::string text = readFile(page);
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match) {
      const std::string file = (*match)[1], anchor = (*match)[2];
      if (file.rfind("http", 0) == 0) continue;
      const fs::path target = file.empty() ? page : page.parent_path() / file;
      EXPECT_TRUE(fs::exists(target)) << page << " links to " << file;
      if (!anchor.empty()) {
        EXPECT_TRUE(hasAnchor(target, anchor)) << page << ": " << file << '#' << anchor;
      }
      ++links;
    }
  }
  EXPECT_GT(links, 50);
}

/// A page that nothing links to is not found.
TEST(DocumentationTest, EveryPageIsLinkedFromTheReadme) {
  const std::string readme = readFile(fs::path(ROOT) / "README.md");
  for (const fs::path& page : pages()) {
    if (page == pages().front()) continue;
    const std::string link = "](" + fs::relative(page, ROOT).string();
    EXPECT_NE(readme.find(link), std::string::npos) << page;
  }
}

}  // namespace
}  // namespace rotrocc
