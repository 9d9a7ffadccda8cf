#include "check/rig_check.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "bags/recorded_pairs.h"
#include "check/calibration_correction.h"
#include "check/faulty_recording.h"
#include "check/model_check.h"
#include "check/pair_check.h"
#include "check/rig_causes.h"
#include "check/windows.h"
#include "rotrocc/visual_odometry.h"
#include "sequences/calibration_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr double kRadians = M_PI / 180.0;

constexpr int kLong = 100;  // frames; fewer hardly tell a pitch from an offset of rows

/// A quarter of the pixels of KITTI's images.
SimulationOptions perfectRig() {
  SimulationOptions options;
  StereoCamera& camera = options.camera;
  camera.width = 620;
  camera.height = 188;
  camera.fx = camera.fy = 359.0;
  camera.cx = camera.cx_right = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  options.frames = 60;
  return options;
}

struct Fault {
  std::string name;
  std::function<void(SimulationOptions&)> rig = [](SimulationOptions&) {
  };  ///< renders another drive
  FaultyRecording::Faults faults = {};
  std::vector<std::string> subjects = {};  ///< of the findings that name it
  std::vector<double> values = {};         ///< that they have; nan if it is none
  double share = 0.0;                      ///< of a value that may be missing
};

void changeGray(cv::Mat& image, double gain, double offset) {
  image.convertTo(image, CV_8U, gain, offset);
}

