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

constexpr int kRows = 52;
const std::set<int> kRowsOfNodelet = {26, 40, 41, 49, 50, 51, 52};

const char* const kHead =
    R"(# Bad input

What the odometry makes of input that robots do send. The rows are observed by `bad_inputs_test` and,
where it takes a ROS master, by `bad_inputs_nodelet_test`, which drives the nodelet. Both fail if
this is out of date. To make it anew:

    export ROTROCC_UPDATE_FILES=1
    build/devel/lib/rotrocc/bad_inputs_test
    rostest rotrocc bad_inputs_nodelet.test

"; then" is what becomes of good input that follows. Of each pair that is ok, the motion is right
within 5 %, if nothing else is said.

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

/// The lines of the document that are rows, by number.
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
