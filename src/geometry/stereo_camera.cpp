#include "rotrocc/stereo_camera.h"

#include <cmath>
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

bool StereoCamera::operator==(const StereoCamera& other) const {
  return width == other.width && height == other.height && fx == other.fx && fy == other.fy &&
         cx == other.cx && cy == other.cy && cx_right == other.cx_right &&
         baseline_m == other.baseline_m;
}

}  // namespace rotrocc