/// A hood with scratches in the lowest part of the image.
void addBumper(cv::Mat& left, cv::Mat& right, int parts = 5, int disparity_px = 20) {
  cv::RNG random(7);
  cv::Mat texture(left.rows / parts, left.cols + 2 * disparity_px, CV_8UC1);
  random.fill(texture, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(texture, texture, {}, 1.5);
  const int top = left.rows - texture.rows;
  texture.colRange(0, left.cols).copyTo(left.rowRange(top, left.rows));
  texture.colRange(disparity_px, left.cols + disparity_px).copyTo(right.rowRange(top, right.rows));
}

FaultyRecording::Faults ofImages(std::function<void(cv::Mat&, cv::Mat&)> change) {
  FaultyRecording::Faults faults;
  faults.images = [change](cv::Mat& left, cv::Mat& right, int) { change(left, right); };
  return faults;
}

/// Noise of the camera, which is another one in each image of what stands still.
void addNoise(cv::Mat& image, int seed) {
  cv::Mat noise(image.size(), CV_16SC1);
  cv::RNG random(0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(seed + 1));
  random.fill(noise, cv::RNG::NORMAL, 0.0, 2.0);
  cv::add(image, noise, image, {}, CV_8U);
}

/// Warps the right image: `source` is where a good camera sees what is seen at a place, both in
/// normalized coordinates.
void warpRight(cv::Mat& right,
               const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& source,
               const StereoCamera& camera = perfectRig().camera) {
  cv::Mat places(right.size(), CV_32FC2);
  places.forEach<cv::Point2f>([&](cv::Point2f& place, const int* pixel) {
    const Eigen::Vector2d at =
        source({(pixel[1] - camera.cx_right) / camera.fx, (pixel[0] - camera.cy) / camera.fy});
    place.x = static_cast<float>(camera.fx * at.x() + camera.cx_right);
    place.y = static_cast<float>(camera.fy * at.y() + camera.cy);
  });
  cv::remap(right, right, places, {}, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
}

void turnRight(cv::Mat& right,
               const Eigen::Vector3d& rotation_rad,
               const StereoCamera& camera = perfectRig().camera) {
  RigCauses causes = {};
  for (const std::size_t k : {kRoll, kPitch, kYaw}) causes[k] = rotation_rad[Eigen::Index(k)];
  const Eigen::Matrix3d R = rotationOf(causes);
  const auto source = [&](const Eigen::Vector2d& seen) -> Eigen::Vector2d {
    return (R * seen.homogeneous()).hnormalized();
  };
  warpRight(right, source, camera);
}

/// Radial distortion k1 that the right camera has too much.
void distortRight(cv::Mat& right, double k1) {
  warpRight(right, [&](const Eigen::Vector2d& seen) {
    Eigen::Vector2d straight = seen;
    for (int i = 0; i < 10; ++i) straight = seen / (1.0 + k1 * straight.squaredNorm());
    return straight;
  });
}

std::vector<Fault> faults() {
  std::vector<Fault> all;
  const auto rig = [&](const char* name,
                       std::function<void(CameraFaults&)> change,
                       const char* subject,
                       double value) {
    all.push_back({name,
                   [change](SimulationOptions& options) {
                     change(options.faults);
                     options.frames = kLong;
                   },
                   {},
                   {subject},
                   {value}});
  };
  const auto images = [&](const char* name,
                          std::function<void(cv::Mat&, cv::Mat&)> change,
                          const char* subject,
                          double value) {
    all.push_back(
        {name, [](SimulationOptions&) {}, ofImages(std::move(change)), {subject}, {value}});
  };
  rig(
      "roll",
      [](CameraFaults& f) { f.right_rotation_rad[0] = 0.1 * kRadians; },
      "roll of the right camera",
      0.1);
  rig(
      "late", [](CameraFaults& f) { f.time_skew_s = 0.008; }, "delay of the right images", 8.0);
  rig(
      "pitch",
      [](CameraFaults& f) { f.right_rotation_rad[1] = 0.1 * kRadians; },
      "pitch of the right camera",
      0.1);
  rig(
      "rows",
      [](CameraFaults& f) { f.row_offset_px = 0.7; },
      "row of the right principal point",
      0.7);
  rig(
      "focal",
      [](CameraFaults& f) { f.right_focal_ratio = 1.003; },
      "focal length of the right camera relative to the left",
      0.3);
  all.push_back({"bias", [](SimulationOptions& options) { options.frames = kLong; }});
  all.back().faults.info = [](sensor_msgs::CameraInfo& right) { right.P[2] -= 0.5; };
  all.back().subjects = {"disparity bias"};
  all.back().values = {0.5};
  images(
      "lens",
      [](cv::Mat&, cv::Mat& right) { distortRight(right, 0.1); },
      "residual radial distortion of the right lens",
      0.1);
  all.back().share = 0.1;  // windows at the border are distorted themselves
  images(
      "gain",
      [](cv::Mat&, cv::Mat& right) { changeGray(right, 0.7, 0.0); },
      "gain of the right image relative to the left",
      0.7);
  images(
      "offset",
      [](cv::Mat&, cv::Mat& right) { changeGray(right, 1.0, 20.0); },
      "black level, right minus left",
      20.0);
  images(
      "blur",
      [](cv::Mat&, cv::Mat& right) { cv::GaussianBlur(right, right, {}, 1.0); },
      "sharpness of the right image relative to the left",
      1.0);
  images(
      "bumper", [](cv::Mat& left, cv::Mat& right) { addBumper(left, right); }, kMasked, NAN);
  images(
      "large_bumper",
      [](cv::Mat& left, cv::Mat& right) { addBumper(left, right, 3); },
      kMasked,
      NAN);
  images(
      "rows_apart",
      [](cv::Mat&, cv::Mat& right) {
        const cv::Mat lower = right.clone();
        lower.rowRange(7, right.rows).copyTo(right.rowRange(0, right.rows - 7));
      },
      "left and right images",
      NAN);
  images(
      "swapped",
      [](cv::Mat& left, cv::Mat& right) { std::swap(left, right); },
      "left and right images",
      NAN);
  all.push_back({"raw",
                 [](SimulationOptions& options) { options.lens = "radtan"; },
                 {},
                 {"rectification"},
                 {NAN}});
  const auto frames =
      [&](const char* name, std::function<std::pair<int, int>(int)> shown, const char* subject) {
        Fault fault = {name, [](SimulationOptions&) {}, {}, {subject}, {NAN}};
        fault.faults.frames = std::move(shown);
        all.push_back(fault);
      };
  const auto seventh = [](int index) { return index % 7 == 6 ? index - 1 : index; };
  frames(
      "frame_late", [](int index) { return std::pair(index, index - 1); }, "left and right images");
  frames(
      "pairs_repeated",
      [=](int index) { return std::pair(seventh(index), seventh(index)); },
      "repeated images");
  frames(
      "right_repeated",
      [=](int index) { return std::pair(index, seventh(index)); },
      "repeated images");
  frames(
      "frozen", [](int index) { return std::pair(index, std::min(index, 30)); }, "repeated images");
  const auto exchanged = [](int index) {
    const int step = index % 7;
    return step == 5 ? index + 1 : step == 6 ? index - 1 : index;
  };
  frames(
      "pairs_exchanged",
      [=](int index) { return std::pair(exchanged(index), exchanged(index)); },
      "left and right images");
  frames(
      "right_exchanged",
      [=](int index) { return std::pair(index, exchanged(index)); },
      "left and right images");
  Fault seventh_swapped = {
      "seventh_swapped", [](SimulationOptions&) {}, {}, {"left and right images"}, {NAN}};
  seventh_swapped.faults.images = [](cv::Mat& left, cv::Mat& right, int index) {
    if (index % 7 == 6) std::swap(left, right);
  };
  all.push_back(seventh_swapped);
  images(
      "smudge",
      [](cv::Mat&, cv::Mat& right) {
        cv::Mat part = right(cv::Rect(300, 60, 130, 80));
        cv::GaussianBlur(part, part, {}, 8.0);
      },
      "regions with less than half the detail, right",
      NAN);
  images(
      "compressed",
      [](cv::Mat&, cv::Mat& right) {
        std::vector<uchar> bytes;
        cv::imencode(".jpg", right, bytes, {cv::IMWRITE_JPEG_QUALITY, 10});
        right = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
      },
      "compression, right",
      NAN);
  Fault flicker = {"flicker", [](SimulationOptions&) {}, {}, {"gain over time"}, {NAN}};
  flicker.faults.images = [](cv::Mat&, cv::Mat& right, int index) {
    changeGray(right, 1.0 + 0.25 * std::sin(0.7 * index), 0.0);
  };
  all.push_back(flicker);
  Fault flex = {"flex", [](SimulationOptions&) {}, {}, {kRowsOverTime}, {NAN}};
  flex.faults.images = [](cv::Mat&, cv::Mat& right, int index) {
    turnRight(right, {0.2 * kRadians * std::sin(0.2 * index), 0.0, 0.0});
  };
  all.push_back(flex);
  images(
      "yaw",
      [](cv::Mat&, cv::Mat& right) {
        turnRight(right, {0.0, 0.0, 0.5 * kRadians});
      },
      "yaw of the right camera",
      0.5);
  all.push_back({"bumper_and_roll",
                 [](SimulationOptions&) {},
                 ofImages([](cv::Mat& left, cv::Mat& right) {
                   addBumper(left, right, 8);
                   turnRight(right, {0.3 * kRadians, 0.0, 0.0});
                 }),
                 {kMasked, "roll of the right camera"},
                 {NAN, 0.3}});
  Fault sign = {"sign", [](SimulationOptions&) {}, {}, {"pairs"}, {NAN}};
  sign.faults.info = [](sensor_msgs::CameraInfo& right) { right.P[3] = -right.P[3]; };
  all.push_back(sign);
  all.push_back({"three",
                 [](SimulationOptions& options) {
                   options.faults.right_rotation_rad[0] = 0.1 * kRadians;
                   options.frames = kLong;
                 },
                 ofImages([](cv::Mat&, cv::Mat& right) {
                   changeGray(right, 0.7, 0.0);
                   cv::GaussianBlur(right, right, {}, 1.0);
                 }),
                 {"roll of the right camera",
                  "gain of the right image relative to the left",
                  "sharpness of the right image relative to the left"},
                 {0.1, 0.7, 1.0}});
  return all;
}

CheckedRig check(const Fault& fault) {
  SimulationOptions options = perfectRig();
  fault.rig(options);
  FaultyRecording recording("city", options, fault.faults);
  return checkRig(recording, {});
}

/// The first number of a finding, and its standard deviation.
Estimate estimateOf(const Finding& finding) {
  static const std::regex kEstimate(R"(([-+.\de]+) \+- ([-+.\de]+))");
  std::smatch parts;
  if (!std::regex_search(finding.measured, parts, kEstimate)) return {NAN, NAN};
  return {std::stod(parts[1]), std::stod(parts[2])};
}

class RigFaultTest : public testing::TestWithParam<Fault> {};

/// The fault is the first of all findings, and its value within three standard deviations, which
/// are those of a report: one of 400 values is outside.
TEST_P(RigFaultTest, IsNamedFirst) {
  const Fault& fault = GetParam();
  const CheckedRig rig = check(fault);
  const std::vector<Finding>& findings = rig.report.findings;
  SCOPED_TRACE(toText(rig.report));
  ASSERT_GE(findings.size(), fault.subjects.size());
  for (std::size_t i = 0; i < fault.subjects.size(); ++i) {
    const auto named = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
      return finding.subject == fault.subjects[i];
    });
    ASSERT_NE(named, findings.end()) << fault.subjects[i];
    EXPECT_LT(named - findings.begin(), static_cast<std::ptrdiff_t>(fault.subjects.size()));
    EXPECT_TRUE(named->verdict == Verdict::kFix || named->verdict == Verdict::kAcceptable);
    EXPECT_NE(named->remedy, "");
    if (std::isnan(fault.values[i])) continue;
    const Estimate estimate = estimateOf(*named);
    EXPECT_LE(std::abs(estimate.value - fault.values[i]),
              3.0 * estimate.sigma + fault.share * std::abs(fault.values[i]))
        << named->measured;
    EXPECT_LT(estimate.sigma, 0.1 * std::abs(fault.values[i])) << "it is hardly known";
  }
  for (std::size_t i = fault.subjects.size(); i < findings.size(); ++i) {
    if (findings[i].section == "odometry") continue;  // a symptom
    EXPECT_NE(findings[i].verdict, Verdict::kFix) << findings[i].subject;
  }
  // For the table of the documentation.
  if (!findings.empty()) std::cout << fault.name << ": " << findings[0].measured << '\n';
}

