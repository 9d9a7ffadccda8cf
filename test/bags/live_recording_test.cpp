// Recordings of topics, to which a thread or the test itself publishes a short drive.

#include "bags/live_recording.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "bags/recorded_pairs.h"
#include "bags/sequence_recording.h"
#include "support/background_command.h"
#include "support/expect_error.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr int kPairs = 6;
constexpr milliseconds kPeriod(50);

std::vector<RecordedMessage> renderDrive() {
  const TemporaryDirectory directory;
  writeSyntheticSequence(directory / "sequence", kPairs);
  SequenceRecording sequence(directory / "sequence", {});
  sequence.select(sequence.begin(), sequence.end(), false);
  std::vector<RecordedMessage> drive(kPairs);
  for (RecordedMessage& message : drive) sequence.next(message);
  return drive;
}

/// Drives to and fro, with the topics in a namespace.
class Cameras {
 public:
  explicit Cameras(const std::string& name) : nh_(name), left_(nh_, "left"), right_(nh_, "right") {}

  void publishInfos(const ros::Time& stamp = ros::Time::now()) {
    send(left_.info, *drive().front().left_info, stamp);
    send(right_.info, *drive().front().right_info, stamp);
  }

  void publishImages() {
    const ros::Time stamp = ros::Time::now();
    const int phase = next_++ % (2 * kPairs - 2);
    const int pair = phase < kPairs ? phase : 2 * kPairs - 2 - phase;
    const RecordedMessage& message = drive()[static_cast<std::size_t>(pair)];
    send(left_.image, *message.left_image, stamp);
    send(right_.image, *message.right_image, stamp);
  }

  /// Whether a recording has subscribed to all.
  bool areSeen() const { return left_.isSeen() && right_.isSeen(); }

 private:
  struct Camera {
    Camera(ros::NodeHandle& nh, const std::string& side)
        : image(nh.advertise<sensor_msgs::Image>(side + "/image_rect", 100)),
          info(nh.advertise<sensor_msgs::CameraInfo>(side + "/camera_info", 100)) {}
    bool isSeen() const { return image.getNumSubscribers() > 0 && info.getNumSubscribers() > 0; }
    ros::Publisher image, info;
  };

  static const std::vector<RecordedMessage>& drive() {
    static const std::vector<RecordedMessage> drive = renderDrive();
    return drive;
  }

  template <class Message>
  static void send(const ros::Publisher& publisher, Message message, const ros::Time& stamp) {
    message.header.stamp = stamp;
    publisher.publish(message);
  }

  ros::NodeHandle nh_;
  Camera left_, right_;
  int next_ = 0;
};

