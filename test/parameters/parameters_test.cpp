#include "rotrocc/parameters.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/expected_file.h"
#include "support/parameter_file.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Parameters with their table.
struct Settings {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
};

std::vector<std::string> values(const ParameterTable& table) {
  std::vector<std::string> all;
  for (const auto& parameter : table.parameters()) {
    all.push_back(parameter.name + " = " + parameter.get());
  }
  return all;
}

/// Values that are all allowed, at the ends of their ranges.
std::vector<std::string> allowedValues(const ParameterTable::Parameter& parameter) {
  std::istringstream range(parameter.range);
  if (range.get() == '[') {
    std::string min, max;
    std::getline(range, min, ',');
    std::getline(range >> std::ws, max, ']');
    return {min, max};
  }
  if (parameter.range == "true or false") return {"true", "false"};
  if (parameter.range == "any text") return {"some words", ""};
  if (parameter.range == "6 numbers") return {"0 0 0 0 0 -3.5", "1 2 3 0.1 0.2 0.3"};
  std::istringstream choices(parameter.range.substr(std::string("one of ").size()));
  std::vector<std::string> words;
  for (std::string word; std::getline(choices >> std::ws, word, ',');) words.push_back(word);
  return words;
}

TEST(ParametersTest, TheDefaultFileHoldsEveryParameterAtItsDefault) {
  const std::string path = std::string(ROTROCC_CONFIG_DIR) + "/default.yaml";
  const std::string file = readFile(path);
  // Above the table are only comments, which end with an empty line.
  const std::string header = file.substr(0, file.find("\n\n") + 2);
  std::istringstream lines(header);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.empty() || line.front() == '#') << line;
  }
  expectFileHolds(path, header + toYaml(Settings().table));
}

TEST(ParametersTest, ShippedFilesLoad) {
  for (const std::string name : {"default", "fast", "paper"}) {
    Settings settings;
    const std::string path = std::string(ROTROCC_CONFIG_DIR) + "/" + name + ".yaml";
    EXPECT_NO_THROW(loadYaml(path, settings.table)) << name;
  }
}

TEST(ParametersTest, EveryValueThatIsSetIsReadBack) {
  Settings settings;
  for (const auto& parameter : settings.table.parameters()) {
    for (const std::string& value : allowedValues(parameter)) {
      settings.table.set(parameter.name, value);
      EXPECT_EQ(parameter.get(), value) << parameter.name;
    }
  }
}

TEST(ParametersTest, EveryParameterIsAVariableOfItsOwn) {
  // Otherwise, setting one would change another or nothing.
  Settings settings;
  const std::vector<std::string> defaults = values(settings.table);
  for (std::size_t i = 0; i < defaults.size(); ++i) {
    Settings changed;
    const auto& parameter = changed.table.parameters()[i];
    const std::string before = parameter.get();
    for (const std::string& value : allowedValues(parameter)) {
      if (parameter.get() == before) changed.table.set(parameter.name, value);
    }
    const std::vector<std::string> now = values(changed.table);
    for (std::size_t k = 0; k < defaults.size(); ++k) {
      EXPECT_EQ(now[k] == defaults[k], k != i) << parameter.name << " and " << now[k];
    }
  }
}

TEST(ParametersTest, TheTableSetsWhatTheEstimatorReads) {
  Settings settings;
  settings.table.setAssignment("feature_detector/max_features=777");
  settings.table.setAssignment("motion_estimator/criterion=std_based");
  settings.table.setAssignment("motion_check/max_speed_mps=2.5");
  settings.table.setAssignment("publish_tf=false");
  const OdometryConfig& odometry = settings.parameters.odometry;
  EXPECT_EQ(odometry.correspondence_finder.feature_detector.max_features, 777);
  EXPECT_EQ(odometry.motion_estimator.criterion, "std_based");
  EXPECT_EQ(odometry.motion_check.max_speed_mps, 2.5);
  EXPECT_FALSE(settings.parameters.node.publish_tf);
  expectError<std::invalid_argument>([&] { settings.table.setAssignment("queue_size 4"); },
                                     "\"queue_size 4\" is not an assignment: write name=value");
}

void expectRejected(const std::string& name, const std::string& value, const std::string& part) {
  Settings settings;
  const std::vector<std::string> before = values(settings.table);
  expectError<std::invalid_argument>([&] { settings.table.set(name, value); }, part);
  EXPECT_EQ(values(settings.table), before);
}

