#include "support/bad_input_table.h"

#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "support/expected_file.h"

namespace rotrocc {
namespace {

constexpr int kRows = 58;
/// What the tests of the node show.
const std::set<int> kRowsOfNode = {26, 40, 41, 49, 50, 51, 52};

const char* const kHead =
    R"(# Bad input

How the odometry handles bad input that occurs on robots. `bad_inputs_test` observes it, and fails
if the table is out of date; rows 26, 40, 41 and 49 to 52 are those of the tests in test/node. To
update it:

    ROTROCC_UPDATE_FILES=1 build/devel/lib/rotrocc/bad_inputs_test

"; then" is the state after the valid pairs that follow. The motion of each pair that is ok is within
5 % of the truth, unless the row says otherwise.

| | input | expected | observed |
|---|---|---|---|
)";

std::string path() {
  return std::string(ROTROCC_DOCS_DIR) + "/bad_inputs.md";
}

bool matches(const std::string& text, const std::string& pattern) {
  std::string expression;
  for (const char c : pattern) {
    if (c == '*') {
      expression += ".*";
    } else {
      if (std::ispunct(static_cast<unsigned char>(c)) != 0) expression += '\\';
      expression += c;
    }
  }
  return std::regex_match(text, std::regex(expression));
}

/// The rows of the document by number.
std::map<int, std::string> readRows() {
  std::map<int, std::string> rows;
  std::istringstream lines(readFile(path()));
  for (std::string line; std::getline(lines, line);) {
    int row = 0;
    if (std::istringstream(line.substr(0, line.find('|', 1))).ignore() >> row) rows[row] = line;
  }
  return rows;
}

}  // namespace

void expectRows(const std::vector<BadInput>& inputs) {
  std::map<int, std::string> rows = readRows();
  std::set<int> known_rows = kRowsOfNode;
  for (const BadInput& input : inputs) {
    const std::string observed = input.observe();
    EXPECT_TRUE(matches(observed, input.pattern))
        << "row " << input.row << ", " << input.input << ":\n  " << observed << "\nis not\n  "
        << input.pattern;
    known_rows.insert(input.row);
    std::ostringstream row;
    row << "| " << input.row << " | " << input.input << " | " << input.expected << " | " << observed
        << " |";
    rows[input.row] = row.str();
  }
  EXPECT_EQ(known_rows.size(), static_cast<std::size_t>(kRows));
  std::string text = kHead;
  for (int row = 1; row <= kRows; ++row) text += rows[row] + '\n';
  expectFileHolds(path(), text);
}

}  // namespace rotrocc
