// Each kind of bad input and what is observed: bad_inputs.md beside this file. docs/bad_inputs.md
// has what is expected of them, and below of the tests in test/node, which have a ROS master.

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <boost/algorithm/string/join.hpp>
#include <opencv2/core.hpp>

#include "input/to_text.h"
#include "node/health/diagnostics.h"
#include "support/expected_file.h"
#include "support/log_recorder.h"
#include "support/odometry_rig.h"
#include "support/read_file.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

using Image = sensor_msgs::Image;
using Info = sensor_msgs::CameraInfo;
using Side = StereoIntake::Side;
using OneImageChange = std::function<void(Image&)>;
using OneInfoChange = std::function<void(Info&)>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

OdometryRig::ImageChange both(const OneImageChange& change) {
  return [change](Image& left, Image& right) {
    change(left);
    change(right);
  };
}

OdometryRig::InfoChange both(const OneInfoChange& change) {
  return [change](Info& left, Info& right) {
    change(left);
    change(right);
  };
}

/// A rig that has found its motion.
std::unique_ptr<OdometryRig> drivingRig(const Parameters& parameters = {}) {
  auto rig = std::make_unique<OdometryRig>(parameters);
  rig->sendInfos();
  rig->drivePairs(3);
  rig->forget();
  return rig;
}

/// What is observed at the last of some valid pairs that follow.
std::string recovery(OdometryRig& rig) {
  rig.forget();
  rig.drivePairs(4);
  return "; then " + rig.observed();
}

/// `pairs` changed pairs, then valid ones.
std::string badImages(const OdometryRig::ImageChange& change, int pairs = 1) {
  const auto rig = drivingRig();
  for (int i = 0; i < pairs; ++i) rig->drive(change);
  const std::string observed = rig->observed();
  return observed + recovery(*rig);
}

/// Chance matches may pass as a short motion, which is lost or degraded at the last pair.
std::string withoutChance(const std::string& observed) {
  return std::regex_replace(
      observed,
      std::regex("lost, (pose held|pose moved [0-2](\\.[0-9])? m), covariance "
                 "grows, twist unknown|degraded, moved 0\\.[0-9] m of 0.4 m"),
      "lost or degraded");
}

/// A pair with a changed left image, then valid ones.
std::string badLeft(const OneImageChange& change) {
  return badImages([&](Image& left, Image&) { change(left); });
}

/// Both changed infos with a pair, then valid ones.
std::string badInfos(const OdometryRig::InfoChange& change, const Parameters& parameters = {}) {
  const auto rig = drivingRig(parameters);
  rig->sendInfos(change);
  rig->drive();
  const std::string observed = rig->stateWithoutAnswers() + ", " + rig->observed();
  rig->sendInfos();
  return observed + recovery(*rig);
}

std::string badInfos(const OneInfoChange& change) {
  return badInfos(both(change));
}

/// With raw images, which are rectified.
Parameters rectifying() {
  Parameters parameters;
  parameters.node.rectify = true;
  return parameters;
}

std::string badRawInfos(const OneInfoChange& change) {
  return badInfos(both(change), rectifying());
}

/// A drive that is unusual from its first pair on.
std::string oddDrive(const OdometryRig::ImageChange& image_change,
                     const OdometryRig::InfoChange& info_change,
                     const Parameters& parameters = {}) {
  OdometryRig rig(parameters);
  rig.sendInfos(info_change);
  for (int i = 0; i < 3; ++i) rig.drive(image_change);
  return rig.observed();
}

/// A pair with another stamp.
std::string badStamp(const std::function<ros::Time(const ros::Time&)>& change) {
  return badImages(both([&](Image& image) { image.header.stamp = change(image.header.stamp); }));
}

cv::Mat pixelsOf(Image& image) {
  return cv::Mat(
      static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC1, image.data.data());
}

/// Other pixels for a mono8 image.
void setPixels(const cv::Mat& pixels, Image& image) {
  image.width = image.step = static_cast<std::uint32_t>(pixels.cols);
  image.height = static_cast<std::uint32_t>(pixels.rows);
  const cv::Mat copy = pixels.clone();
  image.data.assign(copy.datastart, copy.dataend);
}

/// 12 pairs of one gray level.
std::string plainImages(unsigned char level) {
  return badImages(both([&](Image& image) { image.data.assign(image.data.size(), level); }), 12);
}

/// Images whose header has another size than their data.
std::string headerOfSize(std::uint32_t width, std::uint32_t height, std::uint32_t step) {
  return badImages(both([&](Image& image) {
    image.encoding = "bgr8";
    image.width = width;
    image.height = height;
    image.step = step;
  }));
}

void fillWithNoise(Image& image) {
  static cv::RNG random(1);
  cv::Mat pixels = pixelsOf(image);
  random.fill(pixels, cv::RNG::UNIFORM, 0, 256);
}

