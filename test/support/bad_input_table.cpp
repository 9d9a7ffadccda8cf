#include "support/bad_input_table.h"

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

void BadInputTable::add(int row,
                        const std::string& input,
                        const std::string& expected,
                        const std::vector<std::string>& observed) {
  std::ostringstream text;
  text << "| " << row << " | " << input << " | " << expected << " | ";
  for (std::size_t i = 0; i < observed.size(); ++i) text << (i > 0 ? "; " : "") << observed[i];
  text << " |";
  rows_[row] = text.str();
}

void BadInputTable::expectInPage() const {
  std::map<int, std::string> rows = readRows();
  std::set<int> known_rows = kRowsOfNode;
  for (const auto& [row, text] : rows_) {
    known_rows.insert(row);
    rows[row] = text;
  }
  EXPECT_EQ(known_rows.size(), static_cast<std::size_t>(kRows));
  std::string text = kHead;
  for (int row = 1; row <= kRows; ++row) text += rows[row] + '\n';
  expectFileHolds(path(), text);
}

}  // namespace rotrocc
