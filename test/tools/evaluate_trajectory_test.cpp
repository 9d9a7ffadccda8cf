// Runs the program as users do, and checks its report.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "rotrocc/trajectory.h"
#include "support/read_csv.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPoses = 301;
constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr std::int64_t kStart_ns = 1'317'046'453'072'943'872;

class EvaluateTrajectoryTest : public ::testing::Test {
 protected:
  /// A drive of 300 m, and an estimate of it whose steps are 1 % too long.
  EvaluateTrajectoryTest() {
    write("truth.txt", 1.0);
    write("estimate.txt", 1.01);
    std::ofstream times(directory_ / "times.txt");
    for (int i = 0; i < kPoses; ++i) times << 0.2 * i << '\n';
  }

  void write(const std::string& name, double step_m) const {
    for (const TrajectoryFormat format : {TrajectoryFormat::kKitti, TrajectoryFormat::kTum}) {
      const bool tum = format == TrajectoryFormat::kTum;
      TrajectoryWriter writer(directory_ / ((tum ? "tum_" : "") + name), format);
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      for (int i = 0; i < kPoses; ++i) {
        writer.write({i * kPeriod_ns, pose});
        pose.translate(Eigen::Vector3d(0.0, 0.0, step_m));
      }
    }
  }

  /// The columns of offline_odometry --stats that reports read. Two pairs are lost.
  std::string statistics() const {
    std::string rows =
        "stamp_ns,state,corners,with_depth,tracked,consistent,rotation_inliers,"
        "translation_inliers,pyramids_ms,corners_ms,disparity_ms,tracking_ms,estimation_ms,wall_ms,"
        "cpu_ms,bias_estimated_px,bias_sigma_px,bias_applied_px\n";
    for (int i = 0; i < kPoses; ++i) {
      rows += std::to_string(i * kPeriod_ns) + (i == 7 || i == 8 ? ",lost" : ",ok") +
              ",2000,1800,1500,1400,1300,1200,1,3,2,5,1,12,20,0.3,0.05,0.2\n";
    }
    return directory_.write("stats.csv", rows);
  }

  CommandResult run(const std::string& arguments) const {
    // The default backend of matplotlib may need a display, or what is not installed.
    return runCommand("cd " + directory_ / "" + " && MPLBACKEND=module://none " +
                      EVALUATE_TRAJECTORY + " " + arguments);
  }

  CsvRow summary() const { return readCsv(directory_ / "report/summary.csv").at(0); }
  std::string page() const { return readFile(directory_ / "report/index.html"); }

  void expectPictures(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      const std::string picture = readFile(directory_ / "report/" + name + ".png");
      EXPECT_EQ(picture.substr(0, 4), "\x89PNG") << name;
      EXPECT_GT(picture.size(), 5000u) << name << " is next to empty";
    }
  }

  static int count(const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  }

  TemporaryDirectory directory_;
};

TEST_F(EvaluateTrajectoryTest, ReportHasTheFigures) {
  const CommandResult result = run("truth.txt estimate.txt --fit --report report");
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("translation 1.00"), std::string::npos) << result.output;
  EXPECT_EQ(std::stod(summary().at("poses")), kPoses);
  EXPECT_NEAR(std::stod(summary().at("path_m")), 300.0, 1e-6);
  EXPECT_NEAR(std::stod(summary().at("translation_percent")), 1.0, 0.02);
  EXPECT_NEAR(std::stod(summary().at("step_translation_max_m")), 0.01, 1e-6);
  EXPECT_NEAR(std::stod(summary().at("drift_m")), 3.0, 1e-6);

  const std::vector<CsvRow> poses = readCsv(directory_ / "report/poses.csv");
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(kPoses));
  EXPECT_EQ(poses[1].at("stamp_ns"), "100000000");
  EXPECT_NEAR(std::stod(poses[100].at("true_z_m")), 100.0, 1e-6);
  EXPECT_NEAR(std::stod(poses[100].at("z_m")), 101.0, 1e-6);
  const std::vector<CsvRow> by_length = readCsv(directory_ / "report/by_length.csv");
  ASSERT_EQ(by_length.size(), 2u);
  EXPECT_EQ(by_length[1].at("length_m"), "200");
  EXPECT_EQ(readCsv(directory_ / "report/by_speed.csv").at(0).at("speed_mps"), "8");
  expectPictures({"trajectory", "errors", "steps"});
}