INSTANTIATE_TEST_SUITE_P(Rendered, RigFaultTest, testing::ValuesIn(faults()), [](const auto& info) {
  return info.param.name;
});

/// A street at more pixels than the rendered ones.
class RealRigTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* kitti = std::getenv("ROTROCC_KITTI_DIR");
    if (kitti == nullptr) GTEST_SKIP() << "set ROTROCC_KITTI_DIR to run this";
    directory_ = std::filesystem::path(kitti) / "raw_0926_024_143";
    if (!std::filesystem::exists(directory_)) GTEST_SKIP() << directory_ << " is missing";
  }

  CheckedRig check(FaultyRecording::Faults faults) const {
    FaultyRecording recording(KittiSequence(directory_.string()), std::move(faults));
    return checkRig(recording, {});
  }

  std::filesystem::path directory_;
};

/// Rows that are far apart make all pairs doubtful and lose none. What is fitted to the wrong
/// matches looks like a lens.
TEST_F(RealRigTest, DoubtsAboutAllPairsAreOfTheRows) {
  const StereoCamera camera = KittiSequence(directory_.string()).camera;
  const CheckedRig rig = check(ofImages([&](cv::Mat&, cv::Mat& right) {
    turnRight(right, {0.0, 0.5 * kRadians, 0.0}, camera);
  }));
  const Finding& first = rig.report.findings.at(0);
  EXPECT_EQ(first.subject, "left and right images") << first.measured;
  EXPECT_NE(first.measured.find("rows"), std::string::npos) << first.measured;
}