void cropTo(Image& image, int width, int height) {
  setPixels(pixelsOf(image)(cv::Rect(0, 0, width, height)), image);
}

/// The uncovered border is black.
void move(Image& image, int right_px, int down_px) {
  const cv::Mat pixels = pixelsOf(image);
  cv::Mat moved = cv::Mat::zeros(pixels.size(), pixels.type());
  const cv::Size kept(pixels.cols - right_px, pixels.rows - down_px);
  pixels(cv::Rect({0, 0}, kept)).copyTo(moved(cv::Rect({right_px, down_px}, kept)));
  setPixels(moved, image);
}

/// A pair of another size than its camera_info.
std::string otherSize() {
  const auto rig = drivingRig();
  rig->drive(both([](Image& image) { cropTo(image, 620, 178); }));
  const std::string observed = rig->stateWithoutAnswers() + ", " + rig->observed();
  return observed + recovery(*rig);
}

std::string newResolution() {
  const auto rig = drivingRig();
  const auto crop = both([](Image& image) { cropTo(image, 560, 178); });
  rig->sendInfos(both([](Info& info) {
    info.width = 560;
    info.height = 178;
  }));
  rig->drive(crop);
  const std::string observed = rig->observed();
  rig->drive(crop);
  return observed + "; then " + rig->observed();
}

std::string frozenCamera() {
  std::optional<std::pair<Image, Image>> frozen;
  return badImages(
      [&](Image& left, Image& right) {
        if (!frozen) frozen = {left, right};
        left.data = frozen->first.data;
        right.data = frozen->second.data;
      },
      12);
}

/// Each image of one side is that of some pairs before.
std::string lateImages(std::size_t frames, bool is_right) {
  std::deque<std::vector<std::uint8_t>> shown;
  return badImages(
      [&](Image& left, Image& right) {
        Image& late = is_right ? right : left;
        shown.push_back(late.data);
        late.data = shown.front();
        if (shown.size() > frames) shown.pop_front();
      },
      16);
}

std::string halfImage() {
  const std::string observed = badLeft([](Image& image) {
    std::fill(image.data.begin() + image.data.size() / 2, image.data.end(), 128);
  });
  return observed.substr(observed.find("then"));
}

/// Infos sent three times, with the true baseline times `factor`.
std::string unusualBaseline(double factor) {
  const LogRecorder log;
  OdometryRig rig;
  for (int i = 0; i < 3; ++i) {
    rig.sendInfos([&](Info&, Info& right) { right.P[3] *= factor; });
    rig.drive();
  }
  const std::vector<std::string> warnings = log.with("baseline");
  const std::string warned = warnings.empty() ? "" : ", " + warnings.front();
  return rig.observed() + "; " + "warnings: " + toText(warnings.size()) + warned;
}

/// Images that are higher by a quarter, of a robot that also rises: straight ahead, the motion
/// would not depend on fy.
std::string unequalFocalLengths() {
  StereoCamera camera = SyntheticScene::defaultCamera();
  camera.fy *= 1.25;
  camera.cy *= 1.25;
  camera.height = camera.height * 5 / 4;
  const SyntheticScene scene(camera);
  const Eigen::Vector3d step_m(0.0, -0.2, 0.4);
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  OdometryRig rig;
  rig.sendInfos(both([&](Info& info) {
    info.height = static_cast<std::uint32_t>(camera.height);
    info.P[5] = camera.fy;
    info.P[6] = camera.cy;
  }));
  for (int i = 0; i < 3; ++i) {
    const StereoPair pair = scene.render(T_world_camera, 0);
    rig.drive([&](Image& left, Image& right) {
      setPixels(pair.left, left);
      setPixels(pair.right, right);
    });
    T_world_camera.translation() += step_m;
  }
  if (!rig.answer()) return rig.observed();
  const OdometryResult& result = rig.answer()->result;
  const bool right = (result.T_prev_cur.translation() - step_m).norm() < 0.05 * step_m.norm();
  return std::string(toString(result.state)) + (right ? ", ahead and up" : ", wrong motion");
}

/// The stamps jump, and the clock with them.
std::string timeJump(const std::string& pose, double by_s) {
  Parameters parameters;
  parameters.node.pose_after_time_jump = pose;
  const auto rig = drivingRig(parameters);
  rig->stamp += ros::Duration(by_s);
  rig->drive();
  const std::string observed = rig->observed();
  return observed + recovery(*rig);
}

/// The camera's clock is set, that of ROS is not, and images keep coming.
std::string clockSet(double by_s) {
  const auto rig = drivingRig();
  rig->stamp += ros::Duration(by_s);
  for (int i = 0; i < 6; ++i) {
    rig->clock = rig->stamp - ros::Duration(by_s);
    rig->drive();
  }
  return rig->observed();
}

