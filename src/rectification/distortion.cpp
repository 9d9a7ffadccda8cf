#include "rectification/distortion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include <opencv2/calib3d.hpp>

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kMaxAngle = 89.0 * kDegree;  // of a ray that a pinhole camera could show

constexpr std::string_view kEquidistant = "equidistant";

const struct {
  const char* name;
  const char* ros_name;
  std::size_t coefficients;
} kModels[] = {{"plumb_bob", "plumb_bob", 5},
               {"radial-tangential", "plumb_bob", 5},
               {"radtan", "plumb_bob", 5},
               {"rational_polynomial", "rational_polynomial", 8},
               {"equidistant", "equidistant", 4},
               {"equi", "equidistant", 4},
               {"fisheye", "equidistant", 4},
               // Of drivers without a calibration, or of rectified images.
               {"", "plumb_bob", 5},
               {"none", "plumb_bob", 0}};

}  // namespace

Distortion::Distortion(const std::string& model, const std::vector<double>& coefficients)
    : coefficients_(coefficients), limit_(0.0) {
  const auto known = std::find_if(
      std::begin(kModels), std::end(kModels), [&](const auto& m) { return model == m.name; });
  if (known == std::end(kModels)) {
    throw std::invalid_argument("the distortion model '" + model +
                                "' is not supported: use plumb_bob (radial-tangential), "
                                "rational_polynomial or equidistant (fisheye)");
  }
  // More that are zero are of a model with more terms that this lens does not need.
  while (coefficients_.size() > known->coefficients && coefficients_.back() == 0.0) {
    coefficients_.pop_back();
  }
  const std::size_t count = known->coefficients;
  const bool lacks_k3 = count == 5 && coefficients_.size() == 4;
  if (!coefficients_.empty() && !lacks_k3 && coefficients_.size() != count) {
    throw std::invalid_argument(
        "the distortion " + model +
        cv::format(" has %zu coefficients instead of %zu: check the calibration file",
                   coefficients.size(),
                   count));
  }
  for (const double value : coefficients) {
    if (std::isfinite(value)) continue;
    throw std::invalid_argument("a coefficient of the distortion " + model +
                                cv::format(" is %g: check the calibration file", value));
  }
  name_ = known->ros_name;
  coefficients_.resize(name_ == kEquidistant ? 4 : std::max<std::size_t>(count, 5), 0.0);
  limit_ = findLimit();
  if (limit_ > 0.0) return;
  throw std::invalid_argument(
      "the distortion " + model +
      " shows everything in the middle of the image: check its coefficients");
}

bool Distortion::isNone() const {
  return name_ != kEquidistant &&
         std::all_of(
             coefficients_.begin(), coefficients_.end(), [](double value) { return value == 0.0; });
}

/// By OpenCV, wherever the points are.
Distortion::Points Distortion::apply(const std::vector<double>& coefficients,
                                     const Points& points) const {
  Points seen;
  if (points.empty()) return seen;
  const cv::Matx33d K = cv::Matx33d::eye();
  if (name_ == kEquidistant) {
    cv::fisheye::distortPoints(points, seen, K, coefficients);
  } else {
    std::vector<cv::Point3d> rays;
    cv::convertPointsToHomogeneous(points, rays);
    cv::projectPoints(rays, cv::Vec3d(), cv::Vec3d(), K, coefficients, seen);
  }
  return seen;
}

double Distortion::findLimit() const {
  constexpr double kStep = 0.25 * kDegree;
  std::vector<double> radial = coefficients_;
  if (name_ != kEquidistant) radial[2] = radial[3] = 0.0;
  Points points;
  for (double angle = kStep; angle < kMaxAngle; angle += kStep) {
    points.emplace_back(std::tan(angle), 0.0);
  }
  const Points seen = apply(radial, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (seen[i].x > (i == 0 ? 0.0 : seen[i - 1].x)) continue;
    return i == 0 ? 0.0 : points[i - 1].x;
  }
  return std::tan(kMaxAngle);
}

Distortion::Points Distortion::distort(Points points) const {
  for (cv::Point2d& point : points) {
    const double radius = cv::norm(point);
    if (radius > limit_) point *= (1.0 - 1e-9) * limit_ / radius;
  }
  return apply(coefficients_, points);
}

Distortion::Points Distortion::undistort(const Points& distorted) const {
  Points points;
  if (distorted.empty()) return points;
  const cv::Matx33d K = cv::Matx33d::eye();
  if (name_ == kEquidistant) {
    cv::fisheye::undistortPoints(distorted, points, K, coefficients_);
  } else {
    const cv::TermCriteria exact(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-15);
    cv::undistortPoints(distorted, points, K, coefficients_, cv::noArray(), cv::noArray(), exact);
  }
  return points;
}

}  // namespace rotrocc
