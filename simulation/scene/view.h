#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "simulation/scene/body.h"

namespace rotrocc {

/// A camera at one time: its rays, and the bodies in each part of its image.
class View {
 public:
  /// Bodies are numbered: static ones first, then moving ones. All must outlive the view.
  View(const std::vector<Body>& standing,
       const std::vector<Body>& moving,
       const StereoCamera& camera,
       const Eigen::Isometry3d& T_world_camera);

  const std::vector<Body>& moving() const { return moving_; }
  int standingCount() const { return static_cast<int>(standing_.size()); }
  const Body& body(int number) const;

  /// The ray through a pixel, of unit depth, in the world.
  Ray ray(double x, double y) const { return {origin_, axes_ * camera_.ray({x, y})}; }
  const PixelSpread& spread() const { return spread_; }

  /// First body that the ray through a pixel of the image hits in `range`; false if there is none.
  bool intersect(double x, double y, const RayRange& range, BodyHit& hit, int& number) const;

 private:
  /// A potentially visible part of a body.
  struct Candidate {
    int body;
    int part;
    double nearest_m;        // smallest depth
    cv::Rect2d pixels;       // bounding box in the image
    Eigen::Vector3d origin;  // the camera, in the frame of the body
    Eigen::Matrix3d R_body_camera;
  };

  void addBody(int number, const Eigen::Isometry3d& T_world_camera);
  bool cover(const Eigen::AlignedBox3d& box,
             const Eigen::Isometry3d& T_camera_body,
             Candidate& candidate) const;
  void sortIntoTiles();

  const std::vector<Body>& standing_;
  const std::vector<Body>& moving_;
  StereoCamera camera_;
  Eigen::Vector3d origin_;
  Eigen::Matrix3d axes_;
  PixelSpread spread_;
  std::vector<Candidate> candidates_;  // by nearest_m
  int tile_columns_ = 0;
  std::vector<std::vector<std::int32_t>> tiles_;  // candidates, by nearest_m
};

}  // namespace rotrocc
