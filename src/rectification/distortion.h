#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// How a lens moves what it shows, in normalized coordinates: x / z and y / z of a point, or where
/// it is seen in an image of focal length 1. By default it moves nothing.
class Distortion {
 public:
  Distortion() = default;

  /// `model` is a name of sensor_msgs/CameraInfo, ASL or Kalibr:
  ///   plumb_bob, radial-tangential, radtan   k1 k2 p1 p2 and optionally k3
  ///   rational_polynomial                    k1 k2 p1 p2 k3 k4 k5 k6
  ///   equidistant, equi, fisheye             k1 k2 k3 k4
  ///   none                                   nothing
  /// An empty name is plumb_bob. No coefficients: no distortion, or that of an equidistant lens
  /// without any; more of them must be zero. Throws std::invalid_argument with the value on an
  /// unknown name, a wrong number of coefficients, and values that are not finite.
  Distortion(const std::string& model, const std::vector<double>& coefficients);

  /// Name in sensor_msgs/CameraInfo.
  const char* name() const { return name_; }

  /// As sensor_msgs/CameraInfo has them.
  const std::vector<double>& coefficients() const { return coefficients_; }

  /// Whether it moves nothing.
  bool isNone() const;

  using Points = std::vector<cv::Point2d>;

  /// Where points are seen. Beyond limit() they are seen where the limit is.
  Points distort(Points points) const;

  /// The points that are seen at `distorted`. Where the model shows none, the result is any point.
  Points undistort(const Points& distorted) const;

  /// Radius up to which points that are farther out are seen farther out. The model says nothing
  /// about those beyond it: polynomials fold back there.
  double limit() const { return limit_; }

 private:
  Points apply(const std::vector<double>& coefficients, const Points& points) const;
  double findLimit() const;

  const char* name_ = "plumb_bob";
  std::vector<double> coefficients_ = std::vector<double>(5, 0.0);
  double limit_ = findLimit();
};

}  // namespace rotrocc
