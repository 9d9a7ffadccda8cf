#include "simulation/places/tunnel.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "simulation/scene/lamps.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kSpeed_mps = 14.0;
constexpr double kSegment_m = 5.0;   // all are equal
constexpr double kBeyond_m = 260.0;  // the ends are out of sight
constexpr double kHalfWidth_m = 5.3;
constexpr double kHeight_m = 4.9;
constexpr double kCamera_m = 1.65;  // above the road, which is level
constexpr double kLane_m = 1.8;     // centre of the own lane
constexpr int kLampEvery = 2;       // segments
constexpr int kSignEvery = 5;
constexpr int kDoorEvery = 20;

/// How much of a pixel is in the joint at either end of a segment. Segments reach a little into
/// each other, where all are as dark.
double joint(double along, double width) {
  constexpr double kHalf_m = 0.5 * kSegment_m - 0.03;
  return 1.0 - coverageBetween(-kHalf_m, kHalf_m, along, width);
}

/// Bright panels below concrete.
class TunnelWall : public Material {
 public:
  explicit TunnelWall(const TextureTiles& tiles) : tiles_(tiles) {}

  double reflectance(const SurfacePoint& point) const override {
    constexpr double kPanels_m = 3.1;  // height
    const TexturePoint at = faceCoordinates(point);
    const double above = coverageAbove(kPanels_m, at.at.y(), at.pixelHeight());
    const double soot = tiles_.plaster.at(at) - 0.5;
    const double seams = std::max(coveragePeriodic(1.25, 0.012, at.at.x(), at.pixelWidth()),
                                  coveragePeriodic(1.5, 0.012, at.at.y() - 0.1, at.pixelHeight()));
    const double panels = mix(0.58, 0.3, seams) * (1.0 + 0.25 * soot);
    const double concrete = 0.26 * (1.0 + 0.9 * soot);
    const double stripe = coverageBetween(0.85, 1.0, at.at.y(), at.pixelHeight());
    const double wall = mix(mix(panels, 0.22, stripe), concrete, above);
    return mix(wall, 0.05, joint(at.at.x(), at.pixelWidth()));
  }

 private:
  const TextureTiles& tiles_;
};

/// Concrete with the marks of its formwork: along the tunnel, or flat.
class TunnelConcrete : public Material {
 public:
  TunnelConcrete(const TextureTiles& tiles, double tone) : tiles_(tiles), tone_(tone) {}

  double reflectance(const SurfacePoint& point) const override {
    const TexturePoint at = project(point, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX());
    const double soot = tiles_.plaster.at(at) - 0.5;
    const double boards = coveragePeriodic(0.62, 0.012, at.at.y(), at.pixelHeight());
    const double concrete = tone_ * (1.0 + 0.9 * soot - 0.3 * boards);
    return mix(concrete, 0.04, joint(at.at.x(), at.pixelWidth()));
  }

 private:
  const TextureTiles& tiles_;
  double tone_;
};

/// A lit face with a dark mark.
class LitSign : public Material {
 public:
  LitSign(double brightness, double mark_m) : brightness_(brightness), mark_m_(mark_m) {}

  double reflectance(const SurfacePoint& /*point*/) const override { return 0.1; }
  double glow(const SurfacePoint& point) const override {
    const TexturePoint at = faceCoordinates(point);
    const double mark =
        coverageBetween(-mark_m_, mark_m_, at.at.x(), at.pixelWidth()) *
        coverageBetween(1.6 - 0.6 * mark_m_, 1.6 + 0.6 * mark_m_, at.at.y(), at.pixelHeight());
    return brightness_ * (1.0 - 0.8 * mark);
  }

 private:
  double brightness_;
  double mark_m_;
};

