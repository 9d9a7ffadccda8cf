// Runs the program, as users do.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>
#include <opencv2/imgcodecs.hpp>

#include "bags/bag_reading.h"
#include "bags/sequence_bag_writer.h"
#include "sequences/kitti_mount.h"
#include "sequences/stereo_sequence.h"
#include "support/read_csv.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 12;

class OfflineOdometryTest : public ::testing::Test {
 protected:
  OfflineOdometryTest() { writeSyntheticSequence(sequence(), kPairs); }

  std::string sequence() const { return directory_ / "sequence"; }

  CommandResult run(const std::string& arguments) const {
    return runCommand(std::string(OFFLINE_ODOMETRY) + " " + arguments);
  }

  /// The poses of a run that must succeed.
  std::string trajectoryOf(const std::string& input, const std::string& options = "") const {
    const std::string file = directory_ / "trajectory.txt";
    const CommandResult result = run(input + " --trajectory " + file + " " + options);
    EXPECT_EQ(result.status, 0) << result.output;
    return readFile(file);
  }

  TemporaryDirectory directory_;
};

TEST_F(OfflineOdometryTest, FollowsTheTruth) {
  trajectoryOf(sequence());
  const Trajectory estimate = readTrajectory(directory_ / "trajectory.txt");
  const Trajectory truth = openStereoSequence(sequence(), {}).ground_truth;
  ASSERT_EQ(estimate.size(), truth.size());
  const Eigen::Isometry3d error =
      truth.back().T_world_body.inverse() * estimate.back().T_world_body;
  // 2 % of the 5.5 m: a pose that stayed at the start, or had wrong axes, is far off.
  EXPECT_LT(error.translation().norm(), 0.11);
}

TEST_F(OfflineOdometryTest, GivesTheSameBytesEachTime) {
  const std::string once = trajectoryOf(sequence());
  EXPECT_FALSE(once.empty());
  EXPECT_TRUE(once == trajectoryOf(sequence()));
}

TEST_F(OfflineOdometryTest, KittiOdometryGivesTheSameBytes) {
  const std::string config =
      directory_.write("few.yaml", "feature_detector: {max_features: 900}\n");
  const std::string file = directory_ / "kitti.txt";
  const auto kitti = [&](const std::string& input) {
    return runCommand(std::string(KITTI_ODOMETRY) + " " + input + " " + file + " " + config);
  };
  ASSERT_EQ(kitti(sequence()).status, 0);
  EXPECT_TRUE(readFile(file) == trajectoryOf(sequence(), "--config " + config));
  EXPECT_NE(kitti("/no/sequence").output.find("/no/sequence"), std::string::npos);
}

TEST_F(OfflineOdometryTest, FiguresTellMotionCovarianceAndBias) {
  const Trajectory truth = openStereoSequence(sequence(), {}).ground_truth;
  trajectoryOf(sequence(),
               "--stats " + directory_ / "stats.csv" + " --set stereo_calibrator/bias_px=0.05");
  const std::vector<CsvRow> rows = readCsv(directory_ / "stats.csv");
  ASSERT_EQ(rows.size(), truth.size()) << "one per pair";
  EXPECT_EQ(readFile(directory_ / "stats.csv").compare(0, 15, "stamp_ns,state,"), 0);
  EXPECT_EQ(rows.front().at("state"), "initializing");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto number = [&](const std::string& column) { return std::stod(rows[i].at(column)); };
    const Eigen::Isometry3d T_prev_cur =
        truth[i - 1].T_world_body.inverse() * truth[i].T_world_body;
    EXPECT_EQ(std::stoll(rows[i].at("stamp_ns")), truth[i].stamp_ns);
    EXPECT_LT(std::stoll(rows[i].at("keyframe_stamp_ns")), truth[i].stamp_ns);
    const double sigma_m = std::sqrt(number("covariance_z_z"));
    EXPECT_GT(sigma_m, 0.0);
    // Six standard deviations; 2 cm is what FollowsTheTruth allows for a step and more.
    EXPECT_NEAR(number("z_m"), T_prev_cur.translation().z(), std::min(0.02, 6.0 * sigma_m + 0.01));
    EXPECT_GT(number("covariance_ry_ry"), 0.0);
    EXPECT_LT(number("covariance_ry_ry"), 1e-4);  // [rad^2]
    EXPECT_LE(std::abs(number("covariance_x_ry")),
              std::sqrt(number("covariance_x_x") * number("covariance_ry_ry")));
    // The estimate starts at the prior of 0.05 px; the rig has no bias.
    EXPECT_LE(std::abs(number("bias_estimated_px")), 0.05 + 3.0 * number("bias_sigma_px"));
    EXPECT_GT(number("bias_sigma_px"), 0.0);
    EXPECT_LT(number("bias_sigma_px"), 1.0) << "the prior's";
  }
  EXPECT_EQ(rows.front().at("bias_applied_px"), "0.05");
}

