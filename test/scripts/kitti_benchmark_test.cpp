// Runs scripts/kitti_benchmark over small sequences, interrupts it, and checks its files.

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/read_csv.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// The KITTI layout: 00 and 01 with truth, 11 without. The odometry is run by a script that logs
/// the sequences, and waits at 01 for the file "go".
class KittiBenchmarkTest : public ::testing::Test {
 protected:
  /// The sequences are rendered once, and every test has a copy.
  static void SetUpTestSuite() {
    master_ = new TemporaryDirectory;
    const int pairs[] = {14, 13, 12};  // the longest is run first
    fs::create_directories(*master_ / "poses");
    for (int i = 0; i < 3; ++i) {
      const fs::path sequence = *master_ / "sequences/" + kNames[i];
      writeSyntheticSequence(sequence, pairs[i]);
      fs::rename(sequence / "poses.txt", *master_ / "poses/" + kNames[i] + ".txt");
    }
    fs::remove(*master_ / "poses/11.txt");
  }
  static void TearDownTestSuite() { delete master_; }

  KittiBenchmarkTest() {
    fs::copy(*master_ / "", dataset(), fs::copy_options::recursive);
    fs::create_directory(directory_ / "programs");
    fs::create_symlink(fs::path(PROGRAMS) / "evaluate_trajectory",
                       directory_ / "programs/evaluate_trajectory");
    writeScript("programs/offline_odometry",
                "basename $1 >> " + directory_ / "runs" + "\n" + "case $1 in */01) until [ -f " +
                    directory_ / "go" + " ]; do sleep 0.05; done ;; esac\nexec " + PROGRAMS +
                    "/offline_odometry \"$@\"\n");
  }

  void writeScript(const std::string& name, const std::string& body) const {
    fs::permissions(directory_.write(name, "#!/bin/sh\n" + body), fs::perms::owner_all);
  }

  fs::path dataset() const { return directory_ / "dataset"; }
  fs::path results() const { return directory_ / "out/sequences"; }
  void letGo() const { directory_.write("go", ""); }

  std::string command(const std::string& options = "") const {
    return commandFor(dataset()) + options;
  }
  std::string commandFor(const std::string& recordings) const {
    return std::string(PYTHON) + " " + KITTI_BENCHMARK + " " + recordings + " --output " +
           directory_ / "out" + " --programs " + directory_ / "programs" + " ";
  }
  CommandResult run(const std::string& options = "") const { return runCommand(command(options)); }

  /// Runs one sequence at a time until 00 is finished and 01 waits, and ends the run as Ctrl-C
  /// does.
  CommandResult interrupt() const {
    return runCommand("(" + command("--jobs 1") + " & until [ -d " + (results() / "00").string() +
                      " ] && [ $(wc -l < " + directory_ / "runs" +
                      ") = 2 ]; do sleep 0.05; done; kill -INT $!; wait $!)");
  }

  std::vector<std::string> runs() const {
    std::vector<std::string> names;
    std::ifstream file(directory_ / "runs");
    for (std::string name; file >> name;) names.push_back(name);
    return names;
  }

  std::vector<CsvRow> rows() const { return readCsv(directory_ / "out/sequences.csv"); }

  static constexpr const char* kNames[] = {"00", "01", "11"};
  static TemporaryDirectory* master_;
  TemporaryDirectory directory_;
};

TemporaryDirectory* KittiBenchmarkTest::master_ = nullptr;

TEST_F(KittiBenchmarkTest, ReportsAllSequences) {
  letGo();
  fs::create_directory(dataset() / "sequences/12");
  const CommandResult result = run("--jobs 2");
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("sequences/12 is left out: it has no folder image_0, image_2"),
            std::string::npos)
      << result.output;
  const std::vector<CsvRow> sequences = rows();
  ASSERT_EQ(sequences.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(sequences[i].at("sequence"), kNames[i]);
    EXPECT_EQ(sequences[i].at("pairs"), std::to_string(14 - i));
    EXPECT_EQ(sequences[i].at("group"), i < 2 ? "short" : "none");
    EXPECT_TRUE(fs::exists(results() / kNames[i] / "index.html"));
    EXPECT_FALSE(readFile(directory_ / "out/trajectories/" + kNames[i] + ".txt").empty());
  }

  // The mean over all segments, as each sequence is weighted by its count.
  double sum = 0.0;
  double segments = 0.0;
  for (int i = 0; i < 2; ++i) {
    const double count = std::stod(sequences[i].at("segments"));
    sum += count * std::stod(sequences[i].at("translation_percent"));
    segments += count;
  }
  EXPECT_GT(sum, 0.0);
  const CsvRow pooled = readCsv(directory_ / "out/by_length.csv").at(0);
  EXPECT_EQ(std::stod(pooled.at("segments")), segments);
  EXPECT_NEAR(std::stod(pooled.at("translation_percent")), sum / segments, 1e-6);

  const std::string page = readFile(directory_ / "out/index.html");
  EXPECT_NE(page.find("href=\"sequences/11/index.html\""), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos) << "it needs the network";
}

