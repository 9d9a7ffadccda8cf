// A drive in real time with one fault after the other: no image is lost in silence, the odometry
// recovers, and the log has the cause of each fault once.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "input/camera_calibration.h"
#include "input/message_conversion.h"
#include "node/odometry_messages.h"
#include "rotrocc/OdometryStatus.h"
#include "rotrocc/SaveTrajectory.h"
#include "sequences/kitti_mount.h"
#include "support/read_file.h"
#include "support/service_caller.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

using Image = sensor_msgs::Image;
using Pose = Eigen::Isometry3d;

constexpr std::size_t kPairs = 30;  // rendered, and shown forwards and backwards
const ros::Duration kPeriod(0.1);
constexpr int kBurst = 20;  // pairs at once
const std::string kNode = "/stereo_odometry";

/// What is sent, left and right, and how.
struct Pair {
  std::array<Image, 2> images;
  std::array<sensor_msgs::CameraInfo, 2> infos;
  std::array<bool, 2> send = {true, true};
  Pose T_wheels_base;  ///< of guess_frame
  bool send_guess = true;
  bool burst = false;    ///< the pairs of the next 2 s come at once, after these
  double ahead_s = 0.0;  ///< the clock of all sensors
  double pause_s = 0.0;  ///< nothing is sent for so long afterwards
};

/// Sends pairs at 10 Hz, and listens to the odometry.
class Drive {
 public:
  using Change = std::function<void(Drive&, Pair&)>;

