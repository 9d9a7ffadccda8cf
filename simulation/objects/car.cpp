#include "simulation/objects/objects.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

/// Lengths in meters; heights above the ground.
struct CarSize {
  double half_length, half_width;
  double belt, roof;                 // heights of the lower edge of the windows and of the roof
  double rear_window, front_window;  // z of their lower edges
  double slope;                      // of the windscreen: forward per upward
  double wheel_radius;
  double axle;  // distance of the axles from the middle
};

/// Lacquer with the lights, plates and seams of a car's lower body.
class CarBody {
 public:
  CarBody(const CarSize& size, double paint) : size_(size), paint_(paint) {}

  double operator()(const SurfacePoint& point) const {
    const double height = -point.position.y();
    const double sheen = 0.75 + 0.35 * smoothStep(0.3, size_.belt, height);
    if (std::abs(point.normal.x()) > 0.6) return side(point, sheen);
    if (std::abs(point.normal.z()) > 0.6) return end(point, sheen);
    return paint_ * sheen + 0.12 * std::abs(point.normal.y());  // the sky in the bonnet
  }

 private:
  double lamps(const TexturePoint& at, bool front) const {
    const double bottom = front ? size_.belt - 0.33 : size_.belt - 0.3;
    return coverageBetween(size_.half_width - 0.42,
                           size_.half_width - 0.08,
                           std::abs(at.at.x()),
                           at.pixelWidth()) *
           coverageBetween(bottom, bottom + 0.18, at.at.y(), at.pixelHeight());
  }

  double side(const SurfacePoint& point, double sheen) const {
    const TexturePoint at = faceCoordinates(point);
    const double width = at.pixelWidth();
    const double height = at.pixelHeight();
    double brightness = paint_ * sheen;
    for (const double seam : {-0.95, 0.1, 0.95}) {
      const double line = coverageBetween(seam - 0.012, seam + 0.012, at.at.x(), width);
      brightness = mix(brightness, 0.3 * brightness, line);
    }
    const double trim = coverageBetween(0.5, 0.56, at.at.y(), height);
    brightness = mix(brightness, 0.5 * paint_ + 0.1, trim);
    const double sill = 1.0 - coverageAbove(0.3, at.at.y(), height);
    brightness = mix(brightness, 0.06, sill);
    for (const double axle : {-size_.axle, size_.axle}) {
      const double radius = std::hypot(at.at.x() - axle, at.at.y() - size_.wheel_radius);
      const double arch = 1.0 - coverageAbove(1.2 * size_.wheel_radius, radius, width);
      brightness = mix(brightness, 0.03, arch);
    }
    return brightness;
  }

  double end(const SurfacePoint& point, double sheen) const {
    const TexturePoint at = faceCoordinates(point);
    const double width = at.pixelWidth();
    const double height = at.pixelHeight();
    const bool front = point.normal.z() > 0.0;
    const double x = std::abs(at.at.x());
    const auto area = [&](double left, double right, double bottom, double top) {
      return coverageBetween(left, right, x, width) *
             coverageBetween(bottom, top, at.at.y(), height);
    };
    double brightness = paint_ * sheen;
    brightness = mix(brightness, 0.06, area(-1.0, size_.half_width, 0.0, 0.36));
    brightness = mix(brightness, front ? 0.9 : 0.2, lamps(at, front));
    const double grille = front ? area(-1.0, 0.4, size_.belt - 0.3, size_.belt - 0.16) : 0.0;
    brightness = mix(brightness, 0.05, grille);
    const double plate = area(-1.0, 0.26, 0.42, 0.53);
    const double letters = coveragePeriodic(0.075, 0.035, x, width) * area(-1.0, 0.23, 0.44, 0.51);
    return mix(mix(brightness, 0.85, plate), 0.1, letters);
  }

  CarSize size_;
  double paint_;
};

/// Windows between painted pillars, and the roof.
Material cabinMaterial(const CarSize& size, double paint) {
  return {[=](const SurfacePoint& point) {
    if (point.normal.y() < -0.9) return 0.95 * paint + 0.08;
    const TexturePoint at = faceCoordinates(point);
    const double width = at.pixelWidth();
    const double height = at.pixelHeight();
    double glass = coverageBetween(size.belt + 0.05, size.roof - 0.09, at.at.y(), height);
    if (std::abs(point.normal.x()) > 0.6) {
      for (const double pillar : {-0.85, 0.1}) {
        glass *= 1.0 - coverageBetween(pillar - 0.05, pillar + 0.05, at.at.x(), width);
      }
    } else {
      const double half = size.half_width - 0.2;
      glass *= coverageBetween(-half, half, at.at.x(), width);
    }
    const double sky = 0.05 + 0.3 * smoothStep(size.belt, size.roof + 0.2, at.at.y());
    return mix(paint, sky, glass);
  }};
}