TEST_F(KittiBenchmarkTest, InterruptedItLosesNoFinishedSequence) {
  const CommandResult interrupted = interrupt();
  EXPECT_EQ(interrupted.status, 130) << interrupted.output;
  EXPECT_NE(interrupted.output.find("1 of 3 sequences are finished"), std::string::npos)
      << interrupted.output;
  EXPECT_EQ(std::distance(fs::directory_iterator(results()), {}), 1) << "halves are left";

  letGo();
  fs::create_directories(results() / "01.part.elsewhere.1");  // as a killed run leaves it
  directory_.write("out/sequences/01.part.elsewhere.1/pairs.csv", "stamp_ns\n");
  const CommandResult result = run("--jobs 1");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(std::distance(fs::directory_iterator(results()), {}), 3);
  EXPECT_EQ(runs(), (std::vector<std::string>{"00", "01", "01", "11"}));
  EXPECT_EQ(rows().size(), 3u);
}

TEST_F(KittiBenchmarkTest, AFailureDoesNotStopTheOthers) {
  letGo();
  const fs::path calibration = dataset() / "sequences/00/calib.txt";
  fs::resize_file(calibration, 10);
  const CommandResult result = run();
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("00 failed: offline_odometry: "), std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("calib.txt"), std::string::npos) << result.output;
  EXPECT_EQ(rows().size(), 2u);
  EXPECT_NE(readFile(directory_ / "out/index.html").find("<h2>Failed</h2>"), std::string::npos);

  fs::copy_file(
      dataset() / "sequences/01/calib.txt", calibration, fs::copy_options::overwrite_existing);
  EXPECT_EQ(run().status, 0) << "the next run tries it again";
  EXPECT_EQ(rows().size(), 3u);
}

TEST_F(KittiBenchmarkTest, ComparesWithAnEarlierReport) {
  letGo();
  ASSERT_EQ(run().status, 0);
  fs::copy(directory_ / "out", directory_ / "earlier", fs::copy_options::recursive);
  std::ofstream table(directory_ / "earlier/sequences.csv");
  table << "sequence,group,segments,translation_percent,rotation_deg_per_m\n"
        << "00,short,5," << 2.0 * std::stod(rows()[0].at("translation_percent")) << ",0.001\n";
  table.close();
  const CommandResult result = run("--compare " + directory_ / "earlier");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(runs().size(), 3u) << "a comparison runs nothing";
  EXPECT_NE(readFile(directory_ / "out/index.html").find("<span class=\"better\">-50.0 %</span>"),
            std::string::npos);
  EXPECT_EQ(run("--compare " + dataset().string()).status, 1) << "that is no report";
}

TEST_F(KittiBenchmarkTest, UsesOtherMachines) {
  letGo();
  // In place of ssh: [options] host [--] command. As sshd does, it sets $SHELL.
  const std::string hosts = directory_ / "hosts";
  writeScript("ssh",
              "while :; do case $1 in -*) shift ;; *) break ;; esac; done\necho $1 >> " + hosts +
                  "; shift; [ \"$1\" != -- ] || shift\n"
                  "cd / && exec env SHELL=/bin/sh sh -c \"$*\"\n");
  const CommandResult result = runCommand("PARALLEL_SSH=" + directory_ / "ssh" + " " +
                                          command("--sshlogin 1/alice --sshlogin 1/bob"));
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(rows().size(), 3u);
  for (const char* host : {"alice", "bob"}) {
    EXPECT_NE(readFile(hosts).find(host), std::string::npos) << host;
  }
}

TEST_F(KittiBenchmarkTest, RejectsToMixResultsAndWhatIsNoDataSet) {
  fs::create_directory(directory_ / "out");
  directory_.write("out/settings.json", "{\"odometry options\": [\"--set\", \"a=b\"]}");
  const std::pair<std::string, const char*> kRows[] = {
      {command(), "other parameters"},
      {"flock " + directory_ / "out/lock" + " " + command(), "another run"},
      {commandFor(directory_ / "programs"), "has no sequences"}};
  for (const auto& [arguments, error] : kRows) {
    const CommandResult result = runCommand(arguments);
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.output.find(error), std::string::npos) << result.output;
  }
  fs::remove(directory_ / "out/settings.json");
  EXPECT_NE(run().output.find("not of a report"), std::string::npos);
}

}  // namespace
}  // namespace rotrocc
