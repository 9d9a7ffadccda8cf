// Each kind of bad input and what is observed: the first table of docs/bad_inputs.md. The second
// one is that of the tests in test/node, which have a ROS master.

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

/// The rows of the first table.
class Rows {
 public:
  /// A kind of bad input, what readers expect, and what is observed in one or several cases.
  void add(const std::string& input,
           const std::string& expected,
           const std::vector<std::string>& observed) {
    text_ += "| " + input + " | " + expected + " | " + boost::join(observed, "; ") + " |\n";
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

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

/// 12 pairs of one grey level.
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

void fillWithNoise(Image& image, int seed) {
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  cv::Mat pixels = pixelsOf(image);
  random.fill(pixels, cv::RNG::UNIFORM, 0, 256);
}

/// Each pixel as a float, as in a depth image.
void toDepth(Image& image) {
  cv::Mat depth_m;
  pixelsOf(image).convertTo(depth_m, CV_32FC1);
  image.data.assign(depth_m.datastart, depth_m.dataend);
  image.encoding = "32FC1";
  image.step *= sizeof(float);
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
  const std::string observed = rig->observed() + "; " + whyNoPairs(rig->report());
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
  report.input_fault = faultOfPairs(report.input);
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

void observeMessages(Rows& rows) {
  rows.add("width or height 0",
           "dropped",
           {badLeft([](Image& image) { image.width = 0; }),
            badLeft([](Image& image) { image.height = 0; })});
  rows.add("less data than step x height",
           "dropped",
           {badLeft([](Image& image) { image.data.pop_back(); })});
  rows.add("step shorter than a row, as with another encoding",
           "dropped",
           {badLeft([](Image& image) { image.step -= 1; }),
            badLeft([](Image& image) { image.encoding = "bgr8"; })});
  rows.add("sizes whose product overflows 32 or 64 bits",
           "dropped",
           {headerOfSize(0xffffffff, 0xffffffff, 0xffffffff),
            headerOfSize(65536, 65536, 3 * 65536),
            headerOfSize(16, 65536, 65536)});
  rows.add("unknown or empty encoding",
           "dropped, the supported ones are listed",
           {badLeft([](Image& image) { image.encoding = ""; }),
            badLeft([](Image& image) { image.encoding = "nv21"; })});
  rows.add("32FC1, a depth image", "dropped with a hint", {badLeft(toDepth)});
  rows.add("left and right of different sizes",
           "dropped, both sizes are reported",
           {badLeft([](Image& image) { cropTo(image, 620, 178); })});
  rows.add("images not of the size in camera_info", "no calibration", {otherSize()});
  rows.add("new resolution with its camera_info",
           "restarts with one pair, pose kept",
           {newResolution()});
}

void observePictures(Rows& rows) {
  rows.add("black, white or grey images",
           "lost, pose held, covariance grows",
           {plainImages(0), plainImages(255), plainImages(128)});
  int seed = 0;
  rows.add("noise",
           "lost, no jump",
           {badImages(both([&](Image& image) { fillWithNoise(image, ++seed); }), 3)});
  rows.add("left and right identical",
           "lost, no depth",
           {badImages([](Image& left, Image& right) { right.data = left.data; }, 12)});
  rows.add("left and right swapped",
           "lost or degraded with a hint",
           {withoutChance(badImages(
               [](Image& left, Image& right) { std::swap(left.data, right.data); }, 12))});
  rows.add("frozen camera", "lost", {frozenCamera()});
  const std::string half = badLeft([](Image& image) {
    std::fill(image.data.begin() + image.data.size() / 2, image.data.end(), 128);
  });
  rows.add("the lower half of an image is missing, as after a corrupted JPEG",
           "continues",
           {half.substr(half.find("then"))});
  rows.add("images that are not rectified",
           "lost or degraded with a hint",
           {withoutChance(badImages([](Image&, Image& right) { move(right, 0, 7); }, 12))});
}

void observeInfos(Rows& rows) {
  rows.add("camera_info of zeros, or with NaN",
           "no calibration",
           {badInfos([](Info& info) { info.P.fill(0.0); }),
            badInfos([](Info& info) { info.P[2] = kNan; })});
  rows.add("focal length not positive",
           "no calibration",
           {badInfos([](Info& info) { info.P[0] = -info.P[0]; })});
  const auto no_baseline = [](Info&, Info& right) { right.P[3] = 0.0; };
  Parameters with_baseline;
  with_baseline.node.baseline_m = 0.54;
  rows.add("baseline 0",
           "no calibration, the message names baseline_m; accepted with that",
           {badInfos(no_baseline), "with baseline_m " + oddDrive({}, no_baseline, with_baseline)});
  rows.add("baseline negative",
           "no calibration with a hint",
           {badInfos([](Info& left, Info& right) { std::swap(left, right); })});
  rows.add("baseline beyond 10 m or below 5 mm",
           "accepted with one warning; lost, as the images have another baseline",
           {unusualBaseline(1000.0), unusualBaseline(0.001)});
  rows.add("fx, fy or cy of left and right differ",
           "no calibration",
           {badInfos([](Info&, Info& right) { right.P[5] += 4.0; })});
  rows.add("cx of left and right differ",
           "accepted, both are used",
           {oddDrive([](Image&, Image& right) { move(right, 16, 0); },
                     [](Info&, Info& right) { right.P[2] += 16.0; })});
  rows.add("fx differs from fy", "accepted, both are used", {unequalFocalLengths()});
}

void observeTimes(Rows& rows) {
  rows.add("stamp 0", "dropped", {badStamp([](const ros::Time&) { return ros::Time(); })});
  rows.add("stamp repeated",
           "dropped",
           {badStamp([](const ros::Time& t) { return t - ros::Duration(0.1); })});
  rows.add("stamp slightly back, but not the clock",
           "dropped",
           {badStamp([](const ros::Time& t) { return t - ros::Duration(0.15); })});
  rows.add("time jumps back: a bag in a loop",
           "restarts within one pair, pose kept or zero by parameter",
           {"keep: " + timeJump("keep", -500.0), "zero: " + timeJump("zero", -500.0)});
  rows.add("time jumps ahead, or the stamps alone",
           "restarts, pose kept, twist unknown; dropped if the clock does not jump; a single pair "
           "is dropped as a glitch, without a restart",
           {timeJump("keep", 500.0),
            "stamps alone: " + timeJump("keep", 500.0, true),
            "one pair: " + stampGlitch()});
  rows.add("skew of left and right above the limit", "dropped, the skew is reported", {skewed()});
  rows.add("one camera slower", "a warning with both rates", {slowCamera()});
}

void observeRawImages(Rows& rows) {
  rows.add("with rectify: unknown distortion model, D too short, or K or R of zeros",
           "no calibration",
           {badRawInfos([](Info& info) { info.distortion_model = "tilted"; }),
            badRawInfos([](Info& info) { info.D.resize(3); }),
            badRawInfos([](Info& info) { info.K.fill(0.0); }),
            badRawInfos([](Info& info) { info.R.fill(0.0); })});
  rows.add("with rectify: images not of the size in camera_info",
           "no calibration",
           {badRawInfos([](Info& info) { info.height += 10; })});
  rows.add("with rectify: R of another rig",
           "lost or degraded with a hint",
           {withoutChance(turnedCamera())});
}

TEST(BadInputsTest, EachIsHandledAsThePageSays) {
  Rows rows;
  observeMessages(rows);
  observePictures(rows);
  observeInfos(rows);
  observeTimes(rows);
  observeRawImages(rows);
  const std::string path = std::string(ROTROCC_DOCS_DIR) + "/bad_inputs.md";
  const std::string page = readFile(path);
  const std::string rule = "|---|---|---|\n";
  const auto begin = page.find(rule) + rule.size();
  expectFileHolds(path,
                  page.substr(0, begin) + rows.text() + page.substr(page.find("\n\n", begin) + 1));
}

}  // namespace
}  // namespace rotrocc
