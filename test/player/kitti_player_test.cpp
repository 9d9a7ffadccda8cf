// The player with an odometry of a few lines, in one process.

#include "player/kitti_player.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include "bags/bag_reading.h"
#include "bags/sequence_bag_writer.h"
#include "check/calibration_correction.h"
#include "input/stereo_synchronizer.h"
#include "rotrocc/OdometryStatus.h"
#include "sequences/stereo_sequence.h"
#include "support/asl_folder.h"
#include "support/expect_error.h"
#include "support/kitti2bag_writer.h"
#include "support/service_caller.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;

constexpr int kPairs = 6;  // at 10 Hz

/// Subscribes to all topics of the player, and answers each pair with an odometry of the same
/// stamp.
class Listener {
 public:
  explicit Listener(ros::NodeHandle nh)
      : odom_(nh.advertise<nav_msgs::Odometry>("odom", 10)),
        status_(nh.advertise<OdometryStatus>("status", 10)) {
    count<sensor_msgs::CameraInfo>(nh, "left/camera_info");
    count<sensor_msgs::CameraInfo>(nh, "right/camera_info");
    count<geometry_msgs::PoseStamped>(nh, "ground_truth/pose");
    count<nav_msgs::Path>(nh, "ground_truth/path");
    count<rosgraph_msgs::Clock>(nh, "/clock");
    count<tf2_msgs::TFMessage>(nh, "/tf");
    count<tf2_msgs::TFMessage>(nh, "/tf_static");
    subscribers_.push_back(nh.subscribe("left/image_rect", 10, &Listener::onLeft, this));
    subscribers_.push_back(nh.subscribe("right/image_rect", 10, &Listener::onRight, this));
  }

  /// Whether all topics are connected.
  bool connected() const {
    return std::all_of(subscribers_.begin(), subscribers_.end(), [](const ros::Subscriber& s) {
      return s.getNumPublishers() > 0;
    });
  }

  /// Messages received on a topic, as it is named above.
  int count(const std::string& topic) const {
    std::lock_guard<std::mutex> lock(mutex_);
    const auto found = counts_.find(topic);
    return found == counts_.end() ? 0 : found->second;
  }

  std::vector<ros::Time> leftStamps() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return left_stamps_;
  }

  /// From now on, pairs are not answered.
  void fallSilent() { silent_ = true; }

  /// From now on, pairs are lost, and as with the parameter while_lost silent have no odometry.
  void loseAll() { lost_ = true; }

 private:
  template <typename Message>
  void count(ros::NodeHandle& nh, const std::string& topic) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [this, topic](const boost::shared_ptr<const Message>&) {
          std::lock_guard<std::mutex> lock(mutex_);
          ++counts_[topic];
        };
    subscribers_.push_back(nh.subscribe<Message>(topic, 100, callback));
  }

  void onLeft(const sensor_msgs::Image::ConstPtr& image) {
    std::lock_guard<std::mutex> lock(mutex_);
    left_stamps_.push_back(image->header.stamp);
    answer(synchronizer_.add(StereoSynchronizer::Side::kLeft, image));
  }

  void onRight(const sensor_msgs::Image::ConstPtr& image) {
    std::lock_guard<std::mutex> lock(mutex_);
    answer(synchronizer_.add(StereoSynchronizer::Side::kRight, image));
  }

  void answer(const std::optional<StereoImages>& pair) {
    if (!pair || silent_) return;
    if (lost_) {
      OdometryStatus status;
      status.header.stamp = pair->left->header.stamp;
      status.state = OdometryStatus::LOST;
      return status_.publish(status);
    }
    nav_msgs::Odometry odometry;
    odometry.header.stamp = pair->left->header.stamp;
    odom_.publish(odometry);
  }

  ros::Publisher odom_, status_;
  mutable std::mutex mutex_;
  std::map<std::string, int> counts_;
  std::vector<ros::Time> left_stamps_;
  StereoSynchronizer synchronizer_{0.01, 10};
  std::atomic<bool> silent_{false}, lost_{false};
  std::vector<ros::Subscriber> subscribers_;
};

class KittiPlayerTest : public ::testing::Test {
 protected:
  KittiPlayerTest() {
    spinner_.start();
    private_nh_.deleteParam("");
    private_nh_.setParam("bag", directory_ / "test.bag");
    private_nh_.setParam("lockstep_timeout_s", 600.0);
    private_nh_.setParam("rate", 0.0);
    writeSyntheticSequence(directory_ / "sequence", kPairs);
  }

