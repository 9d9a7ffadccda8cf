#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/read_csv.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {

/// For tests of the results of a Python script in its short form, which runs once for all tests.
class ScriptTest : public ::testing::Test {
 protected:
  /// To be called by SetUpTestSuite(). The script's output goes to the folder out of directory().
  /// It must choose the backend of matplotlib itself: the default one may need what is missing.
  static void runScript(const std::string& script, const std::string& options = "") {
    result_ = runCommand(std::string("MPLBACKEND=module://none ") + PYTHON + " " + script +
                         " --short --programs " + PROGRAMS + " --output " + outputPath("") + " " +
                         options);
  }
  static void TearDownTestSuite() { directory_.reset(); }

  void SetUp() override { ASSERT_EQ(result_.status, 0) << result_.output; }

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