/// What stands still agrees with much by chance.
TEST_F(RealRigTest, ABumperIsNoOtherFault) {
  FaultyRecording::Faults faults;
  faults.images = [](cv::Mat& left, cv::Mat& right, int index) {
    addBumper(left, right, 3, 60);
    addNoise(left, 2 * index);
    addNoise(right, 2 * index + 1);
  };
  EXPECT_EQ(check(faults).report.findings.at(0).subject, kMasked);
}

/// The calibration is that of the whole images. Straight ahead, it would turn the motion only.
TEST(RigCheckTest, ACropOfBothImagesShowsInTurns) {
  constexpr int kCrop_px = 30;
  SimulationOptions options = perfectRig();
  options.frames = kLong;
  FaultyRecording recording(
      "handheld", options, ofImages([](cv::Mat& left, cv::Mat& right) {
        for (cv::Mat* image : {&left, &right}) {
          const cv::Mat whole = image->clone();
          whole.colRange(kCrop_px, whole.cols).copyTo(image->colRange(0, whole.cols - kCrop_px));
        }
      }));
  const Finding first = checkRig(recording, {}).report.findings.at(0);
  EXPECT_EQ(first.subject, "principal points") << first.measured;
  EXPECT_EQ(first.verdict, Verdict::kFix);
  // A fit that is linear leaves a part of so large an error to the next one.
  EXPECT_NEAR(estimateOf(first).value, -kCrop_px, 0.1 * kCrop_px) << first.measured;
  std::cout << "cropped: " << first.measured << '\n';
}

