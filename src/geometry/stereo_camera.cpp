#include "rotrocc/stereo_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

void require(bool ok, const char* name, double value, const char* wanted) {
  if (ok) return;
  throw std::invalid_argument(
      cv::format("stereo camera: %s is %g, but must be %s", name, value, wanted));
}

}  // namespace

void StereoCamera::check() const {
  require(width > 0, "width", width, "positive");
  require(height > 0, "height", height, "positive");
  require(std::isfinite(fx) && fx > 0.0, "fx", fx, "positive");
  require(std::isfinite(fy) && fy > 0.0, "fy", fy, "positive");
  require(std::isfinite(cx), "cx", cx, "finite");
  require(std::isfinite(cy), "cy", cy, "finite");
  require(std::isfinite(cx_right), "cx_right", cx_right, "finite");
  require(std::abs(disparityAtInfinity()) < width,
          "cx - cx_right",
          disparityAtInfinity(),
          "less than the width: there is nothing that both cameras see");
  require(std::isfinite(baseline_m) && baseline_m > 0.0,
          "baseline_m",
          baseline_m,
          "positive (are left and right exchanged?)");
}

StereoCamera StereoCamera::halved(int times) const {
  StereoCamera camera = *this;
  for (int* size : {&camera.width, &camera.height}) {
    for (int i = 0; i < times; ++i) *size = (*size + 1) / 2;
    for (int i = times; i < 0; ++i) *size *= 2;
  }
  for (double* px : {&camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.cx_right}) {
    *px = std::ldexp(*px, -times);
  }
  return camera;
}

double StereoCamera::differenceTo(const StereoCamera& other) const {
  if (width != other.width || height != other.height)
    return std::numeric_limits<double>::infinity();
  double difference = std::abs(other.baseline_m / baseline_m - 1.0);
  // Both are linear in the pixel, so the largest change is at a border.
  const auto compare = [&](double size, double f, double c, double other_f, double other_c) {
    for (const double px : {0.0, size}) {
      difference = std::max(difference, std::abs((px - other_c) / other_f - (px - c) / f));
    }
  };
  compare(width, fx, cx, other.fx, other.cx);
  compare(width, fx, cx_right, other.fx, other.cx_right);
  compare(height, fy, cy, other.fy, other.cy);
  return difference;
}

}  // namespace rotrocc
