#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// The cameras of EuRoC by their sensor.yaml, before rectification, and with lenses of another
/// model.
struct RawRig {
  RawCamera left;
  RawCamera right;
  Eigen::Isometry3d T_left_right;
};

inline RawRig rawRig(const char* model = "radial-tangential") {
  const bool is_equidistant = std::string(model) == "equidistant";
  using Values = std::vector<double>;
  RawRig rig;
  rig.left = {752, 480, 458.654, 457.296, 367.215, 248.375, {}, Eigen::Matrix3d::Identity()};
  rig.right = {752, 480, 457.587, 456.134, 379.999, 255.238, {}, Eigen::Matrix3d::Identity()};
  rig.left.distortion = {model,
                         is_equidistant
                             ? Values{-0.0044, -0.0047, 0.0002, 0.0003}
                             : Values{-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}};
  rig.right.distortion = {model,
                          is_equidistant
                              ? Values{-0.0031, -0.0062, 0.0011, -0.0002}
                              : Values{-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05}};
  Eigen::Matrix3d R_left_right;                             // rounded, as in a file
  R_left_right << 0.999997256, -0.002317136, -0.000343393,  //
      0.002312067, 0.999898049, -0.014090669,               //
      0.000376008, 0.014089836, 0.999900663;
  rig.T_left_right = Eigen::Isometry3d::Identity();
  rig.T_left_right.linear() = Eigen::Quaterniond(R_left_right).normalized().toRotationMatrix();
  rig.T_left_right.translation() << 0.110074138, -0.000156612, 0.000889383;
  return rig;
}

}  // namespace rotrocc
