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
const std::set<int> kRowsOfNodelet = {26, 40, 41, 49, 50, 51, 52};

const char* const kHead =
    R"(# Bad input

How the odometry handles bad input that occurs on robots. `bad_inputs_test` writes the table; the rows
that need a ROS master come from `bad_inputs_nodelet_test`, which runs the nodelet. Both tests fail
if this file is out of date. To update it:

    export ROTROCC_UPDATE_FILES=1
    build/devel/lib/rotrocc/bad_inputs_test
    rostest rotrocc bad_inputs_nodelet.test

"; then" is the state after the valid pairs that follow. The motion of each pair that is ok is within
5 % of the truth, unless the row says otherwise.

| | input | expected | observed |
|---|---|---|---|
)";

std::string path() {
  return std::string(ROTROCC_DOCS_DIR) + "/bad_inputs.md";
}

std::set<int> rowsOf(Observer observer) {
  if (observer == Observer::kNodelet) return kRowsOfNodelet;
  std::set<int> rows;
  for (int row = 1; row <= kRows; ++row) {
    if (kRowsOfNodelet.count(row) == 0) rows.insert(row);
  }
  return rows;
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

void expectRows(Observer observer, const std::vector<BadInput>& inputs) {
  std::map<int, std::string> rows = readRows();
  std::set<int> observed_rows;
  for (const BadInput& input : inputs) {
    const std::string observed = input.observe();
    EXPECT_TRUE(matches(observed, input.pattern))
        << "row " << input.row << ", " << input.input << ":\n  " << observed << "\nis not\n  "
        << input.pattern;
    observed_rows.insert(input.row);
    std::ostringstream row;
    row << "| " << input.row << " | " << input.input << " | " << input.expected << " | " << observed
        << " |";
    rows[input.row] = row.str();
  }
  EXPECT_EQ(observed_rows, rowsOf(observer));
  std::string text = kHead;
  for (int row = 1; row <= kRows; ++row) text += rows[row] + '\n';
  expectFileHolds(path(), text);
}

}  // namespace rotrocc
