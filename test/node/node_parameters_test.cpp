#include "node/node_parameters.h"

#include <cctype>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

using XmlRpc::XmlRpcValue;

class NodeParametersTest : public testing::Test {
 protected:
  /// For the parameter `name`, with a sentence that has `part`.
  void expectRejected(const XmlRpcValue& tree, const std::string& part, const std::string& name) {
    try {
      setParameters(tree, table_);
      ADD_FAILURE() << name << " is accepted";
    } catch (const RejectedParameter& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_EQ(error.name(), name);
    }
  }

  Parameters parameters_;
  ParameterTable table_ = makeParameterTable(parameters_);
};

TEST_F(NodeParametersTest, EveryTypeOfTheServer) {
  XmlRpcValue tree;
  tree["base_frame"] = std::string("robot");
  tree["diagnostic_period"] = 2.0;  // of diagnostic_updater
  tree["publish_tf"] = false;
  tree["queue_size"] = 9;
  tree["max_stamp_difference_s"] = 0.1 + 0.2;  // keeps every bit
  tree["no_input_warning_s"] = 2;  // YAML has no point in "2.0 m/s" that people write as 2
  tree["motion_check"]["max_speed_mps"] = 321;
  setParameters(tree, table_);
  EXPECT_EQ(parameters_.node.base_frame, "robot");
  EXPECT_FALSE(parameters_.node.publish_tf);
  EXPECT_EQ(parameters_.node.queue_size, 9);
  EXPECT_EQ(parameters_.node.max_stamp_difference_s, 0.1 + 0.2);
  EXPECT_EQ(parameters_.node.no_input_warning_s, 2.0);
  EXPECT_EQ(parameters_.odometry.motion_check.max_speed_mps, 321);
  EXPECT_EQ(parameters_.node.odom_frame, "odom");
}

TEST_F(NodeParametersTest, TheInitialPoseIsAListOrText) {
  XmlRpcValue tree;
  for (int i = 0; i < 6; ++i) tree["initial_pose"][i] = i == 3 ? XmlRpcValue(0.25) : XmlRpcValue(i);
  setParameters(tree, table_);
  EXPECT_EQ(parameters_.node.initial_pose, (std::array<double, 6>{0, 1, 2, 0.25, 4, 5}));
  XmlRpcValue text;
  text["initial_pose"] = std::string("[6, 5, 4, 3, 2, 1.5]");
  setParameters(text, table_);
  EXPECT_EQ(parameters_.node.initial_pose, (std::array<double, 6>{6, 5, 4, 3, 2, 1.5}));
  XmlRpcValue nested;
  for (int i = 0; i < 6; ++i) nested["initial_pose"][i][0] = i;
  expectRejected(nested, "initial_pose is neither a value nor a section", "initial_pose");
}

TEST_F(NodeParametersTest, ParametersOfImageTransportAreNotOurs) {
  XmlRpcValue tree;
  tree["image_transport"] = std::string("compressed");
  tree["compressed"]["mode"] = std::string("color");
  tree["left"]["compressed"]["mode"] = std::string("color");
  tree["flow"]["theora"]["quality"] = 31;
  setParameters(tree, table_);
  EXPECT_EQ(parameters_.node.image_transport, "compressed");
  tree["flow"] = 1;
  expectRejected(tree, "flow", "flow");
}

TEST_F(NodeParametersTest, RejectsWhatIsUnknownOrInvalidByName) {
  XmlRpcValue unknown;
  unknown["feature_detector"]["max_featurs"] = 5;
  expectRejected(unknown, "feature_detector/max_featurs", "feature_detector/max_featurs");
  XmlRpcValue list;
  list[0] = 4;
  XmlRpcValue section;
  section["left"] = 4;
  const std::vector<std::pair<XmlRpcValue, std::string>> rows = {
      {XmlRpcValue(0), "queue_size is 0, but must be in [1, 100]"},
      {XmlRpcValue(2.5), "queue_size is \"2.5\", but must be an integer"},
      {XmlRpcValue("four"), "queue_size is \"four\""},
      {list, "queue_size is a list, but must be [1, 100]"}};
  for (const auto& [value, sentence] : rows) {
    XmlRpcValue tree;
    tree["queue_size"] = value;
    expectRejected(tree, sentence, "queue_size");
  }
  XmlRpcValue tree;
  tree["queue_size"] = section;
  expectRejected(tree, "queue_size/left", "queue_size/left");
}

/// YAML has some words for values of other types.
TEST_F(NodeParametersTest, ChoicesNeedNoQuotes) {
  const std::set<std::string> kOtherTypes = {
      "true", "false", "yes", "no", "y", "n", "on", "off", "null", "nan", "inf"};
  for (const auto& parameter : table_.parameters()) {
    for (const std::string& choice : parameter.choices) {
      EXPECT_EQ(kOtherTypes.count(choice), 0u) << parameter.name << ": " << choice;
      EXPECT_TRUE(std::islower(choice.front())) << parameter.name << ": " << choice;
    }
  }
}

TEST(RequireFramesTest, FramesAreThoseOfTf) {
  const auto reject = [](const std::function<void(NodeParameters&)>& change,
                         const std::string& part) {
    NodeParameters node;
    change(node);
    expectError<std::invalid_argument>([&] { requireFrames(node); }, part);
  };
  EXPECT_NO_THROW(requireFrames({}));
  reject([](NodeParameters& node) { node.odom_frame = "/odom"; }, "odom_frame is \"/odom\"");
  reject([](NodeParameters& node) { node.base_frame.clear(); }, "base_frame is \"\"");
  reject([](NodeParameters& node) { node.camera_frame = "/camera"; }, "camera_frame");
  reject([](NodeParameters& node) { node.odom_frame = "base_link"; },
         "odom_frame and base_frame are both \"base_link\"");
  reject([](NodeParameters& node) { node.guess_frame = "odom"; },
         "guess_frame and odom_frame are both \"odom\"");
  reject(
      [](NodeParameters& node) {
        node.guess_frame = "wheel_odom";
        node.invert_tf = true;
      },
      "invert_tf cannot be combined");
}

}  // namespace
}  // namespace rotrocc
