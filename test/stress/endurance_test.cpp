// A drive with each fault of scripts/soak once, the next one after the recovery from the one
// before.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "stress/stress_player.h"
#include "support/read_file.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(EnduranceTest, KnowsSoundAnswersAndAccounts) {
  nav_msgs::Odometry sound;
  EXPECT_FALSE(isSound(sound)) << "a quaternion of zeros";
  sound.pose.pose.orientation.w = 1.0;
  EXPECT_TRUE(isSound(sound));
  for (double* value : {&sound.pose.pose.position.z,
                        &sound.pose.pose.orientation.w,
                        &sound.pose.covariance[1],
                        &sound.twist.covariance[7]}) {
    const double before = std::exchange(*value, NAN);
    EXPECT_FALSE(isSound(sound));
    *value = before;
  }
  sound.twist.covariance[7] = -1e-9;
  EXPECT_FALSE(isSound(sound));

  ImageAccount images;
  images.sent = 100;
  images.received = 96;
  images.used = 90;
  images.dropped = {{"no_partner", 2}, {"image_data", 2}};
  EXPECT_FALSE(images.addsUp()) << "two are missing";
  images.dropped["paused"] = 2;
  EXPECT_TRUE(images.addsUp());
  images.sent = 95;
  EXPECT_FALSE(images.addsUp()) << "more than sent";
}

/// Each line begins with it.
const std::string kNode = "/stereo_odometry: ";

/// Of a machine that is too busy for the drive, whose queues overflow: any fault may then lose the
/// motion.
const char* const kOfLoad[] = {
    "no stereo pair", "stereo pairs arrive again", "have no partner", "lost"};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

template <class Parts>
bool containsOneOf(const std::string& text, const Parts& parts) {
  return std::any_of(
      std::begin(parts), std::end(parts), [&](const char* part) { return contains(text, part); });
}

/// The cause of each fault is in the log once, and nothing else is.
void expectItsCauseAlone(const FaultLog& log) {
  SCOPED_TRACE(log.fault->name);
  for (const std::string& line : log.lines) {
    EXPECT_TRUE(containsOneOf(line, log.fault->says) || containsOneOf(line, kOfLoad)) << line;
  }
  if (log.fault->says.empty()) return;
  const char* cause = log.fault->says.front();
  const auto has_cause = [&](const std::string& line) { return contains(line, cause); };
  EXPECT_EQ(std::count_if(log.lines.begin(), log.lines.end(), has_cause), 1) << cause;
}

/// Without the names of temporary folders.
std::string transcript(const std::vector<FaultLog>& logs) {
  std::string text;
  for (const FaultLog& log : logs) {
    text += std::string(log.fault->name) + '\n';
    for (const std::string& line : log.lines) text += "    " + line.substr(kNode.size()) + '\n';
  }
  return std::regex_replace(text, std::regex("/tmp/[^/ ]*/"), "/tmp/");
}

/// The page has a transcript, whose times and numbers are of one machine.
void expectOnPage(const std::vector<FaultLog>& logs) {
  const std::string path = std::string(ROTROCC_DOCS_DIR) + "/bad_inputs.md";
  std::string page = readFile(path);
  if (std::getenv("ROTROCC_UPDATE_FILES") != nullptr) {
    const auto begin = page.find("```text\n") + 8;
    page = page.substr(0, begin) + transcript(logs) + page.substr(page.find("```", begin));
    std::ofstream(path) << page;
  }
  for (const FaultLog& log : logs) {
    EXPECT_TRUE(contains(page, '\n' + std::string(log.fault->name) + '\n')) << log.fault->name;
    if (log.fault->says.empty()) continue;
    EXPECT_TRUE(contains(page, log.fault->says.front())) << log.fault->says.front();
  }
}

TEST(EnduranceTest, EachFaultIsCountedAndItsCauseAloneIsSaid) {
  const TemporaryDirectory directory;
  StressOptions options;
  options.recording = directory / "drive";
  options.duration_s = 800.0;  // only against hanging
  options.in_turn = true;
  options.guess_frame = "wheel_odom";
  writeSyntheticSequence(options.recording, 30);
  ros::NodeHandle nh;
  StressPlayer player(nh, options);
  EXPECT_TRUE(player.run()) << "see the report above";
  EXPECT_TRUE(player.faults().finished()) << "no recovery from a fault";
  EXPECT_TRUE(player.audit().recovered());
  const auto dropped = player.audit().images().dropped;
  for (const char* reason : {"no_partner", "tf_missing", "stamp_zero", "image_data"}) {
    EXPECT_EQ(dropped.count(reason), 1u) << reason;
  }
  const std::vector<FaultLog> logs = player.audit().faultLogs();
  for (const FaultLog& log : logs) expectItsCauseAlone(log);
  expectOnPage(logs);
}

}  // namespace
}  // namespace rotrocc
