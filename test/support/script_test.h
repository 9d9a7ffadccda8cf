#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/read_csv.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {

/// For tests of the results of a Python script, which runs once for all tests.
class ScriptTest : public ::testing::Test {
 protected:
  /// The output goes to the folder out of directory(). A script must choose the backend of
  /// matplotlib itself: the default one may need what is missing.
  static CommandResult run(const std::string& script, const std::string& arguments) {
    return runCommand(std::string("MPLBACKEND=module://none ") + PYTHON + " " + script +
                      " --programs " + PROGRAMS + " --output " + outputPath("") + " " + arguments);
  }
  /// Call by SetUpTestSuite().
  static void runScript(const std::string& script, const std::string& arguments) {
    result_ = run(script, arguments);
  }
  static void TearDownTestSuite() { directory_.reset(); }

  void SetUp() override { ASSERT_EQ(result_.status, 0) << result_.output; }

  static const std::string& printed() { return result_.output; }

  static const TemporaryDirectory& directory() {
    if (!directory_) directory_ = std::make_unique<TemporaryDirectory>();
    return *directory_;
  }
  static std::string outputPath(const std::string& name) { return directory() / "out/" + name; }

  /// The rows of NAME.csv; expects that there are some.
  static std::vector<CsvRow> readTable(const std::string& name) {
    const std::vector<CsvRow> rows = readCsv(outputPath(name + ".csv"));
    EXPECT_FALSE(rows.empty()) << name;
    return rows;
  }

  static double number(const CsvRow& row, const std::string& column) {
    return std::stod(row.at(column));
  }

 private:
  inline static std::unique_ptr<TemporaryDirectory> directory_;
  inline static CommandResult result_;
};

}  // namespace rotrocc