/// A good rig that stands still in flickering light, for a while or for ever: a wrong match at rest
/// agrees with the motion for as long as it lasts.
TEST(RigCheckTest, ARigAtRestIsNotCondemned) {
  for (const int resting : {10, 40, 1000}) {
    Fault rest = {"rest"};
    rest.faults.frames = [=](int index) {
      const int frame = std::max(index - resting, 0);
      return std::pair(frame, frame);
    };
    rest.faults.images = [=](cv::Mat& left, cv::Mat& right, int index) {
      if (index > resting) return;
      const double flicker = index % 2 == 0 ? 1.0 : 0.9;
      for (cv::Mat* image : {&left, &right}) image->convertTo(*image, CV_8U, flicker);
      addNoise(left, 2 * index);
      addNoise(right, 2 * index + 1);
    };
    const CheckedRig rig = check(rest);
    EXPECT_FALSE(rig.report.needsFix()) << toText(rig.report);
    EXPECT_TRUE(rig.report.mask.empty());
  }
}

TEST(RigCheckTest, APerfectRigIsGood) {
  const CheckedRig rig = check({"perfect"});
  std::set<std::string> sections;
  for (const Finding& finding : rig.report.findings) {
    // A rendered recording has one stamp for both images.
    const Verdict expected =
        finding.subject == "left minus right timestamps" ? Verdict::kUnknown : Verdict::kGood;
    EXPECT_EQ(finding.verdict, expected) << finding.subject << ": " << finding.measured;
    EXPECT_EQ(finding.remedy, "");
    sections.insert(finding.section);
  }
  EXPECT_EQ(sections,
            (std::set<std::string>{
                "inputs", "photometry", "rows", "disparities", "time", "view", "odometry"}));
  EXPECT_TRUE(rig.report.mask.empty());
}