TEST(ParametersTest, RejectsWithNameValueAndRange) {
  expectRejected(
      "feature_detector/max_feature", "100", "unknown parameter \"feature_detector/max_feature\"");
  expectRejected("queue_size", "101", "parameter queue_size is 101, but must be in [1, 100]");
  expectRejected("queue_size", "0", "is 0, but must be in [1, 100]");
  expectRejected("significant_bits", "7", "is 7, but must be 0 or in [8, 16]");
  expectRejected("queue_size", "many", "is \"many\", but must be an integer in [1, 100]");
  expectRejected("queue_size", "2.5", "is \"2.5\", but must be an integer in [1, 100]");
  expectRejected("queue_size", "99999999999", "is \"99999999999\", but must be");
  expectRejected("queue_size", "", "is \"\", but must be");
  expectRejected("motion_check/max_speed_mps",
                 "1001",
                 "parameter motion_check/max_speed_mps is 1001, but must be in [0.1, 1000]");
  for (const char* value : {"nan", ".nan", "inf", "-inf", "1 2", "1e999", "one"}) {
    expectRejected("motion_check/max_speed_mps", value, "but must be a number in [0.1, 1000]");
  }
  expectRejected("publish_tf", "1", "parameter publish_tf is \"1\", but must be true or false");
  expectRejected("motion_estimator/criterion",
                 "best",
                 "is \"best\", but must be one of rotrocc, reprojection, rocc");
}

TEST(ParametersTest, SixNumbersAreAListOrText) {
  const TemporaryDirectory directory;
  const std::array<double, 6> pose = {1, -2, 0.5, 0, 0, 1.57};
  for (const char* text :
       {"[1, -2, 0.5, 0, 0, 1.57]", "1 -2 0.5 0 0 1.57", "\"1, -2,.5,0,0,1.57\""}) {
    Settings settings;
    loadYaml(directory.write("pose.yaml", std::string("initial_pose: ") + text), settings.table);
    EXPECT_EQ(settings.parameters.node.initial_pose, pose) << text;
  }
  for (const char* text : {"",
                           "1 2 3 4 5",
                           "1 2 3 4 5 6 7",
                           "1 2 3 4 5 x",
                           "1 2 3 4 5 nan",
                           "1 2 3 4 5 1e999",
                           "1 2 3 4 5 6m"}) {
    expectRejected("initial_pose", text, "but must be 6 numbers");
  }
}

TEST(ParametersTest, AFileNamesItselfWhenItIsRejected) {
  const TemporaryDirectory directory;
  const auto expect_rejected = [&](const std::string& text, const std::string& part) {
    const std::string path = directory.write("bad.yaml", text);
    Settings settings;
    expectError<std::invalid_argument>([&] { loadYaml(path, settings.table); }, path);
    expectError<std::invalid_argument>([&] { loadYaml(path, settings.table); }, part);
  };
  expect_rejected("motion_check:\n  max_speed: 3\n",
                  "unknown parameter \"motion_check/max_speed\"");
  expect_rejected("motion_check:\n  max_speed_mps: 0\n", "motion_check/max_speed_mps is 0");
  expect_rejected("motion_check:\n  max_speed_mps: .nan\n",
                  "motion_check/max_speed_mps is \".nan\"");
  expect_rejected("motion_check: [1, 2]\n", "unknown parameter \"motion_check\"");
  expect_rejected("queue_size: [1]\n", "queue_size is a list, but must be [1, 100]");
  expect_rejected("initial_pose: [1, 2]\n", "initial_pose is \"1 2\", but must be 6 numbers");
  expect_rejected("initial_pose: &loop [*loop]\n", "");
  expect_rejected("motion_check: &loop {of: *loop}\n", "\"motion_check/of\" must be a value");
  expect_rejected("odom_frame: \"no UTF-8: \xc0\xb5\"\n", "\"odom_frame\" is not UTF-8");
  expect_rejected("motion_check\n", "");
  expect_rejected("a: b: c\n", "");
  expect_rejected("motion_check: {max_speed_mps:", "end of map flow not found");
  expect_rejected("motion_check: {max_speed_mps:]20}\n", "illegal flow end");
  Settings settings;
  expectError<std::invalid_argument>([&] { loadYaml(directory / "none.yaml", settings.table); },
                                     "none.yaml");
}

TEST(ParametersTest, WhatIsWrittenIsReadBack) {
  Settings written;
  for (const auto& parameter : written.table.parameters()) {
    written.table.set(parameter.name, allowedValues(parameter).back());
  }
  const TemporaryDirectory directory;
  Settings read;
  loadYaml(directory.write("all.yaml", toYaml(written.table)), read.table);
  EXPECT_EQ(values(read.table), values(written.table));
  loadYaml(directory.write("empty.yaml", "# nothing\n"), read.table);
  EXPECT_EQ(values(read.table), values(written.table));
}

TEST(ParametersTest, TextsThatMeanSomethingInYamlAreReadBack) {
  const TemporaryDirectory directory;
  for (const char* text : {"",
                           "null",
                           "~",
                           "a: b",
                           "run #1.txt",
                           "- x",
                           "*a",
                           "\"q\"",
                           "a\\b\tc",
                           "\x7f\x04",
                           "Gr\u00fc\u00dfe"}) {
    Settings written;
    written.table.set("trajectory_file", text);
    Settings read;
    loadYaml(directory.write("text.yaml", toYaml(written.table)), read.table);
    EXPECT_EQ(read.parameters.node.trajectory_file, text);
  }
}

}  // namespace
}  // namespace rotrocc