/// One pair has stamps of 5 s ahead; the next one decides.
std::string stampGlitch() {
  const auto rig = drivingRig();
  rig->drive(both([](Image& image) { image.header.stamp += ros::Duration(5.0); }));
  const std::string at_once = rig->observed();
  rig->drive();
  const auto dropped = rig->drops().lastWithin(std::chrono::seconds(60));
  if (!dropped) return at_once;
  const std::string then = rig->observed() + ", dropped (" + toString(dropped->reason()) + ")";
  return at_once + "; with the next pair " + then + ": " + dropped->what() + recovery(*rig);
}

std::string skewed() {
  const auto rig = drivingRig();
  for (int i = 0; i < 55; ++i) {  // until the valid pairs are no longer recent
    rig->drive([](Image&, Image& right) { right.header.stamp += ros::Duration(0.03); });
  }
  const std::string observed = rig->observed() + "; " + whyNoPairs(rig->report()).value_or("");
  return observed + recovery(*rig);
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
  report.input = rig.report();
  StatusWrapper status;
  report.input_fault = faultOfPairs(report.input).value_or("");
  describeInput(report, status);
  return "20 left and 10 right images: " + toText(rig.answers()) + " pairs processed, the last " +
         rig.observed() + "; diagnostics: " + status.message;
}

/// Raw images of a rig whose right camera is turned about its axis of view.
std::string turnedCamera() {
  OdometryRig rig(rectifying());
  rig.sendInfos([](Info&, Info& right) {
    const double c = std::cos(0.02), s = std::sin(0.02);
    right.R = {1, 0, 0, 0, c, -s, 0, s, c};
  });
  rig.drivePairs(12);
  const std::string observed = rig.observed();
  rig.sendInfos();
  return observed + recovery(rig);
}

void noBaseline(Info&, Info& right) {
  right.P[3] = 0.0;
}

Parameters withBaseline() {
  Parameters parameters;
  parameters.node.baseline_m = 0.54;
  return parameters;
}

/// What readers expect of a kind of bad input, and what is observed in one or several cases.
/// P of images that are larger by a factor.
void scaleP(double factor, Info& info) {
  for (const std::size_t i : {0, 2, 3, 5, 6}) info.P[i] *= factor;
}

struct Row {
  const char* input;
  const char* expected;
  std::vector<std::string> observed;
};