/// The proposed mask covers the bumper, and little else.
TEST(RigCheckTest, ProposesAMaskOfTheBumper) {
  const CheckedRig rig =
      check({"bumper", [](SimulationOptions&) {}, ofImages([](cv::Mat& left, cv::Mat& right) {
               addBumper(left, right);
             })});
  const cv::Mat& mask = rig.report.mask;
  ASSERT_FALSE(mask.empty());
  const cv::Mat bumper = mask.rowRange(mask.rows * 4 / 5 + 1, mask.rows);
  EXPECT_GT(cv::countNonZero(bumper), 0.9 * static_cast<double>(bumper.total()));
  EXPECT_LT(cv::countNonZero(mask) - cv::countNonZero(bumper),
            0.1 * static_cast<double>(mask.total()));
}

/// Error of the motions of a recording, by a calibration.
double errorOf(FaultyRecording& recording, const StereoCalibration& calibration) {
  RecordedPairs pairs(recording, {}, "yes", std::make_shared<const StereoCalibration>(calibration));
  VisualOdometry odometry({});
  StereoPair pair;
  StereoCamera camera;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  while (pairs.next(pair, camera)) pose = pose * odometry.process(pair, camera).T_prev_cur;
  return (pose.inverse() * recording.pose(recording.size() - 1)).translation().norm();
}

/// With the corrected files the odometry is as good as with the calibration of a perfect rig, but
/// for a tenth of what needs fixing.
TEST(RigCheckTest, CorrectsTheCalibration) {
  SimulationOptions options = perfectRig();
  options.frames = kLong;
  FaultyRecording perfect("city", options, {});
  options.faults.right_rotation_rad = Eigen::Vector3d(0.15, 0.1, 0.1) * kRadians;
  options.faults.right_focal_ratio = 1.003;
  FaultyRecording recording("city", options, {});
  const CheckedRig before = checkRig(recording, {});
  std::string why_not;
  const auto correction = findCorrection(recording, {}, before.measures, why_not);
  ASSERT_TRUE(correction) << why_not;
  EXPECT_GT(before.measures.rest.rows_px, 0.5);
  const double tolerance_px = 0.05;
  EXPECT_LT(correction->measures.rest.rows_px, tolerance_px);
  // The yaw is seen by rows once the larger faults are corrected: those in the corners of the image
  // tell as much of it as they are correct. A pitch may be an offset of rows.
  const Eigen::AngleAxisd left(options.faults.rightCamera(options.camera).linear().transpose() *
                               correction->measures.calibration.right.R_rectified_raw);
  const Eigen::Vector3d left_rad = left.angle() * left.axis();
  const StereoCamera& camera = options.camera;
  EXPECT_LT(std::abs(left_rad.y()) * camera.cx * camera.cy / camera.fx, tolerance_px);
  EXPECT_LT(std::abs(left_rad.z()), 0.1 * 0.15 * kRadians);
  for (const Finding& finding : correction->report.findings) {
    EXPECT_NE(finding.verdict, Verdict::kFix) << finding.subject << ": " << finding.measured;
  }
  const StereoCalibration nominal = rectifiedCalibration(camera);
  const double error_perfect_m = errorOf(perfect, nominal);
  const double error_before_m = errorOf(recording, nominal);
  const TemporaryDirectory directory;
  writeCalibration(correction->measures.calibration, directory / "info");
  const StereoCalibration written =
      readStereoCalibration({directory / "info/left.yaml", directory / "info/right.yaml"});
  const double error_after_m = errorOf(recording, written);
  std::cout << "error at the end of 53 m: " << error_perfect_m << " m perfect, " << error_before_m
            << " m with the fault, " << error_after_m << " m corrected\n";
  const double tolerance_m = 0.1 * kFixScale * 53.0;  // of the way
  EXPECT_LT(error_after_m - error_perfect_m, tolerance_m);
  EXPECT_GT(error_before_m - error_perfect_m, 3.0 * tolerance_m);
}

