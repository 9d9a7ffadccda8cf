#include "tools/progress_bar.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

// gtest captures stderr in a file, which is no terminal.
std::string outputOf(std::size_t total, int advances) {
  testing::internal::CaptureStderr();
  ProgressBar bar("work", total);
  for (int i = 0; i < advances; ++i) bar.advance();
  bar.finish();
  return testing::internal::GetCapturedStderr();
}

auto lineCount(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

TEST(ProgressBarTest, PrintsALineForEveryTenthOffATerminal) {
  const std::string output = outputOf(1000, 1000);
  EXPECT_EQ(lineCount(output), 10);
  EXPECT_EQ(output.find('\r'), std::string::npos);
  EXPECT_EQ(output.rfind("work  10 %  100/1000", 0), 0u) << output;
  EXPECT_NE(output.find("work 100 %  1000/1000"), std::string::npos) << output;
  EXPECT_EQ(lineCount(outputOf(3, 3)), 3) << "each step once, if there are few";
  EXPECT_NE(outputOf(0, 0).find("100 %  0/0"), std::string::npos) << "nothing to do is done";
  const std::string early_end = outputOf(100, 15);
  EXPECT_EQ(lineCount(early_end), 2);
  EXPECT_NE(early_end.find("work  15 %  15/100"), std::string::npos) << early_end;
}

}  // namespace
}  // namespace rotrocc
