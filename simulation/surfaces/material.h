#pragma once

#include <memory>

#include "simulation/surfaces/surface_point.h"
#include "simulation/surfaces/texture.h"

namespace rotrocc {

/// Appearance of a surface. Points are in the frame of the body: y points down, 0 is the ground.
class Material {
 public:
  virtual ~Material() = default;

  /// Reflectance, about 0 to 1, averaged over the pixel.
  virtual double reflectance(const SurfacePoint& point) const = 0;

  /// Share of its surface that reflects as glass does, from 0 to 1.
  virtual double gloss(const SurfacePoint& /*point*/) const { return 0.0; }

  /// Light of its own when lights are on, averaged over the pixel; 1 is white.
  virtual double glow(const SurfacePoint& /*point*/) const { return 0.0; }

  /// Whether it is transparent at a place with this normal; a pixel is `pixel_m` wide. Holes must
  /// vanish where they are smaller than that.
  virtual bool isHole(const Eigen::Vector3d& /*position*/,
                      const Eigen::Vector3d& /*normal*/,
                      double /*pixel_m*/) const {
    return false;
  }

  /// Whether edges of such materials need no anti-aliasing, e.g. leaves.
  virtual bool isTangle() const { return false; }
};

/// Uniform, and perhaps a lamp at night.
class PlainMaterial : public Material {
 public:
  explicit PlainMaterial(double reflectance, double glow = 0.0)
      : reflectance_(reflectance), glow_(glow) {}
  double reflectance(const SurfacePoint& /*point*/) const override { return reflectance_; }
  double glow(const SurfacePoint& /*point*/) const override { return glow_; }

 private:
  double reflectance_;
  double glow_;
};

/// Coordinates on the face of a body: along it level, and up (or forward, on top of it).
TexturePoint faceCoordinates(const SurfacePoint& point);

/// A texture on the faces of a body: `mean` plus and minus up to half of `contrast`.
class TexturedMaterial : public Material {
 public:
  TexturedMaterial(const Texture& texture, double mean, double contrast)
      : texture_(texture), mean_(mean), contrast_(contrast) {}

  double reflectance(const SurfacePoint& point) const override {
    return mean_ + contrast_ * (texture_.at(faceCoordinates(point)) - 0.5);
  }

 private:
  const Texture& texture_;
  double mean_;
  double contrast_;
};

}  // namespace rotrocc