TEST_F(EvaluateTrajectoryTest, PageOpensAlone) {
  const CommandResult result =
      run("truth.txt estimate.txt --fit --report report --stats " + statistics());
  ASSERT_EQ(result.status, 0) << result.output;
  const std::string html = page();
  EXPECT_EQ(count(html, "src=\"data:image/png;base64,"), 6);
  EXPECT_EQ(count(html, "<img"), 6) << "a picture is not inside";
  for (const char* from_elsewhere : {"src=\"http", "url(", "<link", "import("}) {
    EXPECT_EQ(count(html, from_elsewhere), 0) << "it needs another file";
  }
  EXPECT_NE(html.find("<h1>estimate</h1>"), std::string::npos);
  EXPECT_NE(html.find("<b>2 <small>lost"), std::string::npos);
  EXPECT_NE(html.find("+0.300 px, with a standard deviation of 0.050 px"), std::string::npos);
  expectPictures({"trajectory", "errors", "steps", "counts", "times", "bias"});
  EXPECT_EQ(readFile(directory_ / "report/pairs.csv"), readFile(statistics()));
}

TEST_F(EvaluateTrajectoryTest, PageHasAMapThatTellsOfEachPair) {
  if (!std::filesystem::exists("/usr/share/javascript/leaflet/leaflet.min.js")) {
    GTEST_SKIP() << "libjs-leaflet is not installed: pages have a picture instead";
  }
  ASSERT_EQ(run("truth.txt estimate.txt --fit --report report --stats " + statistics()).status, 0);
  const std::string html = page();
  EXPECT_EQ(count(html, "<div id=\"map\">"), 1);
  // In steps of 1 m, of which the estimate makes 1.01 m.
  for (const char* data : {"\"error_m\":[0.0,0.01,0.02,",
                           "\"step_error_m\":[0.0,0.01,",
                           "\"time_s\":[0.0,0.1,0.2,",
                           "\"truth\":[[0.0,1.0,2.0,",
                           "\"state\":[\"ok\",\"ok\","}) {
    EXPECT_EQ(count(html, data), 1) << data;
  }
  EXPECT_EQ(count(html, "\"lost\",\"lost\",\"ok\""), 1);
}

TEST_F(EvaluateTrajectoryTest, ReportIsTheSameEachTime) {
  const std::string command = "truth.txt estimate.txt --fit --report report --stats ";
  ASSERT_EQ(run(command + statistics()).status, 0);
  const std::string once = page();
  ASSERT_EQ(run(command + "report/pairs.csv").status, 0) << "its own table is what it reads";
  EXPECT_TRUE(page() == once);
}

TEST_F(EvaluateTrajectoryTest, NoTruthIsNeeded) {
  ASSERT_EQ(run("truth.txt estimate.txt --fit --report report").status, 0);
  const CommandResult result = run("tum_estimate.txt --report report --stats " + statistics());
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NEAR(std::stod(summary().at("path_m")), 303.0, 1e-6);
  EXPECT_EQ(summary().count("translation_percent"), 0u);
  EXPECT_EQ(page().find("translation error"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "report/by_length.csv"))
      << "of the report that was there";
}

TEST_F(EvaluateTrajectoryTest, PosesWithoutStampsGetThoseOfTheStatistics) {
  std::string late = readFile(statistics());
  // The clock of a recording, at 5 Hz.
  for (int i = kPoses - 1; i >= 0; --i) {
    const std::string stamp = "\n" + std::to_string(i * kPeriod_ns) + ",";
    late.replace(late.find(stamp),
                 stamp.size(),
                 "\n" + std::to_string(kStart_ns + 2 * i * kPeriod_ns) + ",");
  }
  directory_.write("late.csv", late);
  const CommandResult result = run("truth.txt estimate.txt --fit --report report --stats late.csv");
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_NEAR(std::stod(summary().at("duration_s")), 60.0, 1e-6);
  const auto poses = readCsv(directory_ / "report/poses.csv");
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(kPoses));
  EXPECT_EQ(poses.back().at("stamp_ns"), std::to_string(kStart_ns + 2 * (kPoses - 1) * kPeriod_ns));
}

TEST_F(EvaluateTrajectoryTest, StatisticsMustBeOfTheSameRun) {
  const CommandResult result =
      run("truth.txt estimate.txt --times times.txt --fit --report report --stats " + statistics());
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("need --times"), std::string::npos) << result.output;
}

TEST_F(EvaluateTrajectoryTest, RefusesBadUsage) {
  for (const char* arguments : {"estimate.txt",
                                "a b c",
                                "truth.txt estimate.txt --fit --step 1",
                                "truth.txt estimate.txt --stats stats.csv"}) {
    EXPECT_EQ(run(arguments).status, 2) << arguments;
  }
  EXPECT_EQ(run("truth.txt estimate.txt --fit --report times.txt").status, 1) << "that is a file";
}

}  // namespace
}  // namespace rotrocc