/// Moves rows of the right image as a yaw of half a degree does, but leaves the disparities.
void bendRows(cv::Mat&, cv::Mat& right) {
  const StereoCamera camera = perfectRig().camera;
  cv::Mat places(right.size(), CV_32FC2);
  places.forEach<cv::Point2f>([&](cv::Point2f& place, const int* pixel) {
    const double x = (pixel[1] - camera.cx_right) / camera.fx;
    const double y = (pixel[0] - camera.cy) / camera.fy;
    place.x = static_cast<float>(pixel[1]);
    place.y = static_cast<float>(pixel[0] + camera.fy * 0.5 * kRadians * x * y);
  });
  cv::remap(right, right, places, {}, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
}

/// As KITTI's rectified images are: a calibration with that yaw would have wrong depths.
TEST(RigCheckTest, RowsOfALensAreNoYaw) {
  const CheckedRig rig = check({"bent", [](SimulationOptions&) {}, ofImages(bendRows)});
  const std::vector<Finding>& findings = rig.report.findings;
  const auto yaw = std::find_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.subject == "errors that look like a yaw, in the rows alone";
  });
  ASSERT_NE(yaw, findings.end());
  const Estimate rows_deg = estimateOf(*yaw);
  EXPECT_GT(std::abs(rows_deg.value), 10.0 * rows_deg.sigma) << yaw->measured;
  EXPECT_EQ(rig.measures.model.correctable[kYaw], 0.0);
}

TEST(RigCheckTest, AFewPairsSayNothing) {
  SimulationOptions options = perfectRig();
  FaultyRecording::Faults faults;
  faults.info = [](sensor_msgs::CameraInfo& right) { right.P[2] -= 2.0; };
  for (const int frames : {1, 2, 10}) {
    options.frames = frames;
    FaultyRecording recording("city", options, faults);
    const CheckedRig rig = checkRig(recording, {});
    const std::string text = toText(rig.report);
    SCOPED_TRACE(text);
    EXPECT_NE(text.find("features moved in "), std::string::npos);
    EXPECT_NE(text.find("\n0 to fix, 0 acceptable, "), std::string::npos);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    std::string why_not;
    EXPECT_FALSE(findCorrection(recording, {}, rig.measures, why_not));
    EXPECT_NE(why_not.find("fewer than 10"), std::string::npos) << why_not;
  }
}

/// The model is of one camera.
TEST(RigCheckTest, LeavesOutPairsOfAnotherCalibration) {
  constexpr int kOthers = 30;
  SimulationOptions options = perfectRig();
  bool is_other = false;
  FaultyRecording::Faults faults;
  faults.images = [&](cv::Mat&, cv::Mat&, int index) {  // before the camera_info of the next pair
    is_other = index + 1 >= options.frames - kOthers && index + 1 < options.frames;
  };
  faults.info = [&](sensor_msgs::CameraInfo& right) { right.P[3] *= is_other ? 1.3 : 1.0; };
  FaultyRecording recording("city", options, faults);
  const CheckedRig rig = checkRig(recording, {});
  const std::string text = toText(rig.report);
  SCOPED_TRACE(text);
  EXPECT_NE(text.find(std::to_string(kOthers) + " of " + std::to_string(options.frames) +
                      " pairs have a different calibration"),
            std::string::npos);
  EXPECT_NE(text.find("\n0 to fix, "), std::string::npos);
  EXPECT_NEAR(rig.measures.calibration.rectified.baseline_m, options.camera.baseline_m, 1e-9);
}

TEST(RigCheckTest, CorrectsNeitherAPerfectRigNorOneThatMoves) {
  FaultyRecording recording("city", perfectRig(), {});
  RigMeasures measures = check({"perfect"}).measures;
  std::string why_not;
  EXPECT_FALSE(findCorrection(recording, {}, measures, why_not));
  EXPECT_NE(why_not.find("no error that needs fixing"), std::string::npos) << why_not;
  measures.rest.is_constant = false;
  EXPECT_FALSE(findCorrection(recording, {}, measures, why_not));
  EXPECT_NE(why_not.find("bends"), std::string::npos) << why_not;
}

}  // namespace
}  // namespace rotrocc