TEST_F(OfflineOdometryTest, WritesTheFlowPictureOfEachPair) {
  const std::string pictures = directory_ / "pictures";
  trajectoryOf(sequence(), "--pictures " + pictures);
  const cv::Size image = cv::imread(sequence() + "/image_0/000001.png").size();
  for (int i = 0; i < kPairs; ++i) {
    const std::string name = (i < 10 ? "/00000" : "/0000") + std::to_string(i) + ".png";
    const cv::Mat picture = cv::imread(pictures + name);
    ASSERT_EQ(picture.cols, image.width);
    ASSERT_GT(picture.rows, image.height) << "a line of text below";
  }
}

TEST_F(OfflineOdometryTest, WritesOdometryOfTheBaseToABag) {
  const std::string file = directory_ / "odometry.bag";
  trajectoryOf(sequence(), "--bag " + file);
  const Bags bag = openBags({file});
  std::vector<nav_msgs::Odometry::ConstPtr> messages;
  for (const rosbag::MessageInstance& message : BagView(bag, {"/stereo/odom"})) {
    messages.push_back(readMessage<nav_msgs::Odometry>(message));
  }
  ASSERT_EQ(messages.size(), static_cast<std::size_t>(kPairs));
  EXPECT_EQ(messages.front()->header.stamp.sec, 1317600000u) << "as in bags of sequence_to_bag";
  EXPECT_EQ(messages.back()->header.frame_id, "odom");
  EXPECT_EQ(messages.back()->child_frame_id, "base_link");

  const Trajectory estimate = readTrajectory(directory_ / "trajectory.txt");
  const Eigen::Isometry3d T_odom_base =
      kittiMount() * estimate.back().T_world_body * kittiMount().inverse();
  const geometry_msgs::Point& position = messages.back()->pose.pose.position;
  EXPECT_GT(position.x, 4.0) << "forward is x";
  EXPECT_NEAR(position.x, T_odom_base.translation().x(), 1e-6);
  EXPECT_NEAR(position.y, T_odom_base.translation().y(), 1e-6);
  EXPECT_GT(messages.back()->pose.covariance[0], 0.0);

  BagView transforms(bag, {"/tf"});
  EXPECT_EQ(transforms.size(), static_cast<std::uint32_t>(kPairs));
  const auto tf = firstMessage<tf2_msgs::TFMessage>(bag, "/tf");
  EXPECT_EQ(tf->transforms.at(0).child_frame_id, "base_link");
}

/// With x forward; KITTI's camera is above the base.
TEST_F(OfflineOdometryTest, WritesPosesOfTheBase) {
  const std::string camera = trajectoryOf(sequence(), "--format tum");
  EXPECT_EQ(camera.find("# poses of the left camera: time [s]"), 0u);
  const Trajectory of_camera = readTrajectory(directory_ / "trajectory.txt");
  const std::string base = trajectoryOf(sequence(), "--format tum --frame base");
  EXPECT_EQ(base.find("# poses of base_link: time [s]"), 0u);
  const Trajectory of_base = readTrajectory(directory_ / "trajectory.txt");
  const Eigen::Isometry3d expected =
      kittiMount() * of_camera.back().T_world_body * kittiMount().inverse();
  EXPECT_TRUE(of_base.back().T_world_body.isApprox(expected, 1e-6));
  trajectoryOf(sequence(), "--format tum --frame base --mount '0 0 0 0 0 0 1'");
  EXPECT_TRUE(readTrajectory(directory_ / "trajectory.txt")
                  .back()
                  .T_world_body.isApprox(of_camera.back().T_world_body, 1e-6));
}