  Drive() {
    const SyntheticScene scene;
    const auto [left, right] = toCameraInfos(rectifiedCalibration(scene.camera()));
    std_msgs::Header header;
    header.frame_id = "camera";
    for (std::size_t i = 0; i < kPairs; ++i) {
      const double yaw_rad = 0.05 * std::sin(0.35 * static_cast<double>(i));
      const Pose T_world_camera = Eigen::Translation3d(0.0, 0.0, 0.5 * static_cast<double>(i)) *
                                  Pose(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()));
      const StereoPair pair = scene.render(T_world_camera, 0);
      Pair& rendered = rendered_.emplace_back();
      rendered.images = {*cv_bridge::CvImage(header, "mono8", pair.left).toImageMsg(),
                         *cv_bridge::CvImage(header, "mono8", pair.right).toImageMsg()};
      rendered.infos = {left, right};
      rendered.T_wheels_base = kittiMount() * T_world_camera * kittiMount().inverse();
    }
    EXPECT_TRUE(waitUntil([this] {
      return std::all_of(publishers_.begin(), publishers_.end(), [](const ros::Publisher& topic) {
        return topic.getNumSubscribers() > 0;
      });
    })) << "there is no odometry";
    next_ = ros::Time::now();
  }

  /// The next pair, after a change.
  void send(const Change& change = {}) {
    stamp_ = ros::Time::now();
    Pair pair = nextPair(stamp_);
    if (change) change(*this, pair);
    for (Image& image : pair.images) image.header.stamp += ros::Duration(pair.ahead_s);
    if (pair.send_guess) sendTf(pair.T_wheels_base, "wheel_odom", "base_link", pair.ahead_s);
    publish(pair);
    next_ += kPeriod + ros::Duration(pair.pause_s);
    if (pair.burst) {
      next_ += kPeriod * kBurst;
      listenUntil(next_ - kPeriod);
      for (int i = 1; i <= kBurst; ++i) publish(nextPair(stamp_ + kPeriod * i));
    }
    sent_ = std::move(pair);
    listenUntil(next_);
  }

  /// Until a pair that is sent from now on is OK.
  bool recover() {
    const ros::Time begin = ros::Time::now();
    return waitUntil([&] {
      send();
      return status_.state == OdometryStatus::OK && status_.header.stamp >= begin;
    });
  }

  void sendTf(const Pose& T, const char* parent, const char* child, double ahead_s = 0.0) {
    const std::int64_t stamp_ns = toNanoseconds(stamp_ + ros::Duration(ahead_s));
    tf_.sendTransform(toTransform(T, stamp_ns, parent, child));
  }
  void publishMount(double height_m) {
    const Pose T_base_camera = Eigen::Translation3d(0, 0, height_m) * kittiMount();
    static_tf_.sendTransform(toTransform(T_base_camera, 0, "base_link", "camera"));
  }
  void reset() {
    std_srvs::Trigger reset;
    EXPECT_TRUE(services_.call("reset", reset));
  }
  void save(const std::string& path) {
    SaveTrajectory save;
    save.request.path = path;
    save.request.format = "tum";
    EXPECT_TRUE(services_.call("save_trajectory", save));
    EXPECT_FALSE(save.response.success);
  }
  double chance() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  const Pair& lastSent() const { return sent_; }
  std::size_t pairs() const { return pairs_; }

  /// Whether a warning or an error since the last takeLog() has a text.
  bool hasLogged(const std::string& text) const {
    return std::any_of(log_.begin(), log_.end(), [&](const std::string& line) {
      return line.find(text) != std::string::npos;
    });
  }
  /// Warnings and errors since the last call.
  std::vector<std::string> takeLog() { return std::exchange(log_, {}); }

  /// Each image that arrived is used or dropped for a reason.
  void expectAllImagesInStatus() {
    for (int i = 0; i < 3; ++i) send();                  // no image waits for a partner
    listenUntil(ros::Time::now() + ros::Duration(4.0));  // the diagnostics come once a second
    EXPECT_TRUE(waitUntil([this] {
      ros::spinOnce();
      return sum(received_) == accounted();
    })) << sent_images_
        << " sent, " << sum(received_) << " received, " << accounted() << " used or dropped";
    EXPECT_LE(sum(received_), sent_images_);
    for (const char* reason : {"no_partner", "tf_missing", "stamp_zero", "image_data"}) {
      EXPECT_GT(dropped_[reason], 0u) << reason;
    }
  }

 private:
  Pair nextPair(const ros::Time& stamp) {
    const std::size_t turn = pairs_++ % (2 * kPairs - 2);
    Pair pair = rendered_[std::min(turn, 2 * kPairs - 2 - turn)];
    for (Image& image : pair.images) {
      image.header.stamp = stamp;
      // Noise: where it turns around, the pair after a dropped one would be the one before it.
      image.data[0] = static_cast<unsigned char>(pairs_);
    }
    return pair;
  }

  void publish(const Pair& pair) {
    for (int side : {0, 1}) publishers_[2 + side].publish(pair.infos[side]);
    for (int side : {0, 1}) {
      if (!pair.send[side]) continue;
      ++sent_images_;
      publishers_[side].publish(pair.images[side]);
    }
  }

  static void listenUntil(const ros::Time& time) {
    do {
      ros::spinOnce();
      ros::WallDuration(0.005).sleep();
    } while (ros::Time::now() < time);
  }

  void onOdometry(const nav_msgs::Odometry& message) {
    std::ostringstream text;
    text << message;
    EXPECT_EQ(text.str().find("nan"), std::string::npos) << message;
  }

  void onStatus(const OdometryStatus& message) {
    status_ = message;
    for (const DropCount& drop : message.drops) {
      const bool is_one = drop.reason == "no_partner" || drop.reason == "partner_dropped" ||
                          drop.reason.rfind("stamp_", 0) == 0;
      const unsigned images = drop.reason == "camera_info_invalid" ? 0 : is_one ? 1 : 2;
      dropped_[drop.reason] = images * drop.count;
    }
  }

  /// The part "input" has, for each topic: "10.0 Hz, 50 in 5 s, 123 in total, 1 publishers".
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
    for (const auto& part : message.status) {
      for (const auto& [key, value] : part.values) {
        unsigned long total = 0;
        if (key.find("image_rect") != std::string::npos &&
            std::sscanf(value.c_str(), "%*f Hz, %*u in 5 s, %lu in total", &total) == 1) {
          received_[key] = total;
        }
      }
    }
  }

  void onLog(const rosgraph_msgs::Log& message) {
    const bool is_own = message.name == ros::this_node::getName();
    if (!is_own && message.level >= rosgraph_msgs::Log::WARN) log_.push_back(message.msg);
  }

  using Counts = std::map<std::string, std::uint64_t>;
  static std::uint64_t sum(const Counts& counts) {
    std::uint64_t sum = 0;
    for (const auto& [name, count] : counts) sum += count;
    return sum;
  }
  std::uint64_t accounted() const { return 2 * status_.pairs_processed + sum(dropped_); }

  std::vector<Pair> rendered_;
  std::size_t pairs_ = 0;
  ros::Time stamp_, next_;  // of this pair, and when the next one is sent
  Pair sent_;               // last
  std::mt19937 random_;

  OdometryStatus status_;
  std::uint64_t sent_images_ = 0;
  Counts dropped_, received_;  // images, by reason and by topic
  std::vector<std::string> log_;

  ros::NodeHandle nh_;
  tf2_ros::TransformBroadcaster tf_;
  tf2_ros::StaticTransformBroadcaster static_tf_;
  ServiceCaller services_{kNode};
  std::array<ros::Publisher, 4> publishers_ = {
      nh_.advertise<Image>("left/image_rect", 100),
      nh_.advertise<Image>("right/image_rect", 100),
      nh_.advertise<sensor_msgs::CameraInfo>("left/camera_info", 100),
      nh_.advertise<sensor_msgs::CameraInfo>("right/camera_info", 100)};
  std::array<ros::Subscriber, 4> subscribers_ = {
      nh_.subscribe("odom", 1000, &Drive::onOdometry, this),
      nh_.subscribe("status", 1000, &Drive::onStatus, this),
      nh_.subscribe("/diagnostics", 1000, &Drive::onDiagnostics, this),
      nh_.subscribe("/rosout", 1000, &Drive::onLog, this)};
};