/// Publishes images and infos in a thread.
class Stream {
 public:
  explicit Stream(Cameras& cameras)
      : thread_([this, &cameras] {
          for (; !ended_; std::this_thread::sleep_for(kPeriod)) {
            cameras.publishInfos();
            cameras.publishImages();
          }
        }) {}
  ~Stream() {
    ended_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

LiveOptions optionsOf(const std::string& name, double duration_s) {
  LiveOptions options;
  options.left_image = name + "/left/image_rect";
  options.right_image = name + "/right/image_rect";
  options.duration_s = duration_s;
  return options;
}

TEST(LiveRecordingTest, PairsComeUntilTheDurationIsOver) {
  constexpr double kDuration_s = 1.0;
  Cameras cameras("rig");
  const Stream stream(cameras);
  LiveRecording recording(optionsOf("rig", kDuration_s));
  EXPECT_EQ(recording.description(), "/rig/left/image_rect and /rig/right/image_rect");
  EXPECT_FALSE(recording.isRaw());
  RecordedPairs pairs(recording);
  EXPECT_GE(recording.end(), recording.begin());
  EXPECT_EQ(recording.size(), 30);
  StereoPair pair;
  StereoCamera camera;
  ASSERT_TRUE(pairs.next(pair, camera));
  const Clock::time_point first = Clock::now();
  int count = 1;
  while (pairs.next(pair, camera)) ++count;
  const std::chrono::duration<double> taken = Clock::now() - first;
  EXPECT_GT(taken.count(), 0.5 * kDuration_s);
  EXPECT_LT(taken.count(), 10.0 * kDuration_s);
  EXPECT_GT(count, 3);
  EXPECT_GT(camera.baseline_m, 0.0);
  EXPECT_EQ(recording.leftOut(), "");
  EXPECT_GE(recording.size(), count);
  EXPECT_LE(recording.size(), count + 1);

  RecordedMessage message;
  const Clock::time_point ended = Clock::now();
  EXPECT_FALSE(recording.next(message));
  EXPECT_LT(Clock::now() - ended, milliseconds(500));
}

TEST(LiveRecordingTest, WhatIsMissingIsNamed) {
  LiveRecording silent(optionsOf("nowhere", 1.0));
  expectError<std::runtime_error>([&] { RecordedPairs pairs(silent); },
                                  "no message of /nowhere/left/camera_info in 10 s: nobody");
  Cameras cameras("blind");
  LiveRecording blind(optionsOf("blind", 1.0));
  ASSERT_TRUE(waitUntil([&] { return cameras.areSeen(); }));
  cameras.publishInfos();
  RecordedPairs pairs(blind);
  StereoPair pair;
  StereoCamera camera;
  expectError<std::runtime_error>([&] { pairs.next(pair, camera); },
                                  "no message of /blind/left/image_rect in 10 s: somebody");
  expectError<std::runtime_error>([&] { pairs.next(pair, camera); }, "no pair that can be used");
  expectError<std::runtime_error>([&] { blind.gyroscope("/imu"); }, "/imu needs a bag");
}

TEST(LiveRecordingTest, WhatIsNotReadInTimeIsCounted) {
  Cameras cameras("fast");
  LiveRecording recording(optionsOf("fast", 600.0));
  ASSERT_TRUE(waitUntil([&] { return cameras.areSeen(); }));
  cameras.publishInfos();
  RecordedPairs pairs(recording);
  for (int i = 0; i < 40; ++i) {
    cameras.publishImages();
    std::this_thread::sleep_for(milliseconds(20));
  }
  const std::string expected =
      "10 left and 10 right images, because the check is slower than the camera";
  EXPECT_TRUE(waitUntil([&] { return recording.leftOut() == expected; })) << recording.leftOut();
  StereoPair pair;
  StereoCamera camera;
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(pairs.next(pair, camera)) << i;
}

std::string checkRig(const std::string& name, const std::string& options) {
  return std::string(CHECK_RIG) + " --live left:=/" + name + "/left/image_rect right:=/" + name +
         "/right/image_rect " + options;
}

TEST(LiveRecordingTest, IsCheckedByTheProgram) {
  Cameras cameras("camera");
  const Stream stream(cameras);
  const CommandResult result = runCommand(checkRig("camera", "--duration 2"));
  EXPECT_TRUE(result.status == 0 || result.status == 3) << result.status;
  EXPECT_NE(result.output.find("Rig check of /camera/left/image_rect and"), std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find(" pairs in "), std::string::npos) << result.output;
}

TEST(LiveRecordingTest, IsEndedByAnInterrupt) {
  const TemporaryDirectory directory;
  Cameras cameras("camera");
  const Stream stream(cameras);
  BackgroundCommand check(checkRig("camera", "--duration 600"), directory / "log");
  ASSERT_TRUE(waitUntil([&] { return cameras.areSeen(); }));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  check.interrupt();
  const std::string log = readFile(directory / "log");
  EXPECT_NE(log.find(" pairs in "), std::string::npos) << log;
}

TEST(LiveRecordingTest, BadUsageIsRefused) {
  const struct {
    std::string arguments;
    std::string message;
  } rows[] = {
      {"--live any.bag", "--live takes no recording: any.bag"},
      {"--live --duration 0", "--duration must be positive"},
      {"--live --write-camera-info here", "record a bag"},
      {"--live --left-image /left", "left:=TOPIC"},
      {"--live --calibration chain.yaml", "--calibration needs a recording"},
      {"--live __master:=http://localhost:1", "there is no ROS master at http://localhost:1"},
  };
  for (const auto& row : rows) {
    const CommandResult result = runCommand(std::string(CHECK_RIG) + " " + row.arguments);
    EXPECT_NE(result.output.find(row.message), std::string::npos)
        << row.arguments << ": " << result.output;
    EXPECT_TRUE(result.status == 1 || result.status == 2) << row.arguments;
  }
}

}  // namespace
}  // namespace rotrocc