TEST_F(OfflineOdometryTest, NoMotionIsNoSuccess) {
  for (int i = 0; i < kPairs; ++i) {
    for (const char* side : {"/image_0", "/image_1"}) {
      cv::imwrite(sequence() + side + cv::format("/%06d.png", i),
                  cv::Mat(188, 620, CV_8UC1, cv::Scalar(128 + i)));
    }
  }
  const CommandResult result = run(sequence() + " --trajectory " + directory_ / "out.txt");
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.output.find("no pair has a motion: only 0 features were matched, fewer than 25 "
                               "(11 of 12 pairs)"),
            std::string::npos)
      << result.output;
}

TEST_F(OfflineOdometryTest, NamesWhatIsNoRecording) {
  std::filesystem::create_directory(directory_ / "ros2");
  directory_.write("ros2/metadata.yaml", "rosbag2_bagfile_information:\n  version: 5\n");
  directory_.write("drive.db3", "");
  const std::pair<std::string, const char*> rows[] = {
      {directory_ / "ros2", "ros2 is a bag of ROS 2: convert it"},
      {directory_ / "drive.db3", "drive.db3 is a bag of ROS 2: convert it"},
      {directory_ / "typo", "typo does not exist"}};
  for (const auto& [path, message] : rows) {
    const CommandResult result = run(path + " --trajectory " + directory_ / "out.txt");
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.output.find(message), std::string::npos) << result.output;
  }
}

TEST_F(OfflineOdometryTest, PreloadedImagesGiveTheSamePoses) {
  const std::string preloaded = trajectoryOf(sequence(), "--preload");
  EXPECT_FALSE(preloaded.empty());
  EXPECT_TRUE(preloaded == trajectoryOf(sequence()));
  const CommandResult result = run(sequence() + " --trajectory /dev/null --preload");
  for (const char* part :
       {"12 pairs: 11 ok, 0 degraded, 0 lost, 1 initializing", "peak memory: "}) {
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  }
}

TEST_F(OfflineOdometryTest, ABadImageIsNotTheEndOfTheRun) {
  directory_.write("sequence/image_0/000004.png", "no image");
  const CommandResult result = run(sequence() + " --trajectory /dev/null");
  EXPECT_EQ(result.status, 0) << result.output;
  for (const char* part : {"11 pairs: 10 ok, ",
                           "left out: 1 of 12 pairs (1 image_data);",
                           "000004.png is not a readable image"}) {
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
  }
}

TEST_F(OfflineOdometryTest, ThePoseIsKeptWhenTimeJumpsBack) {
  writeSequenceBag(directory_ / "once.bag", sequence());
  {
    const Bags once = openBags({directory_ / "once.bag"});
    rosbag::Bag again(directory_ / "again.bag", rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : BagView(once)) {
      again.write(message.getTopic(), message.getTime() + ros::Duration(60.0), message);
    }
  }
  const std::string bags = directory_ / "once.bag" + " " + directory_ / "again.bag";
  const CommandResult result = run(bags + " --trajectory " + directory_ / "loop.txt");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("24 pairs: 22 ok, 0 degraded, 0 lost, 2 init"), std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("first initializing, pair 12: "), std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("time jumps back"), std::string::npos) << result.output;
  const Trajectory poses = readTrajectory(directory_ / "loop.txt");
  ASSERT_EQ(poses.size(), 24u);
  EXPECT_TRUE(poses[12].T_world_body.isApprox(poses[11].T_world_body, 1e-9));

  const std::string odometry = directory_ / "odometry.bag";
  const std::string zero =
      " --set pose_after_time_jump=initial --set invert_tf=true --bag " + odometry;
  trajectoryOf(bags, zero);
  EXPECT_TRUE(readTrajectory(directory_ / "trajectory.txt")[12].T_world_body.isApprox(
      Eigen::Isometry3d::Identity(), 1e-9));
  const Bags bag = openBags({odometry});
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const rosbag::MessageInstance& message : BagView(bag, {"/tf"})) {
    transforms.push_back(readMessage<tf2_msgs::TFMessage>(message)->transforms.at(0));
  }
  ASSERT_EQ(transforms.size(), 24u) << "those of both times in turn, as their stamps are the same";
  EXPECT_EQ(transforms[1].transform.translation.x, 0.0);
  EXPECT_LT(transforms[23].transform.translation.x, -4.0) << "odom is behind";
  EXPECT_EQ(transforms[23].header.frame_id, "base_link");
  EXPECT_EQ(transforms[23].child_frame_id, "odom");
}