/// Puts the cameras on a head that turns, whose tf comes for each third pair.
void putOnHead(Drive& drive, Pair& pair) {
  pair.images[0].header.frame_id = "head";
  if (drive.pairs() % 3 != 0) return;
  const Eigen::AngleAxisd pan(1e-3 * (drive.pairs() / 3 % 2), Eigen::Vector3d::UnitZ());
  drive.sendTf(pan * kittiMount(), "base_link", "head");
}

void freeze(Drive& drive, Pair& pair) {
  for (const int side : {0, 1}) pair.images[side].data = drive.lastSent().images[side].data;
}

void jitter(Drive& drive, Pair& pair) {
  for (auto& info : pair.infos) info.P[0] *= 1.0 + 1e-9 * drive.chance();
}

void changeMount(Drive& drive, Pair&) {
  drive.publishMount(0.1);
  drive.reset();
}

Drive::Change ofImage(int side, const std::function<void(Image&)>& change) {
  return [=](Drive&, Pair& pair) { change(pair.images[side]); };
}
Drive::Change ofBoth(const std::function<void(Image&)>& change) {
  return [=](Drive&, Pair& pair) { std::for_each(pair.images.begin(), pair.images.end(), change); };
}
Drive::Change ofPair(const std::function<void(Pair&)>& change) {
  return [=](Drive&, Pair& pair) { change(pair); };
}

/// How long a fault lasts at least, and the valid pairs after it.
struct Span {
  int pairs;
  double rest_s;
};
constexpr Span kOnce = {1, 1.0};
constexpr Span kGap = {1, 6.0};        // gaps are logged each 5 s
constexpr Span kShort = {20, 1.0};     // logged at once
constexpr Span kLoss = {40, 2.0};      // longer than LossLog waits for a cause
constexpr Span kSilence = {60, 6.0};   // longer than no_input_warning_s
constexpr Span kLasting = {100, 6.0};  // longer than the 5 s of the statistics, and 5 s more

struct Fault {
  const char* name;
  /// Parts of what the log says of it: each of its lines has one of them, and one has the first.
  std::vector<std::string> says;
  Span span;
  Drive::Change change;
};

const double kNan = std::numeric_limits<double>::quiet_NaN();
const char* const kSync = "trigger the cameras synchronously";
const char* const kBack = "time jumped back";
const char* const kStep = "the stamps of the left images stepped by";
const char* const kFrame = "the left images' frame_id changed";

