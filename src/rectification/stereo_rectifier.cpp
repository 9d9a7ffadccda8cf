#include "rectification/stereo_rectifier.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <opencv2/core/hal/intrin.hpp>

namespace rotrocc {
namespace {

constexpr int kBits = 10;  // of a weight: the products of two and a pixel fit into 32 bits
constexpr int kOne = 1 << kBits;

/// The weight of a pixel at a distance [px] below 2.
double catmullRom(double distance) {
  const double d = std::abs(distance);
  if (d < 1.0) return 1.0 + d * d * (1.5 * d - 2.5);
  return 2.0 + d * (-4.0 + d * (2.5 - 0.5 * d));
}

std::uint32_t fourPixels(const std::uint8_t* pixels) {
  std::uint32_t value;
  std::memcpy(&value, pixels, sizeof(value));
  return value;
}

}  // namespace

ImageResampler::ImageResampler(const cv::Size& source, const cv::Size& size)
    : source_(source), size_(size), places_(static_cast<std::size_t>(size.area())) {}

/// The weights of each phase sum up to one, so that areas of one gray level keep it.
std::array<ImageResampler::Weights, ImageResampler::kPhases> ImageResampler::weightTable() {
  std::array<Weights, kPhases> table;
  for (int phase = 0; phase < kPhases; ++phase) {
    std::array<std::int32_t, kTaps>& weights = table[phase].across;
    int sum = 0;
    for (int tap = 0; tap < kTaps; ++tap) {
      const double distance = tap - 1 - static_cast<double>(phase) / kPhases;
      weights[tap] = static_cast<std::int32_t>(std::lround(kOne * catmullRom(distance)));
      sum += weights[tap];
    }
    weights[phase < kPhases / 2 ? 1 : 2] += kOne - sum;
    for (int i = 0; i < 2 * kTaps; ++i) {
      const int row = 2 * (i % 2);
      table[phase].down_0_2[i] = static_cast<std::int16_t>(weights[row]);
      table[phase].down_1_3[i] = static_cast<std::int16_t>(weights[row + 1]);
    }
  }
  return table;
}

void ImageResampler::setPlace(int x, int y, const cv::Point2d& place) {
  const auto fixed = [](double position, int count) {
    const double nearest = std::max(0.0, std::min(position, count - 1.0));  // 0 for NaN
    return static_cast<int>(std::lround(nearest * kPhases));
  };
  const int column = fixed(place.x, source_.width);
  const int row = fixed(place.y, source_.height);
  Place& stored = places_[static_cast<std::size_t>(y) * size_.width + x];
  stored.column = static_cast<std::int16_t>(column / kPhases);
  stored.row = static_cast<std::int16_t>(row / kPhases);
  stored.column_phase = static_cast<std::uint8_t>(column % kPhases);
  stored.row_phase = static_cast<std::uint8_t>(row % kPhases);
}

/// The sum of the weighted pixels, of integers. The registers have rows 0 and 2, and 1 and 3, in
/// turn.
std::uint8_t ImageResampler::pixelAt(const Place& place) const {
  const std::uint8_t* pixels = framed_.ptr(place.row) + place.column;
  const std::size_t step = framed_.step;
  const cv::v_uint8x16 rows =
      cv::v_reinterpret_as_u8(cv::v_uint32x4(fourPixels(pixels),
                                             fourPixels(pixels + step),
                                             fourPixels(pixels + 2 * step),
                                             fourPixels(pixels + 3 * step)));
  cv::v_uint16x8 rows_0_1, rows_2_3, rows_0_2, rows_1_3;
  cv::v_expand(rows, rows_0_1, rows_2_3);
  cv::v_zip(rows_0_1, rows_2_3, rows_0_2, rows_1_3);
  const Weights& down = weights_[place.row_phase];
  const cv::v_int32x4 columns =
      cv::v_dotprod(cv::v_reinterpret_as_s16(rows_0_2), cv::v_load(down.down_0_2.data())) +
      cv::v_dotprod(cv::v_reinterpret_as_s16(rows_1_3), cv::v_load(down.down_1_3.data()));
  const cv::v_int32x4 across = cv::v_load(weights_[place.column_phase].across.data());
  const int sum = cv::v_reduce_sum(columns * across);
  return cv::saturate_cast<std::uint8_t>((sum + (1 << (2 * kBits - 1))) >> (2 * kBits));
}

void ImageResampler::resample(const cv::Mat& image, cv::Mat& result) {
  CV_Assert(image.type() == CV_8UC1 && image.size() == source_);
  cv::copyMakeBorder(
      image, framed_, 1, kTaps - 2, 1, kTaps - 2, cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
  const Place* place = places_.data();
  for (int y = 0; y < size_.height; ++y) {
    std::uint8_t* pixels = result.ptr(y);
    for (int x = 0; x < size_.width; ++x, ++place) pixels[x] = pixelAt(*place);
  }
}

/// For a rectified image with the principal point (cx, camera.cy).
StereoRectifier::Side StereoRectifier::makeSide(const RawCamera& raw,
                                                const StereoCamera& camera,
                                                double cx) {
  Side side = {ImageResampler({raw.width, raw.height}, {camera.width, camera.height}),
               cv::Mat(camera.height, camera.width, CV_8UC1)};
  for (int y = 0; y < camera.height; ++y) {
    std::vector<Eigen::Vector3d> rays;
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d rectified((x - cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
      Eigen::Vector3d& ray = rays.emplace_back(raw.R_rectified_raw.transpose() * rectified);
      // A camera that is turned far sees no ray from behind; the nearest is at its horizon.
      ray.z() = std::max(ray.z(), 1e-6 * ray.norm());
    }
    const std::vector<cv::Point2d> pixels = raw.project(rays);
    for (int x = 0; x < camera.width; ++x) side.resampler.setPlace(x, y, pixels[x]);
  }
  return side;
}

/// Once for each mask, into memory of its own: who has the last result may keep it.
const cv::Mat& StereoRectifier::rectifyMask(const cv::Mat& raw_mask, Side& side) {
  if (raw_mask.data == side.raw_mask.data) return side.mask;
  side.raw_mask = raw_mask;
  side.mask.release();
  if (raw_mask.empty()) return side.mask;
  cv::Mat shares(side.rectified.size(), CV_8UC1);
  side.resampler.resample(raw_mask, shares);
  side.mask = shares > 0;
  return side.mask;
}

StereoPair StereoRectifier::rectify(const StereoPair& raw,
                                    const std::shared_ptr<const StereoCalibration>& calibration) {
  if (calibration != calibration_) {
    const StereoCamera& camera = calibration->rectified;
    left_ = makeSide(calibration->left, camera, camera.cx);
    right_ = makeSide(calibration->right, camera, camera.cx_right);
    calibration_ = calibration;
  }
  cv::parallel_for_({0, 2}, [&](const cv::Range& sides) {
    for (int i = sides.start; i < sides.end; ++i) {
      Side& side = i == 0 ? *left_ : *right_;
      side.resampler.resample(i == 0 ? raw.left : raw.right, side.rectified);
    }
  });
  return {raw.stamp_ns,
          left_->rectified,
          right_->rectified,
          rectifyMask(raw.left_mask, *left_),
          rectifyMask(raw.right_mask, *right_)};
}

}  // namespace rotrocc
