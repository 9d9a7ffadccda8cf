// Runs the program as users do, and checks its report.

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

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
  /// A drive of 300 m at 10 m/s, and an estimate of it whose steps are 1 % too long and roll by
  /// 0.02 deg, which does not change the way.
  EvaluateTrajectoryTest() {
    write("truth.txt", 1.0, 0.0);
    write("estimate.txt", 1.01, 0.02);
  }

  void write(const std::string& name, double step_m, double roll_deg) const {
    for (const TrajectoryFormat format : {TrajectoryFormat::kKitti, TrajectoryFormat::kTum}) {
      const bool tum = format == TrajectoryFormat::kTum;
      TrajectoryWriter writer(directory_ / ((tum ? "tum_" : "") + name), format);
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      for (int i = 0; i < kPoses; ++i) {
        writer.write({i * kPeriod_ns, pose});
        pose.translate(Eigen::Vector3d(0.0, 0.0, step_m));
        pose.rotate(Eigen::AngleAxisd(roll_deg * M_PI / 180.0, Eigen::Vector3d::UnitZ()));
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

  /// Expects values in columns of a row.
  static void expectRow(const CsvRow& row,
                        const std::vector<std::pair<const char*, double>>& expected) {
    for (const auto& [column, value] : expected) {
      EXPECT_NEAR(std::stod(row.at(column)), value, 1e-5 * value) << column;
    }
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

/// Each figure in its unit: meters, percent, degrees. A segment of 100 m ends after 101 steps, one
/// of 200 m after 201; 20 and 10 of them begin at each tenth pose.
TEST_F(EvaluateTrajectoryTest, ReportHasTheFigures) {
  const CommandResult result = run("truth.txt estimate.txt --fit --report report");
  ASSERT_EQ(result.status, 0) << result.output;
  for (const char* line :
       {"translation 1.008 %, rotation 0.02017 deg/m (30 segments, 301 poses, 300.0 m)\n",
        "         100        20            1.010           0.02020\n",
        "          10        30            1.008           0.02017\n",
        "translation [m]        0.0100     0.0100     0.0100     0.0100\n",
        "rotation [deg]         0.0200     0.0200     0.0200     0.0200\n",
        "final drift: 3.000 m (1.000 % of the path), 6.000 deg\n"}) {
    EXPECT_NE(result.output.find(line), std::string::npos) << line << result.output;
  }
  const double translation_percent = (20 * 1.01 + 10 * 1.005) / 30;
  const double rotation_deg_per_m = 0.02 * translation_percent;
  expectRow(summary(),
            {{"poses", kPoses},
             {"path_m", 300.0},
             {"duration_s", 30.0},
             {"segments", 30},
             {"translation_percent", translation_percent},
             {"rotation_deg_per_m", rotation_deg_per_m},
             {"step_translation_mean_m", 0.01},
             {"step_translation_rms_m", 0.01},
             {"step_translation_p95_m", 0.01},
             {"step_translation_max_m", 0.01},
             {"step_rotation_mean_deg", 0.02},
             {"step_rotation_rms_deg", 0.02},
             {"step_rotation_p95_deg", 0.02},
             {"step_rotation_max_deg", 0.02},
             {"drift_m", 3.0},
             {"drift_percent", 1.0},
             {"drift_deg", 6.0}});

  const std::vector<CsvRow> poses = readCsv(directory_ / "report/poses.csv");
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(kPoses)) << "to the last one";
  expectRow(poses[100],
            {{"stamp_ns", 100 * kPeriod_ns},
             {"path_m", 100.0},
             {"true_z_m", 100.0},
             {"z_m", 101.0},
             {"step_translation_error_m", 0.01},
             {"step_rotation_error_deg", 0.02}});
  expectRow(readCsv(directory_ / "report/segments.csv").at(0),
            {{"length_m", 100.0},
             {"speed_mps", 100.0 / 10.1},
             {"translation_percent", 1.01},
             {"rotation_deg_per_m", 0.0202}});
  const std::vector<CsvRow> by_length = readCsv(directory_ / "report/by_length.csv");
  ASSERT_EQ(by_length.size(), 2u);
  expectRow(by_length[1],
            {{"length_m", 200.0}, {"translation_percent", 1.005}, {"rotation_deg_per_m", 0.0201}});
  expectRow(readCsv(directory_ / "report/by_speed.csv").at(1),
            {{"speed_mps", 10.0},
             {"translation_percent", translation_percent},
             {"rotation_deg_per_m", rotation_deg_per_m}});

  for (const char* part : {"<b>1.008 <small>%</small>",
                           "<b>0.02017 <small>deg/m</small>",
                           "<b>3.00 <small>m</small>",
                           "<b>300 <small>m</small></b><span>301 poses, 30.0 s<",
                           "<th>speed<br>[km/h]</th>",
                           "<td>36</td><td>30</td><td>1.008</td><td>0.02017</td>",
                           "<td>translation [mm]</td><td>10</td>",
                           "<td>rotation [mdeg]</td><td>20</td>"}) {
    EXPECT_EQ(count(page(), part), 1) << part;
  }
  expectPictures({"trajectory", "errors", "steps"});
}

TEST_F(EvaluateTrajectoryTest, PageOpensAloneAndIsTheSameEachTime) {
  const std::string command = "truth.txt estimate.txt --fit --report report --stats ";
  const CommandResult result = run(command + statistics());
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

  ASSERT_EQ(run(command + "report/pairs.csv").status, 0) << "its own table is what it reads";
  EXPECT_TRUE(page() == html);
}

TEST_F(EvaluateTrajectoryTest, PageHasAMapWithEachPair) {
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

TEST_F(EvaluateTrajectoryTest, ReadsPosesOfBagsAndAlignsTheirFrames) {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  {
    rosbag::Bag bag(directory_ / "run.bag", rosbag::bagmode::Write);
    for (const StampedPose& pose : readTrajectory(directory_ / "tum_estimate.txt")) {
      const Eigen::Isometry3d T = T_base_camera * pose.T_world_body * T_base_camera.inverse();
      nav_msgs::Odometry odometry;
      odometry.header.stamp.fromNSec(static_cast<std::uint64_t>(pose.stamp_ns + 1'000'000'000));
      odometry.pose.pose = tf2::toMsg(T);
      bag.write("/odom", odometry.header.stamp, odometry);
      tf2_msgs::TFMessage tf;
      tf.transforms.push_back(tf2::eigenToTransform(T));
      tf.transforms[0].header.stamp = odometry.header.stamp;
      tf.transforms[0].header.frame_id = "odom";
      tf.transforms[0].child_frame_id = "base_link";
      bag.write("/tf", odometry.header.stamp, tf);
    }
  }
  Trajectory truth = readTrajectory(directory_ / "tum_truth.txt");
  {
    TrajectoryWriter writer(directory_ / "later.txt", TrajectoryFormat::kTum);
    for (StampedPose& pose : truth) {
      pose.stamp_ns += 1'000'000'000;
      writer.write(pose);
    }
  }
  for (const char* estimate : {"run.bag", "run.bag:/odom", "run.bag:odom:base_link"}) {
    const CommandResult other = run(std::string("later.txt ") + estimate + " --fit");
    EXPECT_EQ(other.status, 0) << other.output;
    EXPECT_NE(other.output.find("EST is of another body than GT, which is turned by 90.0 deg"),
              std::string::npos)
        << other.output;
    const CommandResult aligned =
        run(std::string("later.txt ") + estimate + " --fit --align-frames");
    EXPECT_NE(aligned.output.find("translation 1.0"), std::string::npos) << aligned.output;
  }
  EXPECT_NE(run("later.txt run.bag:/nothing --fit").output.find("run.bag:/odom"),
            std::string::npos);
}

TEST_F(EvaluateTrajectoryTest, PosesWithoutStampsMustBeAsMany) {
  const std::string text = readFile(directory_ / "estimate.txt");
  directory_.write("short.txt", text.substr(text.find('\n') + 1));
  const CommandResult result = run("truth.txt short.txt --fit");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("has 301 poses, short.txt 300, and they have no stamps"),
            std::string::npos)
      << result.output;
}

TEST_F(EvaluateTrajectoryTest, NothingIsWrittenIfAnInputIsWrong) {
  statistics();
  directory_.write("other.csv", "stamp_ns,state\n0,ok\n");
  const std::string with_report = " --fit --report report --segments segments.csv --stats ";
  for (const auto& [arguments, message] : std::vector<std::pair<std::string, std::string>>{
           {"truth.txt tum_estimate.txt" + with_report + "stats.csv", "truth.txt has no stamps"},
           {"tum_truth.txt estimate.txt --fit", "estimate.txt has no stamps"},
           {"tum_truth.txt tum_estimate.txt" + with_report + "other.csv", "no pair at 0.100000 s"},
           {"truth.txt estimate.txt" + with_report + "other.csv", "other.csv has 1 pairs"},
           {"tum_estimate.txt --report report --stats other.csv", "no pair at 0.100000 s"},
           {"truth.txt estimate.txt" + with_report + "truth.txt", "no column stamp_ns"},
           {"truth.txt estimate.txt" + with_report + "none.csv", "cannot read none.csv"}}) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_NE(result.output.find(message), std::string::npos) << arguments << result.output;
    EXPECT_FALSE(std::filesystem::exists(directory_ / "report")) << arguments;
    EXPECT_FALSE(std::filesystem::exists(directory_ / "segments.csv")) << arguments;
  }
}

TEST_F(EvaluateTrajectoryTest, ProposesSegmentsThatFit) {
  std::string poses;
  for (int i = 0; i < 40; ++i) poses += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(0.1 * i) + "\n";
  directory_.write("short.txt", poses);
  const CommandResult rejected = run("short.txt short.txt --fit");
  EXPECT_EQ(rejected.status, 1);
  const std::size_t proposal = rejected.output.find("--lengths");
  ASSERT_NE(proposal, std::string::npos) << rejected.output;
  EXPECT_EQ(run("short.txt short.txt " + rejected.output.substr(proposal)).status, 0)
      << rejected.output;
}

TEST_F(EvaluateTrajectoryTest, FilesOfOthersAreKept) {
  const std::string rejected = "has files that are not of a report, e.g. ";
  EXPECT_NE(run("truth.txt estimate.txt --fit --report .").output.find(rejected),
            std::string::npos);
  ASSERT_EQ(run("truth.txt estimate.txt --fit --report report").status, 0);
  directory_.write("report/notes.csv", "mine\n");
  ASSERT_EQ(run("tum_estimate.txt --report report").status, 0);
  EXPECT_EQ(readFile(directory_ / "report/notes.csv"), "mine\n");
}

TEST_F(EvaluateTrajectoryTest, RejectsBadUsage) {
  for (const char* arguments : {"estimate.txt",
                                "a b c",
                                "truth.txt estimate.txt --fit --step 1",
                                "truth.txt estimate.txt --stats stats.csv"}) {
    EXPECT_EQ(run(arguments).status, 2) << arguments;
  }
  EXPECT_EQ(run("truth.txt estimate.txt --fit --report truth.txt").status, 1) << "that is a file";
}

}  // namespace
}  // namespace rotrocc
