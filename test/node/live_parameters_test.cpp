#include "node/live_parameters.h"

#include <set>
#include <stdexcept>

#include <dynamic_reconfigure/config_tools.h>
#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

using dynamic_reconfigure::Config;
using dynamic_reconfigure::ConfigTools;

template <class Entry>
const Entry* find(const std::vector<Entry>& entries, const std::string& name) {
  for (const Entry& entry : entries) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

Config makeInt(const std::string& name, int value) {
  Config config;
  ConfigTools::appendParameter(config, name, value);
  return config;
}

TEST(LiveParametersTest, EveryParameterWithASectionIsThereWithItsTableEntry) {
  Parameters parameters;
  const ParameterTable table = makeParameterTable(parameters);
  const auto description = describeLiveParameters({});
  std::size_t described = 0;
  for (const auto& group : description.groups) described += group.parameters.size();
  std::size_t expected = 0;
  for (const auto& parameter : table.parameters()) {
    if (parameter.name.find('/') == std::string::npos) continue;
    ++expected;
    const bool known = find(description.dflt.ints, parameter.name) != nullptr ||
                       find(description.dflt.doubles, parameter.name) != nullptr ||
                       find(description.dflt.bools, parameter.name) != nullptr ||
                       find(description.dflt.strs, parameter.name) != nullptr;
    EXPECT_TRUE(known) << parameter.name;
  }
  EXPECT_EQ(described, expected);
  EXPECT_GT(described, 10u);
  EXPECT_EQ(find(description.dflt.ints, "visual_odometry/max_tries")->value,
            parameters.odometry.max_tries);
  EXPECT_EQ(find(description.min.doubles, "motion_check/max_speed_mps")->value, 0.1);
  EXPECT_EQ(find(description.max.doubles, "motion_check/max_speed_mps")->value, 1000.0);
  EXPECT_EQ(description.groups.front().name, "Default");
}

/// What the Python client of dynamic_reconfigure relies on.
TEST(LiveParametersTest, GroupsHaveStatesAndDistinctIds) {
  const auto description = describeLiveParameters({});
  std::set<int> ids;
  for (const auto& group : description.groups) {
    EXPECT_TRUE(ids.insert(group.id).second) << group.name;
    EXPECT_EQ(group.parent, 0);
    for (const Config* config : {&description.min, &description.max, &description.dflt}) {
      const auto* state = find(config->groups, group.name);
      ASSERT_NE(state, nullptr) << group.name;
      EXPECT_EQ(state->id, group.id);
    }
  }
}

TEST(LiveParametersTest, AppliesWhatIsNamed) {
  Parameters parameters;
  Config config = makeInt("feature_detector/max_features", 500);
  ConfigTools::appendParameter(config, "motion_check/max_speed_mps", 0.1 + 0.2);
  ConfigTools::appendParameter(config, "visual_odometry/method", std::string("paper"));
  applyConfig(config, parameters);
  EXPECT_EQ(parameters.odometry.correspondence_finder.feature_detector.max_features, 500);
  EXPECT_EQ(parameters.odometry.motion_check.max_speed_mps, 0.1 + 0.2);
  EXPECT_EQ(parameters.odometry.method, "paper");
  EXPECT_EQ(find(toConfig(parameters).ints, "feature_detector/max_features")->value, 500);
}

TEST(LiveParametersTest, RejectsAllIfOneIsBad) {
  Parameters parameters;
  Config config = makeInt("feature_detector/max_features", 500);
  ConfigTools::appendParameter(config, "visual_odometry/max_tries", -5);
  expectError<std::invalid_argument>([&] { applyConfig(config, parameters); },
                                     "visual_odometry/max_tries is -5, but must be in [1, 20]");
  EXPECT_EQ(parameters.odometry.correspondence_finder.feature_detector.max_features,
            FeatureDetectorConfig().max_features);
  expectError<std::invalid_argument>([&] { applyConfig(makeInt("queue_size", 5), parameters); },
                                     "\"queue_size\" cannot be changed while the odometry runs");
  expectError<std::invalid_argument>([&] { applyConfig(makeInt("a/b", 5), parameters); },
                                     "unknown parameter \"a/b\"");
}

}  // namespace
}  // namespace rotrocc
