#include "input/sent_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "input/input_error.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

using Info = sensor_msgs::CameraInfo;

constexpr double kMaxSize_px = 1e6;  // keeps sizes in the range of int

/// Share of the image by which a principal point may be off its middle: lenses are mounted better,
/// and rectification moves it little.
constexpr double kUsualShare = 0.1;
/// The middle half of the image.
constexpr double kUnlikelyShare = 0.25;
/// A principal point that is off by the same factor in x and y, up to kSameFactor, is that of
/// another size.
constexpr double kOtherSize = 1.2;
constexpr double kSameFactor = 0.1;

constexpr double kNarrowest_deg = 10.0;
constexpr double kWidest_deg = 160.0;
constexpr double kMaxPixelAspect = 1.1;
/// Of rigs on anything that is neither an endoscope nor a ship.
constexpr double kSmallBaseline_m = 0.01;
constexpr double kGreatBaseline_m = 2.0;

double binningOf(std::uint32_t binning) {
  return std::max(binning, 1u);
}

/// How far the principal point is from the middle of the whole image, as a share of its size.
double offMiddle(const Info& info, const CalibratedImage& of) {
  const auto share = [&](double center, double binning, double offset, double size) {
    const double whole = (of.is_binned ? binning : 1.0) * center + (of.is_cropped ? offset : 0.0);
    return std::abs(whole / size - 0.5);
  };
  return std::max(share(info.P[2], binningOf(info.binning_x), info.roi.x_offset, info.width),
                  share(info.P[6], binningOf(info.binning_y), info.roi.y_offset, info.height));
}

std::string pointText(double x, double y) {
  return "(" + fixedText(x, 1) + ", " + fixedText(y, 1) + ") px";
}

/// The factor between the size that a principal point is of and that of the image; 1 if it does
/// not look like one of another size.
double otherSize(double cx, double cy, const Info& sent) {
  const double x = 2.0 * cx / sent.width;
  const double y = 2.0 * cy / sent.height;
  if (!(x > 0.0 && y > 0.0)) return 1.0;
  const double factor = std::sqrt(x * y);
  const bool is_same = std::abs(x / factor - 1.0) < kSameFactor;
  return is_same && std::max(factor, 1.0 / factor) > kOtherSize ? factor : 1.0;
}

void append(std::string& text, const std::string& warning) {
  text += (text.empty() ? "" : "; ") + warning;
}

}  // namespace

bool isCropped(const Info& info) {
  const auto& roi = info.roi;
  return roi.x_offset > 0 || roi.y_offset > 0 || (roi.width > 0 && roi.width < info.width) ||
         (roi.height > 0 && roi.height < info.height);
}

CalibratedImage calibratedImageOf(const Info& info) {
  CalibratedImage best;
  const double by_convention = offMiddle(info, best);
  if (by_convention <= kUsualShare) return best;
  double least = 0.5 * by_convention;
  for (const CalibratedImage& other : {CalibratedImage{true, false}, {false, true}, {true, true}}) {
    const double off = offMiddle(info, other);
    if (off >= least) continue;
    least = off;
    best = other;
  }
  return best;
}

Info ofSentImages(Info info, const CalibratedImage& of) {
  const auto& roi = info.roi;
  const auto scale = [&](double* row, std::size_t columns, double binning, double offset) {
    const double pixel = of.is_binned ? 1.0 : binning;  // in those of the matrix
    if (!of.is_cropped) row[2] -= offset * pixel / binning;
    for (std::size_t i = 0; i < columns; ++i) row[i] /= pixel;
  };
  const double binning_x = binningOf(info.binning_x);
  const double binning_y = binningOf(info.binning_y);
  for (const auto& [data, columns] :
       {std::pair<double*, std::size_t>{info.K.data(), 3}, {info.P.data(), 4}}) {
    scale(data, columns, binning_x, roi.x_offset);
    scale(data + columns, columns, binning_y, roi.y_offset);
  }
  const double width = (roi.width > 0 ? roi.width : info.width) / binning_x;
  const double height = (roi.height > 0 ? roi.height : info.height) / binning_y;
  info.width = static_cast<std::uint32_t>(std::min(width, kMaxSize_px));
  info.height = static_cast<std::uint32_t>(std::min(height, kMaxSize_px));
  return info;
}

void requireOfItsImage(const std::string& matrix, double cx, double cy, const Info& sent) {
  const bool is_inside = cx >= 0.0 && cy >= 0.0 && cx <= sent.width && cy <= sent.height;
  const double factor = otherSize(cx, cy, sent);
  if (is_inside && factor == 1.0) return;
  const std::string what = matrix + " has its principal point at " + pointText(cx, cy) +
                           (is_inside ? " of" : ", outside of") + " images of " +
                           sizeText(sent.width, sent.height);
  const std::string remedy =
      factor == 1.0 ? ": give the calibration of these images, or set roi in camera_info if they "
                      "are a part of larger ones"
                    : ", as that of images " + toText(factor, 3) +
                          " times as large: scale fx, fy, cx, cy and P[3] with the images, or "
                          "calibrate at this resolution";
  throw InputError(DropReason::kCameraInfoInvalid, what + remedy);
}

std::string calibrationWarning(const Info& info, const StereoCamera& camera) {
  std::string text;
  const CalibratedImage of = calibratedImageOf(info);
  if (of.is_binned || of.is_cropped) {
    append(text,
           std::string("by its principal point, P of camera_info is that of the ") +
               (of.is_binned ? "binned image" : "image") + (of.is_cropped ? " in roi" : "") +
               ", and is used as such: other programs expect that of the whole image");
  }
  const auto off = [](double center, int size) { return std::abs(center / size - 0.5); };
  if (!isCropped(info) &&
      std::max(off(camera.cx, camera.width), off(camera.cy, camera.height)) > kUnlikelyShare) {
    append(text,
           "the principal point " + pointText(camera.cx, camera.cy) +
               " is far from the middle of " + sizeText(camera.width, camera.height) +
               ": were the images cropped or resized after the calibration?");
  }
  const double view_deg = 2.0 * std::atan2(0.5 * camera.width, camera.fx) * 180.0 / M_PI;
  if (view_deg < kNarrowest_deg || view_deg > kWidest_deg) {
    append(text,
           "with fx " + toText(camera.fx) + " px, the images show " + toText(view_deg, 3) +
               " degrees: is P of camera_info in pixels?");
  }
  if (std::max(camera.fx / camera.fy, camera.fy / camera.fx) > kMaxPixelAspect) {
    append(text,
           "the focal lengths " + toText(camera.fx) + " and " + toText(camera.fy) +
               " px differ: were the images stretched?");
  }
  return text;
}

std::string baselineWarning(double baseline_m) {
  if (baseline_m >= kSmallBaseline_m && baseline_m <= kGreatBaseline_m) return "";
  return "a baseline of " + toText(baseline_m) +
         " m is unusual: is P[3] of camera_info in pixels times meters, not mm or cm?";
}

}  // namespace rotrocc
