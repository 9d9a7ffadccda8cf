// Each kind of bad input and what is observed: the rows of docs/bad_inputs.md. Those that need a
// ROS master are those of the tests in test/node.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "input/to_text.h"
#include "node/health/diagnostics.h"
#include "support/bad_input_table.h"
#include "support/log_recorder.h"
#include "support/odometry_rig.h"
#include "support/synthetic_scene.h"

namespace rotrocc {
namespace {

using Image = sensor_msgs::Image;
using Info = sensor_msgs::CameraInfo;
using Side = StereoIntake::Side;
using OneImageChange = std::function<void(Image&)>;
using OneInfoChange = std::function<void(Info&)>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

/// The same, compared with an unchanged drive.
std::string comparedDrive(const OdometryRig::ImageChange& image_change,
                          const OdometryRig::InfoChange& info_change = {},
                          const Parameters& parameters = {}) {
  UncertainTransform poses[2];
  std::string observed;
  for (const bool changed : {false, true}) {
    OdometryRig rig(changed ? parameters : Parameters());
    rig.sendInfos(changed ? info_change : OdometryRig::InfoChange());
    for (int i = 0; i < 3; ++i) rig.drive(changed ? image_change : OdometryRig::ImageChange());
    observed = rig.observed();
    if (rig.answer()) poses[changed ? 1 : 0] = rig.answer()->state.T_odom_base;
  }
  const bool same =
      poses[0].T.matrix() == poses[1].T.matrix() && poses[0].covariance == poses[1].covariance;
  return observed + (same ? ", bit-identical result" : ", but the result differs");
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

/// 12 pairs of one grey level.
std::string plainImages(unsigned char level) {
  return badImages(both([&](Image& image) { image.data.assign(image.data.size(), level); }), 12);
}

/// The same grey levels in as many bytes for each pixel.
void repeatBytes(const std::string& encoding, std::uint32_t channels, Image& image) {
  std::vector<unsigned char> data;
  for (const unsigned char level : image.data) data.insert(data.end(), channels, level);
  image.data = data;
  image.step *= channels;
  image.encoding = encoding;
}

/// A drive with grey levels as colours; swapped channels are a matter of StereoPairConverterTest.
std::string inColour(const std::string& encoding, std::uint32_t channels) {
  return encoding + " " +
         comparedDrive(both([&](Image& image) { repeatBytes(encoding, channels, image); }));
}

std::string inBayerPattern(const std::string& encoding) {
  return encoding + " " + oddDrive(both([&](Image& image) { image.encoding = encoding; }), {});
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

std::string plainImagesOfSize(int side) {
  return badImages(
      both([&](Image& image) { setPixels(cv::Mat(side, side, CV_8UC1, cv::Scalar(99)), image); }));
}

void fillWithNoise(Image& image, int seed) {
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  cv::Mat pixels = pixelsOf(image);
  random.fill(pixels, cv::RNG::UNIFORM, 0, 256);
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

/// Each pixel as a float, as in a depth image.
void toDepth(Image& image) {
  cv::Mat depth_m;
  pixelsOf(image).convertTo(depth_m, CV_32FC1);
  image.data.assign(depth_m.datastart, depth_m.dataend);
  image.encoding = "32FC1";
  image.step *= sizeof(float);
}

void padRows(Image& image, int padding) {
  cv::Mat padded;
  cv::copyMakeBorder(
      pixelsOf(image), padded, 0, 0, 0, padding, cv::BORDER_CONSTANT, cv::Scalar(255));
  const std::uint32_t width = image.width;
  setPixels(padded, image);
  image.width = width;
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
  const auto crop = both([](Image& image) { cropTo(image, 400, 150); });
  rig->sendInfos(both([](Info& info) {
    info.width = 400;
    info.height = 150;
  }));
  rig->drive(crop);
  const std::string observed = rig->observed();
  rig->drive(crop);
  return observed + "; then " + rig->observed();
}

std::string frozenCamera() {
  Image frozen_left, frozen_right;
  return badImages(
      [&](Image& left, Image& right) {
        if (frozen_left.data.empty()) {
          frozen_left = left;
          frozen_right = right;
        }
        left.data = frozen_left.data;
        right.data = frozen_right.data;
      },
      12);
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

void leaveOutDistortion(Info& info) {
  info.D.clear();
  info.distortion_model.clear();
}

/// The camera's full resolution is twice that of the images.
void bin(Info& info) {
  info.binning_x = info.binning_y = 2;
  info.width *= 2;
  info.height *= 2;
  for (std::size_t i = 0; i < 8; ++i) info.P[i] *= 2.0;
}

/// The images are a part of what the camera sees.
void crop(Info& info) {
  info.roi.width = info.width;
  info.roi.height = info.height;
  info.roi.x_offset = 100;
  info.roi.y_offset = 40;
  info.width += 300;
  info.height += 60;
  info.P[2] += info.roi.x_offset;
  info.P[6] += info.roi.y_offset;
}

std::string newFocalLength() {
  const auto rig = drivingRig();
  rig->sendInfos(both([](Info& info) {
    info.P[0] += 1.0;
    info.P[5] += 1.0;
  }));
  rig->drive();
  const std::string observed = rig->observed();
  return observed + recovery(*rig);
}

/// The stamps jump, and the clock with them unless `clock_stays`.
std::string timeJump(const std::string& pose, double by_s, bool clock_stays = false) {
  Parameters parameters;
  parameters.node.pose_after_time_jump = pose;
  const auto rig = drivingRig(parameters);
  if (clock_stays) rig->clock = rig->stamp;
  rig->stamp += ros::Duration(by_s);
  rig->drive();
  const std::string observed = rig->observed();
  if (clock_stays) rig->stamp -= ros::Duration(by_s);
  return observed + recovery(*rig);
}

/// One pair has stamps of 5 s ahead; the next one tells.
std::string stampGlitch() {
  const auto rig = drivingRig();
  rig->drive(both([](Image& image) { image.header.stamp += ros::Duration(5.0); }));
  const std::string at_once = rig->observed();
  rig->drive();
  const auto dropped = rig->drops().lastWithin(std::chrono::seconds(60));
  return at_once + "; with the next pair " + rig->observed() +
         (dropped
              ? std::string(", dropped (") + toString(dropped->reason()) + "): " + dropped->what()
              : "") +
         recovery(*rig);
}

std::string skewed() {
  const auto rig = drivingRig();
  for (int i = 0; i < 55; ++i) {  // until the valid pairs are no longer recent
    rig->drive([](Image&, Image& right) { right.header.stamp += ros::Duration(0.03); });
  }
  const std::string observed = rig->observed() + "; " + whyNoPairs(rig->report(rig->now()));
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
  report.input = rig.report(rig.now());
  StatusWrapper status;
  describeInput(report, status);
  return "20 left and 10 right images: " + toText(rig.answers()) + " pairs processed, the last " +
         rig.observed() + "; diagnostics: " + status.message;
}

/// Raw images of a rig whose right camera is turned about its axis of view.
std::string turnedCamera() {
  OdometryRig rig(rectifying());
  rig.sendInfos([](Info&, Info& right) {
    const double turn_rad = 0.02;
    right.R = {1,
               0,
               0,
               0,
               std::cos(turn_rad),
               -std::sin(turn_rad),
               0,
               std::sin(turn_rad),
               std::cos(turn_rad)};
  });
  rig.drivePairs(12);
  const std::string observed = rig.observed();
  rig.sendInfos();
  return observed + recovery(rig);
}

void observeMessages(BadInputTable& table) {
  table.add(1,
            "width or height 0",
            "dropped",
            {badLeft([](Image& image) { image.width = 0; }),
             badLeft([](Image& image) { image.height = 0; })});
  table.add(2, "no data", "dropped", {badLeft([](Image& image) { image.data.clear(); })});
  table.add(3, "less data than step x height", "dropped", {badLeft([](Image& image) {
              image.data.pop_back();
            })});
  table.add(4,
            "more data than step x height",
            "accepted, the rest is ignored",
            {comparedDrive(both([](Image& image) { image.data.resize(image.data.size() + 99); }))});
  table.add(
      5, "step shorter than a row", "dropped", {badLeft([](Image& image) { image.step -= 1; })});
  table.add(6,
            "step longer than a row",
            "accepted, the row padding is ignored",
            {comparedDrive([](Image& left, Image& right) {
              padRows(left, 13);
              padRows(right, 64);
            })});
  table.add(7,
            "sizes whose product overflows 32 or 64 bits",
            "dropped",
            {headerOfSize(0xffffffff, 0xffffffff, 0xffffffff),
             headerOfSize(65536, 65536, 3 * 65536),
             headerOfSize(16, 65536, 65536)});
  table.add(8,
            "unknown or empty encoding",
            "dropped, the supported ones are listed",
            {badLeft([](Image& image) { image.encoding = ""; }),
             badLeft([](Image& image) { image.encoding = "nv21"; })});
  table.add(9, "bgr8 with the step of mono8", "dropped", {badLeft([](Image& image) {
              image.encoding = "bgr8";
            })});
  table.add(10,
            "rgb8, bgr8, rgba8, bgra8",
            "accepted",
            {inColour("rgb8", 3), inColour("bgr8", 3), inColour("rgba8", 4), inColour("bgra8", 4)});
  table.add(11,
            "mono16 of 12 bits, both byte orders",
            "accepted, scaled: the same result as for mono8",
            {"little-endian " + comparedDrive(both([](Image& image) { to16Bits(image, false); })),
             "big-endian " + comparedDrive(both([](Image& image) { to16Bits(image, true); }))});
  table.add(12,
            "Bayer patterns",
            "accepted",
            {inBayerPattern("bayer_rggb8"),
             inBayerPattern("bayer_bggr8"),
             inBayerPattern("bayer_gbrg8"),
             inBayerPattern("bayer_grbg8")});
  table.add(13, "32FC1, a depth image", "dropped with a hint", {badLeft(toDepth)});
  table.add(14,
            "left and right of different sizes",
            "dropped, both sizes are reported",
            {badLeft([](Image& image) { cropTo(image, 620, 178); })});
  table.add(15,
            "left and right of different encodings",
            "accepted",
            {comparedDrive([](Image& left, Image&) { repeatBytes("bgr8", 3, left); })});
  table.add(16, "images not of the size in camera_info", "no calibration", {otherSize()});
  table.add(17,
            "new resolution with its camera_info",
            "restarts with one pair, pose kept",
            {newResolution()});
}

void observePictures(BadInputTable& table) {
  table.add(18,
            "black, white or grey images",
            "lost, pose held, covariance grows",
            {plainImages(0), plainImages(255), plainImages(128)});
  int seed = 0;
  table.add(19,
            "noise",
            "lost, no jump",
            {badImages(both([&](Image& image) { fillWithNoise(image, ++seed); }), 3)});
  table.add(20,
            "left and right identical",
            "lost, no depth",
            {badImages([](Image& left, Image& right) { right.data = left.data; }, 12)});
  table.add(21,
            "left and right swapped",
            "lost or degraded with a hint",
            {withoutChance(badImages(
                [](Image& left, Image& right) { std::swap(left.data, right.data); }, 12))});
  table.add(22, "frozen camera", "no motion, with a hint", {frozenCamera()});
  const std::string half = badLeft([](Image& image) {
    std::fill(image.data.begin() + image.data.size() / 2, image.data.end(), 128);
  });
  table.add(23,
            "the lower half of an image is missing, as after a corrupted JPEG",
            "continues",
            {half.substr(half.find("then"))});
  table.add(24,
            "very small or very large images",
            "dropped, memory bounded",
            {plainImagesOfSize(8), plainImagesOfSize(8192)});
  table.add(25,
            "images that are not rectified",
            "lost or degraded with a hint",
            {withoutChance(badImages([](Image&, Image& right) { move(right, 0, 7); }, 12))});
}

void observeBadInfos(BadInputTable& table) {
  table.add(27, "camera_info of zeros", "no calibration", {badInfos([](Info& info) {
              info.K.fill(0.0);
              info.R.fill(0.0);
              info.P.fill(0.0);
            })});
  table.add(28,
            "P with NaN or infinity",
            "no calibration",
            {badInfos([](Info& info) { info.P[2] = kNan; }),
             badInfos([](Info& left, Info&) { left.P[0] = kInfinity; }),
             badInfos([](Info&, Info& right) { right.P[3] = -kInfinity; })});
  table.add(29,
            "focal length not positive",
            "no calibration",
            {badInfos([](Info& info) { info.P[0] = -info.P[0]; }),
             badInfos([](Info& info) { info.P[5] = 0.0; })});
  const auto no_baseline = [](Info&, Info& right) { right.P[3] = 0.0; };
  Parameters with_baseline;
  with_baseline.node.baseline_m = 0.54;
  table.add(30,
            "baseline 0",
            "no calibration, the message names baseline_m; accepted with that",
            {badInfos(no_baseline), "with baseline_m " + oddDrive({}, no_baseline, with_baseline)});
  table.add(31,
            "baseline negative",
            "no calibration with a hint",
            {badInfos([](Info& left, Info& right) { std::swap(left, right); })});
  table.add(32,
            "baseline beyond 10 m or below 5 mm",
            "accepted with one warning; lost, as the images have another baseline",
            {unusualBaseline(1000.0), unusualBaseline(0.001)});
  table.add(33,
            "fx, fy or cy of left and right differ",
            "no calibration",
            {badInfos([](Info&, Info& right) { right.P[0] += 5.0; }),
             badInfos([](Info&, Info& right) { right.P[5] += 4.0; }),
             badInfos([](Info&, Info& right) { right.P[6] += 3.0; })});
}

void observeOddInfos(BadInputTable& table) {
  table.add(34,
            "cx of left and right differ",
            "accepted, both are used",
            {oddDrive([](Image&, Image& right) { move(right, 16, 0); },
                      [](Info&, Info& right) { right.P[2] += 16.0; })});
  table.add(35, "fx differs from fy", "accepted, both are used", {unequalFocalLengths()});
  table.add(36,
            "K differs from P, D is not zero",
            "accepted, P is used",
            {comparedDrive({}, both([](Info& info) {
                             info.K = {984.2, 0.0, 690.0, 0.0, 980.8, 233.2, 0.0, 0.0, 1.0};
                             info.D = {-0.37, 0.2, 0.001, 0.002, -0.07};
                           }))});
  table.add(37, "only P is filled", "accepted", {comparedDrive({}, both([](Info& info) {
                                                                 info.K.fill(0.0);
                                                                 info.R.fill(0.0);
                                                                 leaveOutDistortion(info);
                                                               }))});
  table.add(38,
            "binning, region of interest, or both",
            "accepted, P is scaled and moved",
            {"binning " + comparedDrive({}, both(bin)),
             "roi " + comparedDrive({}, both(crop)),
             "both " + comparedDrive({}, both([](Info& info) {
                                       bin(info);
                                       crop(info);
                                     }))});
  table.add(39,
            "camera_info changes during the run",
            "restarts with one pair, pose kept",
            {newFocalLength()});
}

void observeTimes(BadInputTable& table) {
  table.add(42, "stamp 0", "dropped", {badStamp([](const ros::Time&) { return ros::Time(); })});
  table.add(43, "stamp repeated", "dropped", {badStamp([](const ros::Time& t) {
              return t - ros::Duration(0.1);
            })});
  table.add(44,
            "stamp slightly back, but not the clock",
            "dropped",
            {badStamp([](const ros::Time& t) { return t - ros::Duration(0.15); })});
  table.add(45,
            "time jumps back: a bag in a loop",
            "restarts within one pair, pose kept or zero by parameter",
            {"keep: " + timeJump("keep", -500.0), "zero: " + timeJump("zero", -500.0)});
  table.add(46,
            "time jumps ahead, or the stamps alone",
            "restarts, pose kept, twist unknown; dropped if the clock does not jump; a single pair "
            "is dropped as a glitch, without a restart",
            {timeJump("keep", 500.0),
             "stamps alone: " + timeJump("keep", 500.0, true),
             "one pair: " + stampGlitch()});
  table.add(
      47, "skew of left and right above the limit", "dropped, the skew is reported", {skewed()});
  table.add(48, "one camera slower", "a warning with both rates", {slowCamera()});
}

void observeRawImages(BadInputTable& table) {
  table.add(53,
            "with rectify: unknown distortion model",
            "no calibration, the supported ones are listed",
            {badRawInfos([](Info& info) { info.distortion_model = "tilted"; })});
  table.add(54,
            "with rectify: D too short, or with NaN",
            "no calibration",
            {badRawInfos([](Info& info) { info.D.resize(3); }),
             badRawInfos([](Info& info) { info.D[1] = kNan; })});
  table.add(55,
            "with rectify: K or R of zeros",
            "no calibration",
            {badRawInfos([](Info& info) { info.K.fill(0.0); }),
             badRawInfos([](Info& info) { info.R.fill(0.0); })});
  table.add(56,
            "with rectify: no D, of images without distortion",
            "accepted",
            {comparedDrive({}, both(leaveOutDistortion), rectifying())});
  table.add(57,
            "with rectify: images not of the size in camera_info",
            "no calibration",
            {badRawInfos([](Info& info) { info.height += 10; })});
  table.add(58,
            "with rectify: R of another rig",
            "lost or degraded with a hint",
            {withoutChance(turnedCamera())});
}

TEST(BadInputsTest, EachIsHandledAsThePageSays) {
  BadInputTable table;
  observeMessages(table);
  observePictures(table);
  observeBadInfos(table);
  observeOddInfos(table);
  observeTimes(table);
  observeRawImages(table);
  table.expectInPage();
}

}  // namespace
}  // namespace rotrocc