// clang-format off
std::vector<Row> rows() {
  return {
    {"width or height 0", "dropped",
     {badLeft([](Image& image) { image.width = 0; }),
      badLeft([](Image& image) { image.height = 0; })}},
    {"less data than step x height", "dropped",
     {badLeft([](Image& image) { image.data.pop_back(); })}},
    {"step shorter than a row, as when the encoding is wrong", "dropped",
     {badLeft([](Image& image) { image.step -= 1; }),
      badLeft([](Image& image) { image.encoding = "bgr8"; })}},
    {"sizes whose product overflows 32 or 64 bits", "dropped",
     {headerOfSize(0xffffffff, 0xffffffff, 0xffffffff), headerOfSize(65536, 65536, 3 * 65536),
      headerOfSize(16, 65536, 65536)}},
    {"unknown or empty encoding", "dropped; the log lists the supported ones",
     {badLeft([](Image& image) { image.encoding = ""; }),
      badLeft([](Image& image) { image.encoding = "nv21"; })}},
    {"32FC1, a depth image", "dropped with a hint",
     {badLeft([](Image& image) { image.encoding = "32FC1"; })}},
    {"left and right of different sizes", "dropped; both sizes are reported",
     {badLeft([](Image& image) { cropTo(image, 620, 178); })}},
    {"image size differs from camera_info", "no calibration", {otherSize()}},
    {"new resolution with matching camera_info", "restarts within one pair; pose kept", {newResolution()}},

    {"black, white or gray images", "lost, pose held, covariance grows",
     {plainImages(0), plainImages(255), plainImages(128)}},
    {"noise", "lost, no jump", {badImages(both(fillWithNoise), 3)}},
    {"left and right identical", "lost, no depth",
     {badImages([](Image& left, Image& right) { right.data = left.data; }, 12)}},
    {"left and right swapped", "lost or degraded with a hint",
     {withoutChance(badImages(
         [](Image& left, Image& right) { std::swap(left.data, right.data); }, 12))}},
    {"frozen camera", "lost", {frozenCamera()}},
    {"right images one frame late, or left images two frames late", "lost or degraded with a hint",
     {withoutChance(lateImages(1, true)), withoutChance(lateImages(2, false))}},
    {"the lower half of an image is missing, as in a corrupted JPEG", "continues",
     {halfImage()}},
    {"images that are not rectified", "lost or degraded with a hint",
     {withoutChance(badImages([](Image&, Image& right) { move(right, 0, 7); }, 12))}},

    {"camera_info all zeros, or containing NaN", "no calibration",
     {badInfos([](Info& info) { info.P.fill(0.0); }),
      badInfos([](Info& info) { info.P[2] = kNan; })}},
    {"focal length not positive", "no calibration",
     {badInfos([](Info& info) { info.P[0] = -info.P[0]; })}},
    {"baseline 0", "no calibration; the message names baseline_m; accepted if that is set",
     {badInfos(noBaseline), "with baseline_m " + oddDrive({}, noBaseline, withBaseline())}},
    {"baseline negative", "no calibration with a hint",
     {badInfos([](Info& left, Info& right) { std::swap(left, right); })}},
    {"P for a different image size, or a principal point outside the image", "no calibration",
     {badInfos([](Info& left, Info& right) {
        for (Info* info : {&left, &right}) scaleP(2.0, *info);
      }),
      badInfos([](Info& left, Info& right) { left.P[6] = right.P[6] = 400.0; })}},
    {"P already scaled for binning, with binning also set", "accepted, with a warning",
     {oddDrive([](Image&, Image&) {}, [](Info& left, Info& right) {
        for (Info* info : {&left, &right}) {
          info->binning_x = info->binning_y = 2;
          info->width *= 2, info->height *= 2;
        }
      })}},
    {"baseline above 2 m or below 1 cm",
     "accepted with one warning; pairs are lost if the images have a different baseline",
     {unusualBaseline(1000.0), unusualBaseline(0.001)}},
    {"fx, fy or cy differs between left and right", "no calibration",
     {badInfos([](Info&, Info& right) { right.P[5] += 4.0; })}},
    {"cx differs between left and right", "accepted; both are used",
     {oddDrive([](Image&, Image& right) { move(right, 16, 0); },
               [](Info&, Info& right) { right.P[2] += 16.0; })}},
    {"fx differs from fy", "accepted; both are used", {unequalFocalLengths()}},

    {"stamp 0", "dropped", {badStamp([](const ros::Time&) { return ros::Time(); })}},
    {"stamp repeated", "dropped",
     {badStamp([](const ros::Time& t) { return t - ros::Duration(0.1); })}},
    {"stamp goes back slightly without a clock change", "dropped",
     {badStamp([](const ros::Time& t) { return t - ros::Duration(0.15); })}},
    {"time jumps back, as when a bag loops", "restarts within one pair; a parameter selects whether the pose is kept or reset to initial_pose",
     {"keep: " + timeJump("keep", -500.0), "initial: " + timeJump("initial", -500.0)}},
    {"time jumps ahead, permanently or for one pair only",
     "restarts, pose kept, twist unknown; a single pair is dropped as a glitch without a restart",
     {timeJump("keep", 500.0), "one pair: " + stampGlitch()}},
    {"the camera's clock is adjusted while running", "continues with one warning",
     {clockSet(8.0), clockSet(500.0), clockSet(-37.0)}},
    {"skew between left and right above the limit", "dropped; the skew is reported", {skewed()}},
    {"one camera slower", "a warning with both rates", {slowCamera()}},

    {"with rectify: unknown distortion model, D too short, or K or R all zeros", "no calibration",
     {badRawInfos([](Info& info) { info.distortion_model = "tilted"; }),
      badRawInfos([](Info& info) { info.D.resize(3); }),
      badRawInfos([](Info& info) { info.K.fill(0.0); }),
      badRawInfos([](Info& info) { info.R.fill(0.0), info.K[0] += 10.0; })}},
    {"with rectify: image size differs from camera_info", "no calibration",
     {badRawInfos([](Info& info) { info.height += 10; })}},
    {"with rectify: R of another rig", "lost or degraded with a hint",
     {withoutChance(turnedCamera())}}};
}
// clang-format on

TEST(BadInputsTest, EachIsHandledAsThePageSays) {
  const std::string page = readFile(ROTROCC_DOCS_DIR "/bad_inputs.md");
  std::string table =
      "Observed handling of bad input: written by bad_inputs_test, which fails if it is out of "
      "date.\n\"; then\" is the state after the valid pairs that follow.\n\n"
      "| input | observed |\n|---|---|\n";
  for (const Row& row : rows()) {
    const std::string input = "| " + std::string(row.input) + " | ";
    EXPECT_NE(page.find(input + row.expected + " |"), std::string::npos) << input;
    table += input + boost::join(row.observed, "; ") + " |\n";
  }
  expectFileHolds(ROTROCC_DOCS_DIR "/../test/input/bad_inputs.md", table);
}

}  // namespace
}  // namespace rotrocc
