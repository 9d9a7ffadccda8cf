#include "rectification/distortion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

using Model = Distortion::Model;

constexpr double kDegree = M_PI / 180.0;
constexpr double kMaxAngle = 89.0 * kDegree;  // of a ray that a pinhole camera could show

const struct {
  const char* name;  // that of sensor_msgs/CameraInfo first
  Model model;
  std::size_t coefficients;
} kModels[] = {{"plumb_bob", Model::kPlumbBob, 5},
               {"radial-tangential", Model::kPlumbBob, 5},
               {"radtan", Model::kPlumbBob, 5},
               {"rational_polynomial", Model::kRationalPolynomial, 8},
               {"equidistant", Model::kEquidistant, 4},
               {"equi", Model::kEquidistant, 4},
               {"fisheye", Model::kEquidistant, 4}};

Model modelNamed(const std::string& name) {
  for (const auto& known : kModels) {
    if (name == known.name) return known.model;
  }
  throw std::invalid_argument("the distortion model '" + name +
                              "' is not supported: use plumb_bob (radial-tangential), "
                              "rational_polynomial or equidistant (fisheye)");
}

const auto& entryOf(Model model) {
  return *std::find_if(
      std::begin(kModels), std::end(kModels), [&](const auto& m) { return m.model == model; });
}

/// As many as the model has, zeros for those that may be left out.
std::vector<double> complete(Model model, const std::string& name, std::vector<double> values) {
  const std::size_t count = entryOf(model).coefficients;
  const bool lacks_k3 = model == Model::kPlumbBob && values.size() == 4;
  if (!values.empty() && !lacks_k3 && values.size() != count) {
    throw std::invalid_argument(
        "the distortion " + name +
        cv::format(" has %zu coefficients instead of %zu: check the calibration file",
                   values.size(),
                   count));
  }
  for (const double value : values) {
    if (std::isfinite(value)) continue;
    throw std::invalid_argument("a coefficient of the distortion " + name +
                                cv::format(" is %g: check the calibration file", value));
  }
  values.resize(count, 0.0);
  return values;
}

}  // namespace

Distortion::Distortion(const std::string& model, const std::vector<double>& coefficients)
    : model_(modelNamed(model)),
      coefficients_(complete(model_, model, coefficients)),
      limit_(findLimit()) {
  if (limit_ > 0.0) return;
  throw std::invalid_argument(
      "the distortion " + model +
      " shows everything in the middle of the image: check its coefficients");
}

const char* Distortion::name() const {
  return entryOf(model_).name;
}

bool Distortion::isNone() const {
  return model_ != Model::kEquidistant &&
         std::all_of(
             coefficients_.begin(), coefficients_.end(), [](double value) { return value == 0.0; });
}

/// Distorted radius over radius, without the tangential part.
double Distortion::radialGain(double radius) const {
  const std::vector<double>& k = coefficients_;
  if (model_ == Model::kEquidistant) {
    if (radius < 1e-9) return 1.0;
    const double angle = std::atan(radius);
    const double square = angle * angle;
    return angle / radius *
           (1.0 + square * (k[0] + square * (k[1] + square * (k[2] + square * k[3]))));
  }
  const double square = radius * radius;
  const double gain = 1.0 + square * (k[0] + square * (k[1] + square * k[4]));
  if (model_ == Model::kPlumbBob) return gain;
  return gain / (1.0 + square * (k[5] + square * (k[6] + square * k[7])));
}

Eigen::Vector2d Distortion::tangential(const Eigen::Vector2d& point) const {
  if (model_ == Model::kEquidistant) return Eigen::Vector2d::Zero();
  const double p1 = coefficients_[2];
  const double p2 = coefficients_[3];
  const double x = point.x();
  const double y = point.y();
  const double square = point.squaredNorm();
  return {2.0 * p1 * x * y + p2 * (square + 2.0 * x * x),
          p1 * (square + 2.0 * y * y) + 2.0 * p2 * x * y};
}

double Distortion::findLimit() const {
  constexpr double kStep = 0.25 * kDegree;
  double seen_at = 0.0;
  for (double angle = kStep; angle < kMaxAngle; angle += kStep) {
    const double radius = std::tan(angle);
    const double next = radius * radialGain(radius);
    if (!(next > seen_at)) return std::tan(angle - kStep);
    seen_at = next;
  }
  return std::tan(kMaxAngle);
}

Eigen::Vector2d Distortion::distort(const Eigen::Vector2d& point) const {
  const double radius = point.norm();
  if (radius > limit_) return distort(point * ((1.0 - 1e-9) * limit_ / radius));
  return radialGain(radius) * point + tangential(point);
}

/// Inverse of the radial part, by bisection: it rises up to the limit.
double Distortion::radiusSeenAt(double distorted_radius) const {
  double low = 0.0;
  double high = limit_;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * radialGain(middle) < distorted_radius ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Eigen::Vector2d Distortion::undistort(const Eigen::Vector2d& distorted) const {
  Eigen::Vector2d point = distorted;
  for (int i = 0; i < 20; ++i) {  // the tangential part is small
    const Eigen::Vector2d radial = distorted - tangential(point);
    const double radius = radial.norm();
    if (radius == 0.0) return radial;
    point = radiusSeenAt(radius) / radius * radial;
  }
  return point;
}

}  // namespace rotrocc
