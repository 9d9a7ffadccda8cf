#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace rotrocc {

/// How a lens moves what it shows, in normalized coordinates: x / z and y / z of a point, or where
/// it is seen in an image of focal length 1. By default it moves nothing.
class Distortion {
 public:
  enum class Model { kPlumbBob, kRationalPolynomial, kEquidistant };

  Distortion() = default;

  /// `model` is a name of sensor_msgs/CameraInfo, ASL or Kalibr:
  ///   plumb_bob, radial-tangential, radtan   k1 k2 p1 p2 and optionally k3
  ///   rational_polynomial                    k1 k2 p1 p2 k3 k4 k5 k6
  ///   equidistant, equi, fisheye             k1 k2 k3 k4
  /// No coefficients: no distortion, or that of an equidistant lens without any. Throws
  /// std::invalid_argument with the value on an unknown name, a wrong number of coefficients, and
  /// values that are not finite.
  Distortion(const std::string& model, const std::vector<double>& coefficients);

  /// Name in sensor_msgs/CameraInfo.
  const char* name() const;

  /// As sensor_msgs/CameraInfo has them.
  const std::vector<double>& coefficients() const { return coefficients_; }

  /// Whether it moves nothing.
  bool isNone() const;

  /// Where a point is seen. Beyond limit() it is seen where the limit is.
  Eigen::Vector2d distort(const Eigen::Vector2d& point) const;

  /// The point that is seen at `distorted`; if there is none, the nearest at limit().
  Eigen::Vector2d undistort(const Eigen::Vector2d& distorted) const;

  /// Radius up to which points that are farther out are seen farther out. The model says nothing
  /// about those beyond it: polynomials fold back there.
  double limit() const { return limit_; }

 private:
  double radialGain(double radius) const;
  Eigen::Vector2d tangential(const Eigen::Vector2d& point) const;
  double findLimit() const;
  double radiusSeenAt(double distorted_radius) const;

  Model model_ = Model::kPlumbBob;
  std::vector<double> coefficients_ = std::vector<double>(5, 0.0);
  double limit_ = findLimit();
};

}  // namespace rotrocc