StreetStyle tunnelStyle() {
  StreetStyle style;
  style.zones = {{-kHalfWidth_m, kHalfWidth_m, Pavement::kAsphalt}};
  style.markings = {
      {0.0, 0.13, 2.0 * kSegment_m, 4.0}, {-3.6, 0.15, 1.0, 1.0}, {3.6, 0.15, 1.0, 1.0}};
  style.asphalt_contrast = 0.35;
  style.repairs_share = 0.0;
  style.lane_m = kLane_m;
  return style;
}

/// The bodies of the tunnel along its centre line.
class Tube {
 public:
  Tube(const Path& line, const TextureTiles& tiles)
      : line_(line),
        wall_(std::make_shared<TunnelWall>(tiles)),
        ceiling_(std::make_shared<TunnelConcrete>(tiles, 0.2)),
        kerb_(std::make_shared<TunnelConcrete>(tiles, 0.36)),
        dark_(std::make_shared<PlainMaterial>(0.07)) {}

  std::vector<Body> build() {
    const int count = static_cast<int>(line_.length_m() / kSegment_m);
    for (int i = 0; i < count; ++i) {
      add(makeSegment(), i);
      if (i % kLampEvery == 0) add(makeLamps(), i);
      if (i % kSignEvery == 2) add(makeSigns(), i);
      if (i % kDoorEvery == 9) add(makeDoor(), i);
    }
    return std::move(bodies_);
  }

  /// On both sides of the middle of each segment that has them.
  static std::vector<Lamp> lamps(const Path& line) {
    std::vector<Lamp> lamps;
    const int count = static_cast<int>(line.length_m() / kSegment_m);
    for (int i = 0; i < count; i += kLampEvery) {
      const double station = (i + 0.5) * kSegment_m;
      for (const double side : {-1.0, 1.0}) {
        Eigen::Vector3d at = line.position(station) + side * kLamps_m * line.right(station);
        at.y() += kCamera_m + 0.2 - kHeight_m;
        lamps.push_back({at, 8.0});
      }
    }
    return lamps;
  }

 private:
  static constexpr double kLamps_m = 2.4;  // beside the centre line

  void add(Body body, int segment) {
    const double station = (segment + 0.5) * kSegment_m;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = line_.position(station);
    pose.translation().y() += kCamera_m;
    pose.rotate(Eigen::AngleAxisd(line_.heading_rad(station), Eigen::Vector3d::UnitY()));
    body.place(pose);
    bodies_.push_back(std::move(body));
  }

  Body makeSegment() const {
    constexpr double kOverlap_m = 0.04;  // closes the gap at the outside of bends
    constexpr double kHalf_m = 0.5 * kSegment_m + kOverlap_m;
    constexpr double kThick_m = 0.5;
    std::vector<Part> parts = {
        {boxBetween({-kHalfWidth_m - kThick_m, -kHeight_m - kThick_m, -kHalf_m},
                    {kHalfWidth_m + kThick_m, -kHeight_m, kHalf_m}),
         ceiling_}};
    for (const double side : {-1.0, 1.0}) {
      const auto part = [&](double from, double to, double bottom, double top, const auto& what) {
        parts.push_back({boxBetween({std::min(side * from, side * to), -top, -kHalf_m},
                                    {std::max(side * from, side * to), -bottom, kHalf_m}),
                         what});
      };
      part(kHalfWidth_m, kHalfWidth_m + kThick_m, -0.5, kHeight_m, wall_);
      part(kHalfWidth_m - 0.95, kHalfWidth_m, -0.3, 0.16, kerb_);
      part(kHalfWidth_m - 0.12, kHalfWidth_m, 3.3, 3.45, dark_);  // cable tray
      const double corner = 1.1;
      auto haunch = boxBetween(
          {std::min(side * (kHalfWidth_m - corner), side * kHalfWidth_m), -kHeight_m, -kHalf_m},
          {std::max(side * (kHalfWidth_m - corner), side * kHalfWidth_m),
           -kHeight_m + corner,
           kHalf_m});
      haunch->cut({-side, 1.0, 0.0}, {side * (kHalfWidth_m - corner), -kHeight_m, 0.0});
      parts.push_back({haunch, ceiling_});
    }
    return Body(std::move(parts));
  }