// clang-format off
const std::vector<Fault> kFaults = {
    {"no tf of the camera", {"no tf from base_link"}, kSilence, {}},
    {"left image missing", {}, kOnce, ofPair([](Pair& pair) { pair.send[0] = false; })},
    {"right image missing", {}, kOnce, ofPair([](Pair& pair) { pair.send[1] = false; })},
    {"30 % of the right images lost", {"have no partner"}, kLasting,
     [](Drive& drive, Pair& pair) { pair.send[1] = drive.chance() >= 0.3; }},
    {"stamp 0", {"has the stamp 0"}, kShort, ofImage(0, [](Image& i) { i.header.stamp = {}; })},
    {"stamps of a glitch", {"a glitch"}, kGap,
     ofBoth([](Image& image) { image.header.stamp += ros::Duration(5.0); })},
    {"stamps apart", {kSync}, kSilence,
     ofImage(1, [](Image& image) { image.header.stamp += ros::Duration(0.04); })},
    {"the sensors' clock 20 s behind", {"behind the clock", kBack, kStep}, kLasting,
     ofPair([](Pair& pair) { pair.ahead_s = -20.0; })},
    {"the sensors' clock 3 s ahead", {"ahead of the clock", kBack, kStep}, kLasting,
     ofPair([](Pair& pair) { pair.ahead_s = 3.0; })},
    {"data cut off", {"bytes of data"}, kShort, ofImage(0, [](Image& i) { i.data.resize(9); })},
    {"unknown encoding", {"has the encoding"}, kShort,
     ofImage(0, [](Image& image) { image.encoding = "jpeg"; })},
    {"sizes that overflow", {"more than 50000000 pixels"}, kShort,
     ofImage(0, [](Image& image) { image.width = image.height = image.step = ~0u; })},
    {"step too short", {"a step of"}, kShort, ofImage(0, [](Image& i) { i.step /= 2; })},
    {"sizes differ", {"same resolution"}, kShort, ofImage(1, [](Image& i) { i.height -= 2; })},
    {"camera_info of NaN", {"camera_info is nan"}, kShort,
     ofPair([](Pair& pair) { pair.infos[0].P[0] = kNan; })},
    {"camera_info of zeros", {"all zeros"}, kShort,
     ofPair([](Pair& pair) { pair.infos[1].P.fill(0.0); })},
    {"camera_info whose last digits change", {}, kShort, jitter},
    {"exchanged cameras", {"swap their topics"}, kLoss,
     ofPair([](Pair& pair) { std::swap(pair.images[0].data, pair.images[1].data); })},
    {"images that are not rectified", {"not rectified", "rows of left and right differ"}, kLoss,
     ofImage(1, [](Image& image) { image.data.insert(image.data.begin(), 7 * image.step, 0); })},
    {"black images", {"is it too small, dark"}, kLoss,
     ofBoth([](Image& image) { image.data.assign(image.data.size(), 0); })},
    {"frozen images", {"frozen"}, kLoss, freeze},
    {"burst", {}, kGap, ofPair([](Pair& pair) { pair.burst = true; })},
    {"a gap of 3 s", {"arrive again"}, kGap, ofPair([](Pair& pair) { pair.pause_s = 3.0; })},
    {"a mount that moves with 3 Hz of tf", {"which moves, arrives at", kFrame}, kLasting, putOnHead},
    {"another mount on /tf_static, and a reset", {}, kOnce, changeMount},
    {"no tf of guess_frame", {"no pose from guess_frame"}, kShort,
     ofPair([](Pair& pair) { pair.send_guess = false; })},
    {"rival tf publisher", {"a frame has only one parent"}, kSilence,
     [](Drive& drive, Pair&) { drive.sendTf(Pose::Identity(), "rival_odom", "wheel_odom"); }},
    {"save_trajectory into no folder", {"No such file or directory"}, kOnce,
     [](Drive& drive, Pair&) { drive.save("/no/such/directory/poses.txt"); }},
};
// clang-format on

/// Of a machine that is too busy for the drive, whose queues overflow: any fault may then lose the
/// motion.
const std::vector<std::string> kOfLoad = {
    "no stereo pair", "stereo pairs arrive again", "have no partner", "lost"};

bool hasOneOf(const std::string& line, const std::vector<std::string>& parts) {
  return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
    return line.find(part) != std::string::npos;
  });
}

/// Makes a fault, and returns what the log says of it. A fault that lasts ends when it is reported:
/// a busy machine takes longer to find its cause.
std::vector<std::string> make(const Fault& fault, Drive& drive) {
  for (int i = 0; i < fault.span.pairs; ++i) drive.send(fault.change);
  waitUntil([&] {
    const bool is_done =
        fault.says.empty() || fault.span.pairs == 1 || drive.hasLogged(fault.says.front());
    if (!is_done) drive.send(fault.change);
    return is_done;
  });
  if (!fault.change) drive.publishMount(0.0);
  EXPECT_TRUE(drive.recover());
  const ros::Time end = ros::Time::now() + ros::Duration(fault.span.rest_s);
  while (ros::Time::now() < end) drive.send();
  return drive.takeLog();
}

TEST(EnduranceTest, TheCauseOfEachFaultIsReportedOnceAndNoImageIsLost) {
  Drive drive;
  std::string transcript;
  for (const Fault& fault : kFaults) {
    SCOPED_TRACE(fault.name);
    transcript += fault.name + std::string("\n");
    std::size_t causes = 0;
    for (const std::string& line : make(fault, drive)) {
      transcript += "    " + line.substr(std::min(line.size(), kNode.size() + 2)) + '\n';
      if (!fault.says.empty() && hasOneOf(line, {fault.says.front()})) ++causes;
      EXPECT_TRUE(hasOneOf(line, fault.says) || hasOneOf(line, kOfLoad)) << line;
    }
    EXPECT_EQ(causes, fault.says.empty() ? 0u : 1u);
  }
  drive.expectAllImagesInStatus();
  std::cout << transcript;
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "endurance");
  return RUN_ALL_TESTS();
}
