// 52 kinds of bad input, what the odometry is expected to make of each, and what it makes of it:
// docs/bad_inputs.md holds the table that this test makes.

#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "input/camera_validation.h"
#include "input/latest_mailbox.h"
#include "node/camera_mount.h"
#include "node/diagnostics.h"
#include "node/trajectory_history.h"
#include "support/expected_file.h"
#include "support/odometry_rig.h"

namespace rotrocc {
namespace {

using Image = sensor_msgs::Image;
using Info = sensor_msgs::CameraInfo;
using Side = StereoIntake::Side;

/// A rig that has found its motion.
std::unique_ptr<OdometryRig> drivingRig(const Parameters& parameters = {}) {
  auto rig = std::make_unique<OdometryRig>(parameters);
  rig->sendInfos();
  rig->drivePairs(3);
  rig->forget();
  return rig;
}

/// What is seen of the good pairs that follow.
std::string recovery(OdometryRig& rig) {
  rig.forget();
  rig.drivePairs(2);
  return "; then " + rig.observed();
}

/// A pair after a change of both images, and two good ones.
std::string badImages(const OdometryRig::ImageChange& change) {
  const auto rig = drivingRig();
  rig->drive(change);
  const std::string observed = rig->observed();
  return observed + recovery(*rig);
}

/// A pair after a change of the left image only.
std::string badLeft(const std::function<void(Image&)>& change) {
  return badImages([&](Image& left, Image&) { change(left); });
}

/// So many pairs after a change, and two good ones.
std::string badDrive(int pairs, const OdometryRig::ImageChange& change) {
  const auto rig = drivingRig();
  for (int i = 0; i < pairs; ++i) rig->drive(change);
  const std::string observed = rig->observed();
  return observed + recovery(*rig);
}

/// Bad infos with a pair each, and good ones.
std::string badInfos(const OdometryRig::InfoChange& change) {
  const auto rig = drivingRig();
  rig->sendInfos(change);
  rig->drive();
  const std::string observed = rig->observed();
  rig->sendInfos();
  return observed + recovery(*rig);
}

/// Infos that are odd but can be used.
std::string oddInfos(const OdometryRig::InfoChange& change) {
  OdometryRig rig;
  rig.sendInfos(change);
  rig.drivePairs(2);
  return rig.observed();
}

std::string badBoth(const std::function<void(Info&)>& change) {
  return badInfos([&](Info& left, Info& right) {
    change(left);
    change(right);
  });
}

/// A pair with another stamp.
std::string badStamp(const std::function<ros::Time(const ros::Time&)>& change) {
  const auto rig = drivingRig();
  rig->drive([&](Image& left, Image& right) {
    left.header.stamp = right.header.stamp = change(left.header.stamp);
  });
  const std::string observed = rig->observed();
  return observed + recovery(*rig);
}

void fill(Image& image, int value) {
  image.data.assign(image.data.size(), static_cast<unsigned char>(value));
}

void fillWithNoise(Image& image, int seed) {
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  cv::Mat pixels(
      static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC1, image.data.data());
  random.fill(pixels, cv::RNG::UNIFORM, 0, 256);
}

/// The image in another encoding, each byte `count` times.
void repeatBytes(Image& image, const std::string& encoding, std::uint32_t count) {
  std::vector<unsigned char> data;
  for (const unsigned char byte : image.data) data.insert(data.end(), count, byte);
  image.data = data;
  image.encoding = encoding;
  image.step *= count;
}

/// 12 bits in two bytes.
void to16Bits(Image& image, bool big_endian) {
  std::vector<unsigned char> data;
  for (const unsigned char byte : image.data) {
    const int value = byte << 4;
    const auto high = static_cast<unsigned char>(value >> 8);
    const auto low = static_cast<unsigned char>(value & 255);
    data.push_back(big_endian ? high : low);
    data.push_back(big_endian ? low : high);
  }
  image.data = data;
  image.encoding = "mono16";
  image.is_bigendian = big_endian;
  image.step *= 2;
}

void padRows(Image& image, std::size_t padding) {
  std::vector<unsigned char> data;
  for (std::size_t y = 0; y < image.height; ++y) {
    const auto row = image.data.begin() + static_cast<std::ptrdiff_t>(y * image.step);
    data.insert(data.end(), row, row + image.step);
    data.insert(data.end(), padding, 255);
  }
  image.data = data;
  image.step += static_cast<std::uint32_t>(padding);
}

void cropTo(Image& image, std::uint32_t width, std::uint32_t height) {
  std::vector<unsigned char> data;
  for (std::size_t y = 0; y < height; ++y) {
    const auto row = image.data.begin() + static_cast<std::ptrdiff_t>(y * image.step);
    data.insert(data.end(), row, row + width);
  }
  image.data = data;
  image.width = image.step = width;
  image.height = height;
}

void moveDown(Image& image, std::size_t rows) {
  image.data.insert(image.data.begin(), rows * image.step, 0);
  image.data.resize(std::size_t{image.step} * image.height);
}

std::string paddedRows() {
  const auto padded = drivingRig();
  padded->drive([](Image& left, Image& right) {
    padRows(left, 13);
    padRows(right, 64);
  });
  const auto plain = drivingRig();
  plain->drive();
  const auto pose = [](const OdometryRig& rig) {
    return rig.answer()->state.T_odom_base.T.matrix();
  };
  return padded->observed() +
         (pose(*padded) == pose(*plain) ? ", the same bits as without" : ", but not the same");
}

std::string sixteenBits() {
  std::string observed;
  for (const bool big_endian : {false, true}) {
    OdometryRig rig;
    rig.sendInfos();
    for (int i = 0; i < 3; ++i) {
      rig.drive([&](Image& left, Image& right) {
        to16Bits(left, big_endian);
        to16Bits(right, big_endian);
      });
    }
    observed += (observed.empty() ? "" : ", big-endian ") + rig.observed();
  }
  return observed;
}

std::string newResolution() {
  const auto rig = drivingRig();
  const double before_m = 3 * 0.4;
  const auto crop = [](Image& left, Image& right) {
    cropTo(left, 400, 150);
    cropTo(right, 400, 150);
  };
  rig->sendInfos([](Info& left, Info& right) {
    left.width = right.width = 400;
    left.height = right.height = 150;
  });
  rig->drive(crop);
  std::string observed = rig->observed();
  EXPECT_NEAR(rig->answer()->state.T_odom_base.T.translation().x(), before_m - 0.4, 0.1);
  rig->drive(crop);
  return observed + "; then " + rig->observed();
}

std::string neverInfos() {
  OdometryRig rig;
  rig.drivePairs(3);
  InputReport report = rig.intake().report(rig.now());
  report.left_info.topic = "left/camera_info";
  return whyNoPairs(report);
}

std::string unusualBaseline() {
  std::string oddity;
  const std::string observed = oddInfos([&](Info& left, Info& right) {
    right.P[3] *= 1000.0;
    oddity = oddityOf(toStereoCamera(left, right));
  });
  return observed + ": " + oddity;
}

std::string emptyFrame() {
  const auto empty = [](Image& left, Image&) { left.header.frame_id.clear(); };
  Parameters parameters;
  parameters.node.camera_frame = "camera";
  const auto rig = drivingRig(parameters);
  rig->drive(empty);
  return badImages(empty) + "; with camera_frame " + rig->observed();
}

std::string timeJump(const std::string& pose, double by_s) {
  Parameters parameters;
  parameters.node.pose_after_time_jump = pose;
  const auto rig = drivingRig(parameters);
  rig->stamp += ros::Duration(by_s);
  rig->drive();
  const double x_m = rig->answer()->state.T_odom_base.T.translation().x();
  EXPECT_EQ(rig->answer()->state.twist.covariance(0, 0), 9999.0);
  const std::string where = x_m > 0.5 ? "pose kept" : "pose zero";
  const std::string observed = rig->observed() + ", " + where;
  return observed + recovery(*rig);
}

std::string skewed() {
  const auto rig = drivingRig();
  for (int i = 0; i < 8; ++i) {
    rig->drive([](Image&, Image& right) { right.header.stamp += ros::Duration(0.03); });
  }
  // When the pairs before are long enough ago, and the images are not.
  const auto later = rig->now() + std::chrono::milliseconds(4350);
  const std::string observed = rig->observed();
  return observed + ", " + whyNoPairs(rig->intake().report(later));
}

std::string slowCamera() {
  OdometryRig rig;
  rig.sendInfos();
  for (int i = 0; i < 20; ++i) {
    rig.sendImage(Side::kLeft, rig.nextImage(Side::kLeft));
    if (i % 2 == 0) rig.sendImage(Side::kRight, rig.nextImage(Side::kRight));
    rig.advance();
  }
  HealthReport report;
  report.input = rig.intake().report(rig.now());
  report.input.left_image.topic = "left/image_rect";
  report.input.right_image.topic = "right/image_rect";
  StatusWrapper status;
  describeInput(report, status);
  return "pairs at the slower rate; diagnostics: " + status.message;
}

std::string burst() {
  LatestMailbox<int> mailbox;
  int dropped = 0;
  for (int i = 1; i <= 100; ++i) dropped += mailbox.put(i) ? 1 : 0;
  std::ostringstream text;
  text << "pair " << *mailbox.take(std::chrono::milliseconds(0)) << " of 100 is processed, "
       << dropped << " dropped (newer_pair_came)";
  return text.str();
}

std::string noClock() {
  InputReport report;
  report.clock_missing = true;
  return whyNoPairs(report);
}

std::string badTf() {
  geometry_msgs::Transform transform;
  std::string observed;
  for (const double w : {std::nan(""), 0.5}) {
    transform.rotation.w = w;
    try {
      toEigen(transform);
    } catch (const std::exception& error) {
      observed += (observed.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  return observed;
}

std::string services() {
  OdometryRig rig;
  rig.processor().requestReset();
  rig.sendInfos();
  for (int i = 0; i < 5; ++i) {
    rig.processor().requestReset();
    rig.drive();
  }
  std::string observed = "reset before each pair: " + rig.observed();
  TrajectoryHistory history(10);
  for (const char* path : {"", "/no/such/directory/poses.txt"}) {
    try {
      history.save(path, "tum");
    } catch (const std::exception& error) {
      observed += std::string("; ") + error.what();
    }
    history.add({});
  }
  return observed;
}

struct BadInput {
  const char* input;
  const char* expected;
  std::function<std::string()> observe;
  const char* part;  ///< of what is observed; the table shows all of it
};

std::vector<BadInput> imageCases() {
  return {
      {"width or height 0",
       "dropped",
       [] { return badLeft([](Image& image) { image.width = 0; }); },
       "dropped (image_size)"},
      {"no data",
       "dropped",
       [] { return badLeft([](Image& image) { image.data.clear(); }); },
       "dropped (image_data)"},
      {"less data than step x height",
       "dropped",
       [] { return badLeft([](Image& image) { image.data.pop_back(); }); },
       "dropped (image_data)"},
      {"more data than step x height",
       "accepted, the rest is not looked at",
       [] { return badLeft([](Image& image) { image.data.resize(image.data.size() + 99); }); },
       "ok"},
      {"step shorter than a row",
       "dropped",
       [] { return badLeft([](Image& image) { image.step -= 1; }); },
       "dropped (image_step)"},
      {"step longer than a row", "accepted, the same result", paddedRows, "the same bits"},
      {"sizes whose product overflows",
       "dropped before any allocation",
       [] {
         return badLeft(
             [](Image& image) { image.width = image.height = image.step = 0xffffffffu; });
       },
       "dropped (image_size)"},
      {"unknown or empty encoding",
       "dropped, the known ones are listed",
       [] { return badLeft([](Image& image) { image.encoding = ""; }); },
       "dropped (image_encoding)"},
      {"bgr8 with the step of mono8",
       "dropped",
       [] { return badLeft([](Image& image) { image.encoding = "bgr8"; }); },
       "dropped (image_step)"},
      {"rgb8, bgr8, rgba8, bgra8",
       "accepted",
       [] {
         return badImages([](Image& left, Image& right) {
           repeatBytes(left, "rgb8", 3);
           repeatBytes(right, "bgra8", 4);
         });
       },
       "ok"},
      {"mono16 of 12 bits, both byte orders", "accepted, scaled", sixteenBits, "ok, big-endian ok"},
      {"bayer_rggb8",
       "accepted",
       [] {
         return badImages(
             [](Image& left, Image& right) { left.encoding = right.encoding = "bayer_rggb8"; });
       },
       "ok"},
      {"32FC1, a depth image",
       "dropped with a hint",
       [] { return badLeft([](Image& image) { repeatBytes(image, "32FC1", 4); }); },
       "depth image?"},
      {"left and right of different sizes",
       "dropped, both sizes are told",
       [] { return badLeft([](Image& image) { image.height -= 10; }); },
       "dropped (image_sizes_differ)"},
      {"left and right of different encodings",
       "accepted",
       [] { return badLeft([](Image& image) { repeatBytes(image, "bgr8", 3); }); },
       "ok"},
      {"images not of the size in camera_info",
       "no calibration",
       [] {
         return badImages([](Image& left, Image& right) { left.height = right.height -= 10; });
       },
       "dropped (image_not_of_camera_info)"},
      {"new resolution with its camera_info",
       "starts anew for one pair, pose kept",
       newResolution,
       "initialising; then ok"},
      {"black images",
       "lost, pose held, covariance grows",
       [] {
         return badDrive(12, [](Image& left, Image& right) {
           fill(left, 0);
           fill(right, 0);
         });
       },
       "lost, hint: the left image shows hardly any corner"},
      {"noise",
       "lost, no jump",
       [] {
         int seed = 0;
         return badDrive(3, [&](Image& left, Image& right) {
           fillWithNoise(left, ++seed);
           fillWithNoise(right, ++seed);
         });
       },
       "lost"},
      {"left and right identical",
       "lost, no depth",
       [] { return badDrive(12, [](Image& left, Image& right) { right.data = left.data; }); },
       "lost, hint: left and right image are identical"},
      {"left and right exchanged",
       "lost with a hint",
       [] {
         return badDrive(12, [](Image& left, Image& right) { std::swap(left.data, right.data); });
       },
       "exchange their topics"},
      {"frozen camera",
       "warned of",
       [] {
         Image frozen_left, frozen_right;
         return badDrive(12, [&](Image& left, Image& right) {
           if (frozen_left.data.empty()) {
             frozen_left = left;
             frozen_right = right;
           }
           left.data = frozen_left.data;
           right.data = frozen_right.data;
         });
       },
       "is the camera frozen?"},
      {"corrupted JPEG: the transport gives no image",
       "goes on",
       [] {
         const auto rig = drivingRig();
         rig->sendImage(Side::kLeft, rig->nextImage(Side::kLeft));
         rig->advance();
         const std::string observed = rig->observed();
         return observed + recovery(*rig);
       },
       "no odometry; then ok"},
      {"very small or very large images",
       "dropped, memory bounded",
       [] {
         return badLeft([](Image& image) { image.width = image.height = 8; }) + "; " +
                badLeft([](Image& image) { image.width = image.height = image.step = 8192; });
       },
       "more than max_image_pixels"},
      {"images that are not rectified",
       "lost or degraded with a hint",
       [] { return badDrive(12, [](Image&, Image& right) { moveDown(right, 7); }); },
       "they are not rectified"},
  };
}

std::vector<BadInput> infoCases() {
  return {
      {"camera_info never comes", "warned of by name", neverInfos, "left/camera_info"},
      {"camera_info of zeros",
       "no calibration",
       [] { return badBoth([](Info& info) { info.P.fill(0.0); }); },
       "the camera is not calibrated"},
      {"P with NaN or infinity",
       "no calibration",
       [] { return badBoth([](Info& info) { info.P[2] = std::nan(""); }); },
       "P[2] of the left camera_info is nan"},
      {"focal length not positive",
       "no calibration",
       [] { return badBoth([](Info& info) { info.P[0] = -info.P[0]; }); },
       "must be positive"},
      {"baseline 0",
       "no calibration, baseline_m is named",
       [] { return badInfos([](Info&, Info& right) { right.P[3] = 0.0; }); },
       "set the parameter baseline_m"},
      {"baseline negative",
       "no calibration with a hint",
       [] { return badInfos([](Info& left, Info& right) { std::swap(left, right); }); },
       "are left and right exchanged?"},
      {"baseline beyond 10 m or below 5 mm",
       "accepted, warned of once",
       unusualBaseline,
       "a baseline of 540 m is unusual"},
      {"fx or cy of left and right differ",
       "no calibration",
       [] { return badInfos([](Info&, Info& right) { right.P[6] += 3.0; }); },
       "not rectified as a pair: cy"},
      {"cx of left and right differ",
       "accepted, both are used",
       [] { return oddInfos([](Info&, Info& right) { right.P[2] += 0.4; }); },
       "ok"},
      {"fx differs from fy",
       "accepted",
       [] { return oddInfos([](Info& left, Info& right) { left.P[5] = right.P[5] *= 1.02; }); },
       "ok"},
      {"K differs from P, D is not zero",
       "accepted, P is used",
       [] {
         return oddInfos([](Info& left, Info&) {
           left.K.fill(3.0);
           left.D = {0.3, 0.1, 0.0, 0.0, 0.0};
           left.distortion_model = "plumb_bob";
         });
       },
       "ok"},
      {"only P is filled", "accepted", [] { return oddInfos({}); }, "ok"},
      {"binning and region of interest",
       "accepted, P is scaled",
       [] {
         return oddInfos([](Info& left, Info& right) {
           for (Info* info : {&left, &right}) {
             info->binning_x = info->binning_y = 2;
             info->width *= 2;
             info->height *= 2;
             for (std::size_t i = 0; i < 8; ++i) info->P[i] *= 2.0;
           }
         });
       },
       "ok"},
      {"camera_info changes in mid-stream",
       "starts anew for one pair, pose kept",
       [] {
         const auto rig = drivingRig();
         rig->sendInfos([](Info& left, Info& right) {
           left.P[0] = right.P[0] += 1.0;
           left.P[5] = right.P[5] += 1.0;
         });
         rig->drive();
         const std::string observed = rig->observed();
         return observed + recovery(*rig);
       },
       "initialising; then ok"},
      {"frame_id empty", "dropped, or camera_frame is used", emptyFrame, "with camera_frame ok"},
      {"frame_id of left and right differ",
       "accepted, the left image's counts",
       [] { return badImages([](Image&, Image& right) { right.header.frame_id = "other"; }); },
       "ok"},
  };
}

std::vector<BadInput> timeCases() {
  return {
      {"stamp 0",
       "dropped",
       [] { return badStamp([](const ros::Time&) { return ros::Time(); }); },
       "dropped (stamp_zero)"},
      {"stamp repeated",
       "dropped",
       [] { return badStamp([](const ros::Time& t) { return t - ros::Duration(0.1); }); },
       "dropped (stamp_repeated)"},
      {"stamp slightly back",
       "dropped",
       [] { return badStamp([](const ros::Time& t) { return t - ros::Duration(0.15); }); },
       "dropped (stamp_backward)"},
      {"time goes back: a bag in a loop",
       "starts anew within one pair, pose kept or zero by parameter",
       [] { return "keep: " + timeJump("keep", -500.0) + "; zero: " + timeJump("zero", -500.0); },
       "keep: initialising, pose kept; then ok; zero: initialising, pose zero; then ok"},
      {"time jumps ahead",
       "starts anew, pose kept, twist unknown",
       [] { return timeJump("keep", 500.0); },
       "initialising, pose kept; then ok"},
      {"skew of left and right above the limit",
       "dropped, the skew is told",
       skewed,
       "stamps are up to 30 ms apart"},
      {"one camera slower",
       "warned of with both rates",
       slowCamera,
       "left/image_rect comes at 10.0 Hz, right/image_rect at 5.0 Hz"},
      {"burst of 100 pairs",
       "the newest is processed, drops are counted",
       burst,
       "pair 100 of 100"},
      {"use_sim_time without /clock", "warned of", noClock, "nothing comes on /clock"},
      {"tf with NaN or a quaternion not of unit length",
       "refused; a missing one is waited for",
       badTf,
       "the transform holds nan"},
      {"services at any time, bad path",
       "answer without success, no deadlock",
       services,
       "cannot write /no/such/directory/poses.txt"},
  };
}

TEST(BadInputsTest, EachIsHandledAsTheTableSays) {
  std::vector<BadInput> cases = imageCases();
  for (const auto& more : {infoCases(), timeCases()}) {
    cases.insert(cases.end(), more.begin(), more.end());
  }
  ASSERT_EQ(cases.size(), 52u);
  std::ostringstream table;
  table << "# Bad input\n\nWhat the odometry makes of input that robots do send. Made by "
           "`bad_inputs_test`, which "
           "fails if this is out of date; `ROTROCC_UPDATE_FILES=1 "
           "build/devel/lib/rotrocc/bad_inputs_test` "
           "makes it anew. After each, good pairs follow.\n\n| | input | expected | observed "
           "|\n|---|---|---|---|\n";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::string observed = cases[i].observe();
    EXPECT_NE(observed.find(cases[i].part), std::string::npos)
        << "case " << i + 1 << ", " << cases[i].input << ": " << observed;
    table << "| " << i + 1 << " | " << cases[i].input << " | " << cases[i].expected << " | "
          << observed << " |\n";
  }
  expectFileHolds(std::string(ROTROCC_DOCS_DIR) + "/bad_inputs.md", table.str());
}

}  // namespace
}  // namespace rotrocc