  Body makeLamps() const {
    const auto lit = std::make_shared<LitSign>(1.1, 0.0);
    std::vector<Part> parts;
    for (const double side : {-1.0, 1.0}) {
      const double x = side * kLamps_m;
      parts.push_back(
          {boxBetween({x - 0.1, -kHeight_m + 0.08, -0.6}, {x + 0.1, -kHeight_m + 0.14, 0.6}), lit});
      parts.push_back(
          {boxBetween({x - 0.16, -kHeight_m, -0.66}, {x + 0.16, -kHeight_m + 0.08, 0.66}), dark_});
    }
    return Body(std::move(parts));
  }

  /// A box with an arrow of light at each wall.
  Body makeSigns() const {
    const auto lit = std::make_shared<LitSign>(0.75, 0.12);
    std::vector<Part> parts;
    for (const double side : {-1.0, 1.0}) {
      const double near = side * (kHalfWidth_m - 0.08);
      const double wall = side * kHalfWidth_m;
      parts.push_back(
          {boxBetween({std::min(near, wall), -1.75, -0.3}, {std::max(near, wall), -1.45, 0.3}),
           lit});
    }
    return Body(std::move(parts));
  }

  /// An emergency exit on the right.
  Body makeDoor() const {
    return Body({{boxBetween({kHalfWidth_m - 0.04, -2.5, -0.9}, {kHalfWidth_m, 0.0, 0.9}), kerb_},
                 {boxBetween({kHalfWidth_m - 0.06, -2.3, -0.6}, {kHalfWidth_m, 0.0, 0.6}), dark_},
                 {boxBetween({kHalfWidth_m - 0.5, -3.1, -0.04}, {kHalfWidth_m, -2.7, 0.04}),
                  std::make_shared<LitSign>(0.9, 0.0)}});
  }

  const Path& line_;
  std::shared_ptr<const Material> wall_, ceiling_, kerb_, dark_;
  std::vector<Body> bodies_;
};

std::shared_ptr<const ScriptedDrive> drive() {
  std::vector<PathPiece> pieces = {{50.0, 0.0}};
  for (const auto& [angle_rad, radius_m] : {std::pair(0.3, 420.0), std::pair(-0.35, 380.0)}) {
    const auto bend = turn(angle_rad, radius_m, 40.0);
    pieces.insert(pieces.end(), bend.begin(), bend.end());
    pieces.push_back({20.0, 0.0});
  }
  return std::make_shared<ScriptedDrive>(
      layPath(pieces, [](double) { return 0.0; }),
      std::vector<SpeedPhase>{{230.0, kSpeed_mps}, {40.0, 11.0}, {50.0, 11.0}},
      kSpeed_mps,
      Sway());
}

}  // namespace

Scenario tunnel(std::uint64_t seed) {
  constexpr double kSpacing_m = 0.5;
  constexpr double kReach_m = 14.0;
  constexpr double kAmbient = 0.07;
  Scenario scenario;
  const auto along = drive();
  scenario.drive = along;
  scenario.traffic.oncoming_m = -2.0 * kLane_m;
  scenario.traffic.oncoming_mps = 12.0;
  scenario.traffic.leader = false;
  WorldPlan& world = scenario.world;
  const Path line = along->path().beside(-kLane_m, kSpacing_m, kBeyond_m, kBeyond_m);
  world.streets = {line};
  world.drives = {along->path()};
  world.beyond_m = kBeyond_m;
  world.camera_height_m = kCamera_m;
  world.style = tunnelStyle();
  world.light = std::make_shared<Lamps>(Tube::lamps(line), kReach_m, kAmbient);
  world.lighting.lights = 1.0;
  world.under_sky = false;
  world.furniture = [line](const TextureTiles& tiles) { return Tube(line, tiles).build(); };
  world.seed = seed;
  return scenario;
}

}  // namespace rotrocc