  StereoSequence sequence() const { return openStereoSequence(directory_ / "sequence", {}); }
  std::string bag() const { return directory_ / "test.bag"; }

  void writeOwnBag() const { writeSequenceBag(bag(), directory_ / "sequence"); }

  void startPlayer() {
    ended_ = false;
    player_ = std::make_unique<KittiPlayer>(nh_, private_nh_, [this] { ended_ = true; });
  }

  void play(const Listener& listener) {
    private_nh_.setParam("paused", true);
    startPlayer();
    ASSERT_TRUE(waitUntil([&] { return listener.connected(); }));
    player_->setPaused(false);
  }

  bool waitForEnd() const {
    return waitUntil([this] { return ended_.load(); });
  }

  void playToTheEnd(const Listener& listener) {
    play(listener);
    ASSERT_TRUE(waitForEnd());
  }

  /// Waits for them, as the last messages may still be in transit.
  static void expectCount(const Listener& listener, const std::string& topic, int count) {
    waitUntil([&] { return listener.count(topic) >= count; });
    EXPECT_EQ(listener.count(topic), count) << topic;
  }

  TemporaryDirectory directory_;
  ros::NodeHandle nh_{"stereo"};
  ros::NodeHandle private_nh_{"player"};
  ros::AsyncSpinner spinner_{1};
  std::atomic<bool> ended_{false};
  std::unique_ptr<KittiPlayer> player_;
};

TEST_F(KittiPlayerTest, PlaysAllOfOwnBagsAndSequences) {
  writeOwnBag();
  for (const std::string& recording : {bag(), directory_ / "sequence"}) {
    SCOPED_TRACE(recording);
    private_nh_.setParam("bag", recording);
    Listener listener(nh_);
    playToTheEnd(listener);
    const std::vector<ros::Time> stamps = listener.leftStamps();
    ASSERT_EQ(stamps.size(), static_cast<std::size_t>(kPairs));
    EXPECT_EQ(stamps.front(), ros::Time(1317600000.0));
    expectCount(listener, "left/camera_info", kPairs + 1);  // one ahead of all images
    expectCount(listener, "right/camera_info", kPairs + 1);
    expectCount(listener, "ground_truth/pose", kPairs);
    expectCount(listener, "ground_truth/path", 1);
    expectCount(listener, "/tf_static", 1);
    EXPECT_GE(listener.count("/clock"), kPairs);
    player_.reset();  // with its latched topics
  }
}

TEST_F(KittiPlayerTest, PlaysImagesAloneByFilesOfTheirCalibration) {
  writeOwnBag();
  const Bags bags = openBags({bag()});
  rosbag::Bag images(directory_ / "images.bag", rosbag::bagmode::Write);
  for (const rosbag::MessageInstance& message : BagView(bags)) {
    if (message.getDataType() != "sensor_msgs/Image") continue;
    images.write(message.getTopic(), message.getTime(), message);
  }
  images.close();
  writeCalibration(rectifiedCalibration(sequence().calibration.rectified), directory_ / "files");
  private_nh_.setParam("bag", directory_ / "images.bag");
  private_nh_.setParam("calibration",
                       directory_ / "files/left.yaml" + " " + directory_ / "files/right.yaml");
  Listener listener(nh_);
  playToTheEnd(listener);
  EXPECT_EQ(listener.leftStamps().size(), static_cast<std::size_t>(kPairs));
  EXPECT_GT(listener.count("right/camera_info"), 0);
}

/// demo_test has one that is being written.
TEST_F(KittiPlayerTest, GivesUpASequenceThatIsNotFinished) {
  for (const char* folder : {"image_0", "image_1"}) {
    for (int i = 1; i < kPairs; ++i) {
      std::filesystem::remove(std::filesystem::path(directory_ / "sequence") / folder /
                              ("00000" + std::to_string(i) + ".png"));
    }
  }
  private_nh_.setParam("bag", directory_ / "sequence");
  for (const double timeout_s : {0.1, 600.0}) {
    private_nh_.setParam("image_timeout_s", timeout_s);
    Listener listener(nh_);
    play(listener);
    ASSERT_TRUE(waitUntil([&] { return listener.leftStamps().size() == 1; }));
    if (timeout_s > 1.0) player_.reset();
    EXPECT_TRUE(waitForEnd());
  }
  private_nh_.setParam("image_timeout_s", 0.0);
  Listener listener(nh_);
  play(listener);
  ASSERT_TRUE(waitUntil([&] { return listener.leftStamps().size() == 1; }));
  EXPECT_TRUE(waitForEnd());
}

