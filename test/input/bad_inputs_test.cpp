// Each kind of bad input with the expected and the observed behaviour: docs/bad_inputs.md has the
// table. Rows that need a ROS master are those of the tests in test/node.

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

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

OdometryRig::ImageChange onlyLeft(const OneImageChange& change) {
  return [change](Image& left, Image&) { change(left); };
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
  return badImages(onlyLeft(change));
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

/// What a grey level is in colour: red as bright as the level, green half as bright, no blue.
unsigned char channelOf(char channel, unsigned char level) {
  switch (channel) {
    case 'r':
      return level;
    case 'g':
      return level / 2;
    case 'b':
      return 0;
    default:
      return 255;
  }
}

/// That colour as grey, by ITU-R BT.601.
void toLuma(Image& image) {
  for (unsigned char& byte : image.data) {
    byte = cv::saturate_cast<uchar>(0.299 * channelOf('r', byte) + 0.587 * channelOf('g', byte));
  }
}

/// mono8 to "bgra8" and the like, whose names are their channels.
void toColour(const std::string& encoding, Image& image) {
  const std::string channels = encoding.substr(0, encoding.size() - 1);
  std::vector<unsigned char> data;
  for (const unsigned char level : image.data) {
    for (const char channel : channels) data.push_back(channelOf(channel, level));
  }
  image.data = data;
  image.step *= static_cast<std::uint32_t>(channels.size());
  image.encoding = encoding;
}

/// mono8 to "bayer_rggb8" and the like, whose names are the colours of two rows of two pixels.
void toBayer(const std::string& encoding, Image& image) {
  const std::string pattern = encoding.substr(encoding.find('_') + 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const std::size_t x = i % image.step, y = i / image.step;
    image.data[i] = channelOf(pattern[2 * (y % 2) + x % 2], image.data[i]);
  }
  image.encoding = encoding;
}

void encode(const std::string& encoding, Image& image) {
  if (encoding == "mono8") return toLuma(image);
  if (encoding.find("bayer") == 0) return toBayer(encoding, image);
  toColour(encoding, image);
}

/// A drive with colour images. `tolerance` [grey levels, mean] allows for the blur of demosaicing;
/// swapped red and blue would differ by 23.
std::string inColour(const std::string& left_encoding,
                     const std::string& right_encoding,
                     double tolerance) {
  OdometryRig rig;
  rig.sendInfos();
  Image left_luma, right_luma;
  for (int i = 0; i < 3; ++i) {
    rig.drive([&](Image& left, Image& right) {
      left_luma = left;
      right_luma = right;
      toLuma(left_luma);
      toLuma(right_luma);
      encode(left_encoding, left);
      encode(right_encoding, right);
    });
  }
  const std::string observed = left_encoding + " and " + right_encoding + ": " + rig.observed();
  if (!rig.answer()) return observed;
  const StereoPair& pair = rig.answer()->pair;
  for (const auto& [grey, luma] :
       {std::pair(pair.left, pixelsOf(left_luma)), std::pair(pair.right, pixelsOf(right_luma))}) {
    const double difference = cv::norm(grey, luma, cv::NORM_L1) / static_cast<double>(luma.total());
    if (difference > tolerance)
      return observed + ", but the grey levels differ by " + toText(difference);
  }
  return observed;
}

void fill(Image& image, int level) {
  image.data.assign(image.data.size(), static_cast<unsigned char>(level));
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

/// Counts the bytes that matrices of OpenCV allocate during its lifetime.
class MatrixMemory : public cv::MatAllocator {
 public:
  MatrixMemory() { cv::Mat::setDefaultAllocator(this); }
  ~MatrixMemory() override { cv::Mat::setDefaultAllocator(cv::Mat::getStdAllocator()); }
  MatrixMemory(const MatrixMemory&) = delete;
  MatrixMemory& operator=(const MatrixMemory&) = delete;

  std::size_t bytes() const { return bytes_; }

  cv::UMatData* allocate(int dims,
                         const int* sizes,
                         int type,
                         void* data,
                         std::size_t* step,
                         cv::AccessFlag flags,
                         cv::UMatUsageFlags usage) const override {
    cv::UMatData* memory =
        cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, flags, usage);
    bytes_ += memory->size;
    return memory;
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override {
    cv::Mat::getStdAllocator()->deallocate(data);
  }

 private:
  mutable std::atomic<std::size_t> bytes_{0};
};

/// A pair of images for which no memory must be allocated.
std::string costlyImages(const OdometryRig::ImageChange& change) {
  const auto rig = drivingRig();
  Image left = rig->nextImage(Side::kLeft);
  Image right = rig->nextImage(Side::kRight);
  change(left, right);
  std::string observed;
  {
    const MatrixMemory memory;
    rig->sendImage(Side::kLeft, left);
    rig->sendImage(Side::kRight, right);
    observed = rig->observed() + "; " + toText(memory.bytes()) + " bytes allocated";
  }
  rig->advance();
  return observed + recovery(*rig);
}

/// Colour images whose header has another size than their data.
std::string headerOfSize(std::uint32_t width, std::uint32_t height, std::uint32_t step) {
  return costlyImages(both([&](Image& image) {
    image.encoding = "bgr8";
    image.width = width;
    image.height = height;
    image.step = step;
  }));
}

std::string plainImagesOfSize(int side) {
  return costlyImages(
      both([&](Image& image) { setPixels(cv::Mat(side, side, CV_8UC1, cv::Scalar(99)), image); }));
}

/// A left image from a changed JPEG, decoded by cv::imdecode() as in compressed_image_transport:
/// nothing is sent if that fails. What is missing of an image looks as the decoder likes, so the
/// pair may be found or lost.
std::string badJpeg(const std::function<void(std::vector<unsigned char>&)>& change) {
  const auto rig = drivingRig();
  Image left = rig->nextImage(Side::kLeft);
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", pixelsOf(left), jpeg);
  change(jpeg);
  const cv::Mat decoded = cv::imdecode(jpeg, cv::IMREAD_UNCHANGED);
  if (!decoded.empty()) {
    setPixels(decoded, left);
    rig->sendImage(Side::kLeft, left);
  }
  rig->sendImage(Side::kRight, rig->nextImage(Side::kRight));
  rig->advance();
  const std::string observed =
      std::regex_replace(rig->observed(),
                         std::regex("^(ok|lost, pose held, covariance grows, twist unknown)$"),
                         "ok or lost");
  return (decoded.empty() ? "no image: " : "an image: ") + observed + recovery(*rig);
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

std::vector<BadInput> messageRows() {
  return {
      {1,
       "width or height 0",
       "dropped",
       [] {
         return badLeft([](Image& image) { image.width = 0; }) + "; " +
                badLeft([](Image& image) { image.height = 0; });
       },
       "dropped (image_size): the left image is 0x188 px, *; then ok; "
       "dropped (image_size): the left image is 620x0 px, *; then ok"},
      {2,
       "no data",
       "dropped",
       [] { return badLeft([](Image& image) { image.data.clear(); }); },
       "dropped (image_data): the left image has 0 bytes of data, *; then ok"},
      {3,
       "less data than step x height",
       "dropped",
       [] { return badLeft([](Image& image) { image.data.pop_back(); }); },
       "dropped (image_data): the left image has 116559 bytes of data, *; then ok"},
      {4,
       "more data than step x height",
       "accepted, the rest is ignored",
       [] {
         return comparedDrive(
             both([](Image& image) { image.data.resize(image.data.size() + 99); }));
       },
       "ok, bit-identical result"},
      {5,
       "step shorter than a row",
       "dropped",
       [] { return badLeft([](Image& image) { image.step -= 1; }); },
       "dropped (image_step): the left image has a step of 619 bytes, *; then ok"},
      {6,
       "step longer than a row",
       "accepted, the row padding is ignored",
       [] {
         return comparedDrive([](Image& left, Image& right) {
           padRows(left, 13);
           padRows(right, 64);
         });
       },
       "ok, bit-identical result"},
      {7,
       "sizes whose product overflows 32 or 64 bits",
       "dropped before any allocation",
       [] {
         return headerOfSize(0xffffffff, 0xffffffff, 0xffffffff) + "; " +
                headerOfSize(65536, 65536, 3 * 65536) + "; " + headerOfSize(16, 65536, 65536);
       },
       "dropped (image_size): the left image is 4294967295x4294967295 px, *; 0 bytes allocated; "
       "then ok; "
       "dropped (image_size): the left image is 65536x65536 px, *; 0 bytes allocated; then ok; "
       "dropped (image_data): * 65536 rows of 65536 bytes take 4294967296: *; 0 bytes allocated; "
       "then ok"},
      {8,
       "unknown or empty encoding",
       "dropped, the supported ones are listed",
       [] {
         return badLeft([](Image& image) { image.encoding = ""; }) + "; " +
                badLeft([](Image& image) { image.encoding = "nv21"; });
       },
       "dropped (image_encoding): the left image has the encoding \"\", but must be one of: "
       "mono8 * bayer_grbg16; then ok; "
       "dropped (image_encoding): the left image has the encoding \"nv21\", but must be one "
       "of: mono8 * bayer_grbg16; then ok"},
      {9,
       "bgr8 with the step of mono8",
       "dropped",
       [] { return badLeft([](Image& image) { image.encoding = "bgr8"; }); },
       "dropped (image_step): * 620 px of bgr8 take 1860: *; then ok"},
      {10,
       "rgb8, bgr8, rgba8, bgra8",
       "accepted, correct grey levels",
       [] { return inColour("rgb8", "bgra8", 1.0) + "; " + inColour("bgr8", "rgba8", 1.0); },
       "rgb8 and bgra8: ok; bgr8 and rgba8: ok"},
      {11,
       "mono16 of 12 bits, both byte orders",
       "accepted, scaled: the same result as for mono8",
       [] {
         return "little-endian " +
                comparedDrive(both([](Image& image) { to16Bits(image, false); })) +
                "; big-endian " + comparedDrive(both([](Image& image) { to16Bits(image, true); }));
       },
       "little-endian ok, bit-identical result; big-endian ok, bit-identical result"},
      {12,
       "Bayer patterns",
       "accepted, correct grey levels",
       [] {
         return inColour("bayer_rggb8", "bayer_bggr8", 5.0) + "; " +
                inColour("bayer_gbrg8", "bayer_grbg8", 5.0);
       },
       "bayer_rggb8 and bayer_bggr8: ok; bayer_gbrg8 and bayer_grbg8: ok"},
      {13,
       "32FC1, a depth image",
       "dropped with a hint",
       [] { return badLeft(toDepth); },
       "dropped (image_encoding): the left image has the encoding \"32FC1\", * (is its topic "
       "remapped to a depth image?); then ok"},
      {14,
       "left and right of different sizes",
       "dropped, both sizes are reported",
       [] { return badLeft([](Image& image) { cropTo(image, 620, 178); }); },
       "dropped (image_sizes_differ): the left image is 620x178 px, the right one 620x188 px: *; "
       "then ok"},
      {15,
       "left and right of different encodings",
       "accepted",
       [] { return inColour("bgr8", "mono8", 1.0); },
       "bgr8 and mono8: ok"},
      {16,
       "images not of the size in camera_info",
       "no calibration",
       [] {
         const auto rig = drivingRig();
         rig->drive(both([](Image& image) { cropTo(image, 620, 178); }));
         const std::string observed = rig->stateWithoutAnswers() + ", " + rig->observed();
         return observed + recovery(*rig);
       },
       "NO_CALIBRATION, dropped (image_not_of_camera_info): the images are 620x178 px, but "
       "camera_info is for 620x188 px: *; then ok"},
      {17,
       "new resolution with its camera_info",
       "restarts with one pair, pose kept",
       newResolution,
       "initialising, pose held, covariance grows, twist unknown; then ok"},
  };
}

std::vector<BadInput> pictureRows() {
  return {
      {18,
       "black, white or grey images",
       "lost, pose held, covariance grows",
       [] {
         std::string observed;
         for (const int level : {0, 255, 128}) {
           observed += (observed.empty() ? "" : "; ") +
                       badImages(both([&](Image& image) { fill(image, level); }), 12);
         }
         return observed;
       },
       "lost, pose held, covariance grows, twist unknown, hint: the left image has hardly any "
       "corners, its mean grey level is 0 of 255: *; then ok; "
       "lost, pose held, covariance grows, twist unknown, hint: the left image has hardly any "
       "corners, its mean grey level is 255 of 255: *; then ok; "
       "lost, pose held, covariance grows, twist unknown, hint: the left image has hardly any "
       "corners, its mean grey level is 128 of 255: *; then ok"},
      {19,
       "noise",
       "lost, no jump",
       [] {
         int seed = 0;
         return badImages(both([&](Image& image) { fillWithNoise(image, ++seed); }), 3);
       },
       "lost, pose held, covariance grows, twist unknown; then ok"},
      {20,
       "left and right identical",
       "lost, no depth",
       [] { return badImages([](Image& left, Image& right) { right.data = left.data; }, 12); },
       "lost, pose held, covariance grows, twist unknown, hint: left and right image are "
       "identical: *; then ok"},
      {21,
       "left and right swapped",
       "lost or degraded with a hint",
       [] {
         return withoutChance(
             badImages([](Image& left, Image& right) { std::swap(left.data, right.data); }, 12));
       },
       "lost or degraded, hint: the images match if left and right are swapped: swap their topics; "
       "then ok"},
      {22,
       "frozen camera",
       "no motion, with a hint",
       frozenCamera,
       "ok, moved 0 m of 0.4 m, hint: each image has been unchanged for 11 pairs: is the camera "
       "frozen?; then ok"},
      {23,
       "corrupted JPEG: bad header, or second half missing",
       "continues",
       [] {
         return badJpeg([](std::vector<unsigned char>& jpeg) { jpeg[0] = jpeg[1] = 0; }) + "; " +
                badJpeg([](std::vector<unsigned char>& jpeg) { jpeg.resize(jpeg.size() / 2); });
       },
       "no image: no odometry; then ok; an image: ok or lost; then ok"},
      {24,
       "very small or very large images",
       "dropped, memory bounded",
       [] { return plainImagesOfSize(8) + "; " + plainImagesOfSize(8192); },
       "dropped (image_size): the left image is 8x8 px, *; 0 bytes allocated; then ok; "
       "dropped (image_size): the left image is 8192x8192 px, more than max_image_pixels = *; 0 "
       "bytes allocated; then ok"},
      {25,
       "images that are not rectified",
       "lost or degraded with a hint",
       [] { return withoutChance(badImages([](Image&, Image& right) { move(right, 0, 7); }, 12)); },
       "lost or degraded, hint: the images match if the right one is shifted by about -7 rows: "
       "they are not rectified; *; then ok"},
  };
}

std::vector<BadInput> badInfoRows() {
  const std::string refused = "NO_CALIBRATION, dropped (camera_info_invalid): ";
  return {
      {27,
       "camera_info of zeros",
       "no calibration",
       [] {
         return badInfos([](Info& info) {
           info.K.fill(0.0);
           info.R.fill(0.0);
           info.P.fill(0.0);
         });
       },
       refused +
           "P of the left camera_info is all zeros: the camera is not calibrated; *; then ok"},
      {28,
       "P with NaN or infinity",
       "no calibration",
       [] {
         return badInfos([](Info& info) { info.P[2] = kNan; }) + "; " +
                badInfos([](Info& left, Info&) { left.P[0] = kInfinity; }) + "; " +
                badInfos([](Info&, Info& right) { right.P[3] = -kInfinity; });
       },
       refused + "P[2] of the left camera_info is nan: *; then ok; " + refused +
           "P[0] of the left camera_info is inf: *; then ok; " + refused +
           "P[3] of the right camera_info is -inf: *; then ok"},
      {29,
       "focal length not positive",
       "no calibration",
       [] {
         return badInfos([](Info& info) { info.P[0] = -info.P[0]; }) + "; " +
                badInfos([](Info& info) { info.P[5] = 0.0; });
       },
       refused +
           "P of the left camera_info has focal lengths P[0] = -360 and P[5] = 360 px, but "
           "both must be positive: *; then ok; " +
           refused +
           "P of the left camera_info has focal lengths P[0] = 360 and P[5] = 0 px, but "
           "both must be positive: *; then ok"},
      {30,
       "baseline 0",
       "no calibration, the message names baseline_m; accepted with that",
       [] {
         const auto no_baseline = [](Info&, Info& right) { right.P[3] = 0.0; };
         Parameters parameters;
         parameters.node.baseline_m = 0.54;
         return badInfos(no_baseline) + "; with baseline_m " +
                oddDrive({}, no_baseline, parameters);
       },
       refused +
           "the baseline is zero: *, or set the parameter baseline_m; then ok; with baseline_m "
           "ok"},
      {31,
       "baseline negative",
       "no calibration with a hint",
       [] { return badInfos([](Info& left, Info& right) { std::swap(left, right); }); },
       refused + "the baseline is negative: *; are left and right swapped?; then ok"},
      {32,
       "baseline beyond 10 m or below 5 mm",
       "accepted with one warning; lost, as the images have another baseline",
       [] { return unusualBaseline(1000.0) + "; " + unusualBaseline(0.001); },
       "lost, pose held, covariance grows, twist unknown; warnings: 1, a baseline of 540 m is "
       "unusual: *; lost, pose held, covariance grows, twist unknown; warnings: 1, a baseline of "
       "0.00054 m is unusual: *"},
      {33,
       "fx, fy or cy of left and right differ",
       "no calibration",
       [] {
         return badInfos([](Info&, Info& right) { right.P[0] += 5.0; }) + "; " +
                badInfos([](Info&, Info& right) { right.P[5] += 4.0; }) + "; " +
                badInfos([](Info&, Info& right) { right.P[6] += 3.0; });
       },
       refused +
           "the cameras are not rectified as a pair: fx is 360 px in the left camera_info and "
           "365 px in the right one; *; then ok; " +
           refused +
           "the cameras are not rectified as a pair: fy is 360 px in the left camera_info "
           "and 364 px in the right one; *; then ok; " +
           refused +
           "the cameras are not rectified as a pair: cy is 92 px in the left camera_info "
           "and 95 px in the right one; *; then ok"},
  };
}

std::vector<BadInput> oddInfoRows() {
  return {
      {34,
       "cx of left and right differ",
       "accepted, both are used",
       [] {
         return oddDrive([](Image&, Image& right) { move(right, 16, 0); },
                         [](Info&, Info& right) { right.P[2] += 16.0; });
       },
       "ok"},
      {35,
       "fx differs from fy",
       "accepted, both are used",
       unequalFocalLengths,
       "ok, ahead and up"},
      {36,
       "K differs from P, D is not zero",
       "accepted, P is used",
       [] {
         return comparedDrive({}, both([](Info& info) {
                                info.K = {984.2, 0.0, 690.0, 0.0, 980.8, 233.2, 0.0, 0.0, 1.0};
                                info.D = {-0.37, 0.2, 0.001, 0.002, -0.07};
                              }));
       },
       "ok, bit-identical result"},
      {37,
       "only P is filled",
       "accepted",
       [] {
         return comparedDrive({}, both([](Info& info) {
                                info.K.fill(0.0);
                                info.R.fill(0.0);
                                info.D.clear();
                                info.distortion_model.clear();
                              }));
       },
       "ok, bit-identical result"},
      {38,
       "binning, region of interest, or both",
       "accepted, P is scaled and moved",
       [] {
         return "binning " + comparedDrive({}, both(bin)) + "; roi " +
                comparedDrive({}, both(crop)) + "; both " + comparedDrive({}, both([](Info& info) {
                                                                            bin(info);
                                                                            crop(info);
                                                                          }));
       },
       "binning ok, bit-identical result; roi ok, bit-identical result; both ok, bit-identical "
       "result"},
      {39,
       "camera_info changes during the run",
       "restarts with one pair, pose kept",
       newFocalLength,
       "initialising, pose held, covariance grows, twist unknown; then ok"},
  };
}

std::vector<BadInput> timeRows() {
  const std::string restarted = "initialising, pose held, covariance grows, twist unknown; then ok";
  return {
      {42,
       "stamp 0",
       "dropped",
       [] { return badStamp([](const ros::Time&) { return ros::Time(); }); },
       "dropped (stamp_zero): the right image has the stamp 0: *; then ok"},
      {43,
       "stamp repeated",
       "dropped",
       [] { return badStamp([](const ros::Time& t) { return t - ros::Duration(0.1); }); },
       "dropped (stamp_repeated): the right image has the same stamp as the previous one, 1000.200 "
       "s: *; then ok"},
      {44,
       "stamp slightly back, but not the clock",
       "dropped",
       [] { return badStamp([](const ros::Time& t) { return t - ros::Duration(0.15); }); },
       "dropped (stamp_backward): the right image has the stamp 1000.150 s, 0.05 s before the "
       "previous one: *; then ok"},
      {45,
       "time jumps back: a bag in a loop",
       "restarts within one pair, pose kept or zero by parameter",
       [] { return "keep: " + timeJump("keep", -500.0) + "; zero: " + timeJump("zero", -500.0); },
       "keep: initialising, pose held, twist unknown; then ok; zero: initialising, pose zero, "
       "twist unknown; then ok"},
      {46,
       "time jumps ahead, or the stamps alone",
       "restarts, pose kept, twist unknown; dropped if the clock does not jump; a single pair is "
       "dropped as a glitch, without a restart",
       [] {
         return timeJump("keep", 500.0) + "; stamps alone: " + timeJump("keep", 500.0, true) +
                "; one pair: " + stampGlitch();
       },
       restarted +
           "; stamps alone: dropped (stamp_future): the right image has the stamp 1500.300 s, 500 "
           "s ahead of the clock: *; then ok; one pair: no odometry; with the next pair ok, "
           "dropped (stamp_glitch): the right image had the stamp *, but the next one did not "
           "follow it: a glitch; *; then ok"},
      {47,
       "skew of left and right above the limit",
       "dropped, the skew is reported",
       skewed,
       "dropped (no_partner); left and right stamps are up to 30 ms apart, more than 10 "
       "ms and 30 % of the period of 100 ms: trigger the cameras synchronously; *; then ok"},
      {48,
       "one camera slower",
       "a warning with both rates",
       slowCamera,
       "20 left and 10 right images: 10 pairs processed, the last ok; diagnostics: 50 % of the "
       "images have no partner: left/image_rect arrives at 10.0 Hz, right/image_rect at 5.0 Hz: "
       "the "
       "camera of right/image_rect or its connection loses images"},
  };
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

std::vector<BadInput> rawRows() {
  const std::string refused = "NO_CALIBRATION, dropped (camera_info_invalid): ";
  return {
      {53,
       "with rectify: unknown distortion model",
       "no calibration, the supported ones are listed",
       [] { return badRawInfos([](Info& info) { info.distortion_model = "tilted"; }); },
       refused + "D of the left camera_info: the distortion model 'tilted' is not supported: use "
                 "plumb_bob *, rational_polynomial or equidistant *; then ok"},
      {54,
       "with rectify: D too short, or with NaN",
       "no calibration",
       [] {
         return badRawInfos([](Info& info) { info.D.resize(3); }) + "; " +
                badRawInfos([](Info& info) { info.D[1] = kNan; });
       },
       refused +
           "D of the left camera_info: the distortion plumb_bob has 3 coefficients instead of "
           "5: *; then ok; " +
           refused +
           "D of the left camera_info: a coefficient of the distortion plumb_bob is nan: "
           "*; then ok"},
      {55,
       "with rectify: K or R of zeros",
       "no calibration",
       [] {
         return badRawInfos([](Info& info) { info.K.fill(0.0); }) + "; " +
                badRawInfos([](Info& info) { info.R.fill(0.0); });
       },
       refused +
           "K of the left camera_info has focal lengths 0 and 0 px, but rectification needs "
           "them: *; then ok; " +
           refused +
           "the left camera_info: the rectification matrix R is not a rotation: *; then ok"},
      {56,
       "with rectify: no D, of images without distortion",
       "accepted",
       [] {
         return comparedDrive({},
                              both([](Info& info) {
                                info.D.clear();
                                info.distortion_model.clear();
                              }),
                              rectifying());
       },
       "ok, bit-identical result"},
      {57,
       "with rectify: images not of the size in camera_info",
       "no calibration",
       [] { return badInfos(both([](Info& info) { info.height += 10; }), rectifying()); },
       "*NO_CALIBRATION, dropped (image_not_of_camera_info): *; then ok"},
      {58,
       "with rectify: R of another rig",
       "lost or degraded with a hint",
       [] { return withoutChance(turnedCamera()); },
       "lost or degraded, hint: the images match if the right one is shifted by about * rows: K, "
       "D, "
       "R or P of camera_info are wrong; recalibrate; then ok"},
  };
}

TEST(BadInputsTest, EachIsHandledAsTheTableSays) {
  std::vector<BadInput> inputs;
  for (const auto& rows :
       {messageRows(), pictureRows(), badInfoRows(), oddInfoRows(), timeRows(), rawRows()}) {
    inputs.insert(inputs.end(), rows.begin(), rows.end());
  }
  expectRows(inputs);
}

}  // namespace
}  // namespace rotrocc