/// A tyre around a rim with five spokes, its hub at `hub_z`.
Material wheelMaterial(double hub_z, double wheel_radius) {
  return {[=](const SurfacePoint& point) {
    if (std::abs(point.normal.x()) < 0.5) return 0.06;
    const double y = -point.position.y() - wheel_radius;
    const double z = point.position.z() - hub_z;
    const double width = std::max(std::hypot(point.per_row.y(), point.per_row.z()), 1e-4);
    const double radius = std::hypot(y, z);
    const double rim = 1.0 - coverageAbove(0.62 * wheel_radius, radius, width);
    const double hub = 1.0 - coverageAbove(0.2 * wheel_radius, radius, width);
    const double fine = 1.0 - smoothStep(0.1, 0.3, width / wheel_radius);
    const double spokes = 0.5 + 0.5 * fine * std::sin(5.0 * std::atan2(y, z));
    return mix(0.06, mix(0.15 + 0.5 * spokes, 0.55, hub), rim);
  }};
}

CarSize randomCar(RandomStream& random) {
  CarSize size;
  size.half_length = random.uniform(1.95, 2.3);
  size.half_width = random.uniform(0.84, 0.91);
  size.belt = random.uniform(0.86, 0.95);
  size.roof = random.uniform(1.42, 1.62);
  const bool estate = random.chance(0.5);
  size.rear_window = -size.half_length + (estate ? 0.08 : 0.55);
  size.front_window = size.half_length - random.uniform(0.95, 1.15);
  size.slope = random.uniform(0.9, 1.2);
  size.wheel_radius = 0.32;
  size.axle = size.half_length - 0.82;
  return size;
}

CarSize randomVan(RandomStream& random) {
  CarSize size = randomCar(random);
  size.half_length = random.uniform(2.4, 2.7);
  size.half_width = 0.98;
  size.belt = 1.15;
  size.roof = random.uniform(2.1, 2.5);
  size.rear_window = -size.half_length + 0.04;
  size.front_window = size.half_length - 0.75;
  size.slope = 0.45;
  size.axle = size.half_length - 0.9;
  return size;
}

std::shared_ptr<Shape> bodyShape(const CarSize& size) {
  const double l = size.half_length;
  const double w = size.half_width;
  auto solid = std::make_shared<ConvexSolid>(
      Eigen::AlignedBox3d(Eigen::Vector3d(-w, -size.belt, -l), Eigen::Vector3d(w, -0.2, l)));
  for (const double end : {-1.0, 1.0}) {
    solid->cut({0.0, -0.5, end}, {0.0, -size.belt + 0.1, end * l});  // bonnet and boot
    solid->cut({0.0, 0.5, end}, {0.0, -0.38, end * l});              // below the bumpers
    for (const double side : {-1.0, 1.0}) {
      solid->cut({side, 0.0, 0.5 * end}, {side * w, 0.0, end * (l - 0.35)});  // corners
      solid->cut({side, 0.0, end}, {side * (w - 0.14), 0.0, end * (l - 0.05)});
    }
  }
  solid->cut({0.0, -1.0, 0.09}, {0.0, -size.belt, size.front_window});  // the bonnet slopes
  for (const double side : {-1.0, 1.0}) {
    solid->cut({side, -0.35, 0.0}, {side * w, -size.belt + 0.2, 0.0});
    solid->cut({side, 0.5, 0.0}, {side * w, -0.36, 0.0});
  }
  return solid;
}

std::shared_ptr<Shape> cabinShape(const CarSize& size) {
  const double w = size.half_width - 0.05;
  auto solid = std::make_shared<ConvexSolid>(
      Eigen::AlignedBox3d(Eigen::Vector3d(-w, -size.roof, size.rear_window),
                          Eigen::Vector3d(w, -size.belt + 0.08, size.front_window)));
  solid->cut({0.0, -size.slope, 1.0}, {0.0, -size.belt, size.front_window});
  solid->cut({0.0, -0.4, -1.0}, {0.0, -size.belt, size.rear_window});
  for (const double side : {-1.0, 1.0}) {
    solid->cut({side, -0.28, 0.0}, {side * w, -size.belt, 0.0});
    solid->cut({side, -1.2, 0.0}, {side * (w - 0.22), -size.roof, 0.0});
  }
  return solid;
}

}  // namespace

Body makeCar(RandomStream& random) {
  const bool van = random.chance(0.12);
  const CarSize size = van ? randomVan(random) : randomCar(random);
  const double paint = random.chance(0.35) ? random.uniform(0.55, 0.85) : random.uniform(0.07, 0.4);
  std::vector<Part> parts = {{bodyShape(size), {CarBody(size, paint)}},
                             {cabinShape(size), cabinMaterial(size, paint)}};
  for (const double end : {-1.0, 1.0}) {
    const Material wheel = wheelMaterial(end * size.axle, size.wheel_radius);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d hub(
          side * (size.half_width - 0.11), -size.wheel_radius, end * size.axle);
      parts.push_back({cylinder(0, hub, size.wheel_radius, 0.12), wheel});
    }
  }
  return Body(std::move(parts));
}

}  // namespace rotrocc