TEST_F(KittiPlayerTest, ShowsRecordedPosesInsteadOfTheirTf) {
  writeKitti2bagRaw(sequence(), bag());
  Listener listener(nh_);
  playToTheEnd(listener);
  EXPECT_EQ(listener.leftStamps().size(), static_cast<std::size_t>(kPairs));
  EXPECT_EQ(listener.count("/tf"), 0);
  expectCount(listener, "ground_truth/pose", kPairs);
  expectCount(listener, "ground_truth/path", 1);
}

TEST_F(KittiPlayerTest, BeginsAndEndsWhereItIsReported) {
  writeOwnBag();
  private_nh_.setParam("start", 0.15);
  private_nh_.setParam("duration", 0.2);
  for (const std::string& recording : {bag(), directory_ / "sequence"}) {
    private_nh_.setParam("bag", recording);
    Listener listener(nh_);
    playToTheEnd(listener);
    const ros::Time begin(1317600000, 0);
    EXPECT_EQ(listener.leftStamps(),
              (std::vector<ros::Time>{begin + ros::Duration(0.2), begin + ros::Duration(0.3)}));
    player_.reset();
  }
}

TEST_F(KittiPlayerTest, GoesOnWithoutOdometryAfterTheTimeout) {
  writeOwnBag();
  private_nh_.setParam("lockstep_timeout_s", 0.1);
  Listener listener(nh_);
  listener.fallSilent();
  const auto begin = std::chrono::steady_clock::now();
  playToTheEnd(listener);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, kPairs * milliseconds(100));
  EXPECT_TRUE(waitUntil([&] { return listener.leftStamps().size() == kPairs; }));
}

/// Otherwise it would wait for lockstep_timeout_s at each of them.
TEST_F(KittiPlayerTest, TheStatusAnswersALostPair) {
  writeOwnBag();
  Listener listener(nh_);
  listener.loseAll();
  playToTheEnd(listener);
  EXPECT_EQ(listener.leftStamps().size(), static_cast<std::size_t>(kPairs));
}

TEST_F(KittiPlayerTest, WaitsForSubscribersAndPausesByService) {
  writeOwnBag();
  private_nh_.setParam("paused", true);
  startPlayer();
  std_srvs::SetBool request;
  request.request.data = false;
  ServiceCaller player("/player");
  ASSERT_TRUE(player.call("pause", request));
  EXPECT_TRUE(request.response.success);
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_FALSE(ended_);
  Listener listener(nh_);
  EXPECT_TRUE(waitForEnd());
  EXPECT_EQ(listener.leftStamps().size(), static_cast<std::size_t>(kPairs));

  startPlayer();
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(listener.leftStamps().size(), static_cast<std::size_t>(kPairs)) << "it is paused";
}

TEST_F(KittiPlayerTest, RestartsInALoop) {
  writeOwnBag();
  private_nh_.setParam("loop", true);
  Listener listener(nh_);
  play(listener);
  EXPECT_TRUE(waitUntil([&] { return listener.leftStamps().size() > 2 * kPairs; }));
  EXPECT_FALSE(ended_);
  EXPECT_EQ(listener.leftStamps().at(kPairs), ros::Time(1317600000.0));
  player_.reset();
}

TEST_F(KittiPlayerTest, RejectsWhatItCannotPlay) {
  writeOwnBag();
  const AslFolder raw;
  writeSequenceBag(directory_ / "raw.bag", raw.path());
  rosbag::Bag(directory_ / "empty.bag", rosbag::bagmode::Write).close();
  const struct {
    const char* name;
    XmlRpc::XmlRpcValue value;
    const char* message;
  } rows[] = {
      {"rate", -1.0, "rate is -1"},
      {"start", 60.0, "start is 60 s, but the recording is only 0.5"},
      {"bag", directory_ / "missing.bag", "missing.bag does not exist"},
      {"bag", directory_ / "empty.bag", "no stereo pair ("},
      {"bag", directory_ / "raw.bag", "raw.bag are not rectified: start with rectify:=true"},
      {"bag", directory_ / "", "is no stereo sequence"},
      {"bag", "", "parameter bag is missing"},
  };
  for (const auto& row : rows) {
    private_nh_.setParam("bag", bag());
    private_nh_.setParam("rate", 1.0);
    private_nh_.setParam("start", 0.0);
    private_nh_.setParam(row.name, row.value);
    expectError([this] { startPlayer(); }, row.message);
  }
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "kitti_player_test");
  const ros::NodeHandle keeps_ros_alive_between_the_tests;
  return RUN_ALL_TESTS();
}
