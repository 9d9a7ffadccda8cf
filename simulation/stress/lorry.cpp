#include "simulation/stress/lorry.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace rotrocc {
namespace {

constexpr double kBeyond_m = 8.0;  // to the left of the view
constexpr double kHeight_m = 5.0;
constexpr double kDepth_m = 0.05;  // its side would cover more than the share

/// Stains and specks; nothing on it repeats itself in sight.
class Tarpaulin : public Material {
 public:
  explicit Tarpaulin(const TextureTiles& tiles) : tiles_(tiles) {}

  double reflectance(const SurfacePoint& point) const override {
    const TexturePoint at = faceCoordinates(point);
    const double stains = tiles_.leaves.at(scaled(at, 0.4)) - 0.5;
    const double specks = tiles_.asphalt.at(scaled(at, 0.7)) - 0.5;
    return std::clamp(0.4 + 0.5 * stains + 0.5 * specks, 0.02, 0.95);
  }

 private:
  const TextureTiles& tiles_;
};

}  // namespace

Body makeLorry(double share, const StereoCamera& camera, const TextureTiles& tiles) {
  const double pixel_m = kLorryAhead_m / camera.fx;
  const double left_m = -(camera.cx + 0.5) * pixel_m;
  const double right_m = left_m + share * camera.width * pixel_m;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(left_m - kBeyond_m, -kHeight_m, 0.0),
                                Eigen::Vector3d(right_m, 0.0, kDepth_m));
  return Body({{std::make_shared<ConvexSolid>(box), std::make_shared<Tarpaulin>(tiles)}});
}

}  // namespace rotrocc