TEST_F(OfflineOdometryTest, SaysWhichMountItAssumes) {
  writeSequenceBag(directory_ / "once.bag", sequence());
  {
    const Bags once = openBags({directory_ / "once.bag"});
    rosbag::Bag bare(directory_ / "bare.bag", rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : BagView(once)) {
      if (message.getTopic() != "/tf_static") {
        bare.write(message.getTopic(), message.getTime(), message);
      }
    }
  }
  const std::string file = directory_ / "odometry.bag";
  const CommandResult result =
      run(directory_ / "bare.bag" + " --trajectory /dev/null --bag " + file);
  EXPECT_NE(result.output.find("no tf connects base_link and the left camera"), std::string::npos)
      << result.output;
}

/// Writes samples of a gyroscope with a bias during the drive, whose camera looks to and fro.
void writeGyroscope(const std::string& path) {
  std::ofstream file(path);
  for (int i = -1; i < 20 * kPairs; ++i) {
    const double rate_rps = 0.05 * 3.5 * std::cos(3.5 * 0.005 * i) - 0.02;
    file << i * 5'000'000LL << ",0.01," << rate_rps << ",0,0,0,0\n";
  }
}

TEST_F(OfflineOdometryTest, PredictsByAGyroscope) {
  const std::string imu = directory_ / "imu.csv";
  writeGyroscope(imu);
  const CommandResult result = run(sequence() + " --trajectory /dev/null --imu " + imu);
  EXPECT_NE(result.output.find("gyroscope: 11 of 11 rotations predicted"), std::string::npos)
      << result.output;
  const std::string once = trajectoryOf(sequence(), "--imu " + imu);
  EXPECT_NE(once, trajectoryOf(sequence()));
  EXPECT_TRUE(once == trajectoryOf(sequence(), "--imu " + imu + " --preload"));
}

TEST_F(OfflineOdometryTest, PredictsByAGyroscopeOfABag) {
  writeGyroscope(sequence() + "/imu.csv");
  writeSequenceBag(directory_ / "sequence.bag", sequence());
  const std::string bag = directory_ / "sequence.bag";
  const CommandResult result = run(bag + " --trajectory /dev/null --imu /imu/data");
  EXPECT_NE(result.output.find("gyroscope: 11 of 11 rotations predicted"), std::string::npos)
      << result.output;
  const CommandResult missing = run(bag + " --trajectory /dev/null --imu /imu");
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.output.find("neither a file nor a topic /imu"), std::string::npos)
      << missing.output;
}

TEST_F(OfflineOdometryTest, DistinguishesBadUsageFromBadInput) {
  const std::string good = sequence() + " --trajectory /dev/null";
  const struct {
    std::string arguments;
    int status;
    const char* message = "";
  } rows[] = {{"", 2},
              {sequence(), 2},  // --trajectory is missing
              {good + " --nonsense", 2},
              {"--help", 0},
              {"/nowhere --trajectory /dev/null", 1},
              {sequence() + " --trajectory /nowhere/out.txt", 1},
              {good + " --format xyz", 1},
              {good + " --frame wheel", 1, "not camera or base"},
              {good + " --frame base --mount '1 2 3'", 1, "x y z qx qy qz qw"},
              {good + " --rectify maybe", 1},
              {good + " --imu /nowhere", 1},
              {good + " --calibration a b c", 1, "calibration"},
              {good + " --set mask=/nowhere.png", 1, "the mask /nowhere.png is missing"},
              {good + " --bag /nowhere/out.bag", 1},
              {good + " --set feature_detector/max_features=5", 1, "[50, 20000]"}};
  for (const auto& row : rows) {
    const CommandResult result = run(row.arguments);
    EXPECT_EQ(result.status, row.status) << row.arguments;
    EXPECT_NE(result.output.find(row.message), std::string::npos) << result.output;
  }
  EXPECT_NE(trajectoryOf(sequence()),
            trajectoryOf(sequence(), "--set feature_detector/max_features=300"));
}

}  // namespace
}  // namespace rotrocc
