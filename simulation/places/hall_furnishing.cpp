#include "simulation/places/hall_furnishing.h"

#include <cmath>
#include <memory>
#include <utility>

#include "simulation/places/furnisher.h"
#include "simulation/places/interior.h"

namespace rotrocc {
namespace {

constexpr double kLamps_m = 5.3;  // height

Eigen::Isometry3d poseAt(double x, double height, double z, double heading_rad = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << x, -height, z;
  pose.rotate(Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitY()));
  return pose;
}

class Furnishing {
 public:
  Furnishing(const Drive& drive, const TextureTiles& tiles, std::uint64_t seed)
      : furnisher_(drive), tiles_(tiles), random_(seed, 0x4A11) {}

  std::vector<Body> build() {
    addShell();
    addLamps();
    addCeiling();
    addPillars();
    addDoors();
    addShelves();
    addMachines();
    addStacks();
    addNotices();
    return furnisher_.takeBodies();
  }

 private:
  std::shared_ptr<Material> coat(double tone, double contrast = 0.4) const {
    return std::make_shared<Coated>(tiles_, tone, contrast);
  }

  void addShell() {
    const Eigen::Vector3d low(HallWalls::kLeft_m, -HallWalls::kHeight_m, HallWalls::kBack_m);
    const Eigen::Vector3d high(HallWalls::kRight_m, 1.0, HallWalls::kFront_m);
    furnisher_.fix(Body({{boxBetween(low, high), std::make_shared<HallShell>(tiles_, 3.6, 4.8)}}),
                   Eigen::Isometry3d::Identity(),
                   0.0);
  }

  void addLamps() {
    for (const Lamp& lamp : hallLamps()) {
      const Eigen::Vector3d& at = lamp.position;
      Body body(
          {{boxBetween({-0.06, -0.06, -0.75}, {0.06, 0.0, 0.75}), std::make_shared<LitTube>()},
           {boxBetween({-0.12, -0.12, -0.78}, {0.12, -0.06, 0.78}), coat(0.7)},
           {boxBetween({-0.01, at.y() * -1.0 - HallWalls::kHeight_m, -0.01}, {0.01, -0.12, 0.01}),
            coat(0.2)}});
      furnisher_.fix(std::move(body), poseAt(at.x(), kLamps_m, at.z()), 0.3);
    }
  }

  /// Beams across the hall, a crane rail, and pipes along it.
  void addCeiling() {
    const double width = HallWalls::kRight_m - HallWalls::kLeft_m;
    for (double z = HallWalls::kBack_m + 4.0; z < HallWalls::kFront_m - 1.0; z += 4.0) {
      Body beam({{boxBetween({0.0, -0.05, -0.12}, {width, 0.0, 0.12}), coat(0.45)},
                 {boxBetween({0.0, -0.4, -0.02}, {width, -0.05, 0.02}), coat(0.4)}});
      furnisher_.fix(
          std::move(beam), poseAt(HallWalls::kLeft_m, HallWalls::kHeight_m - 0.4, z), 0.3);
    }
    for (const double x : {-6.6, -2.4, 2.9, 6.8}) {
      const double radius = random_.uniform(0.05, 0.22);
      const double half = 0.5 * (HallWalls::kFront_m - HallWalls::kBack_m);
      Body pipe({{std::make_shared<Cylinder>(2, Eigen::Vector3d(0.0, 0.0, half), radius, half),
                  coat(random_.uniform(0.35, 0.7))}});
      furnisher_.fix(std::move(pipe),
                     poseAt(x, HallWalls::kHeight_m - 0.45 - radius, HallWalls::kBack_m),
                     0.3);
    }
  }

  void addPillars() {
    for (const double x : {HallWalls::kLeft_m + 0.12, -2.9, 2.9, HallWalls::kRight_m - 0.12}) {
      for (double z = HallWalls::kBack_m + 4.0; z < HallWalls::kFront_m - 1.0; z += 4.0) {
        const bool at_wall = std::abs(x) > 5.0;
        if (!at_wall && std::fmod(z - HallWalls::kBack_m, 8.0) > 1.0) continue;
        const double half = at_wall ? 0.12 : 0.2;
        Body pillar({{boxBetween({-half, -HallWalls::kHeight_m + 0.4, -half}, {half, 0.2, half}),
                      std::make_shared<Hazard>(tiles_, 0.5, 1.4)}});
        furnisher_.stand(std::move(pillar), {x, z}, 0.0, at_wall ? 0.25 : 0.8);
      }
    }
  }

  /// A gate at the back, a door beside it and one in the front wall.
  void addDoors() {
    Body gate({{boxBetween({-2.0, -4.2, 0.0}, {2.0, 0.1, 0.06}),
                std::make_shared<TexturedMaterial>(tiles_.roof_tiles, 0.5, 0.25)},
               {boxBetween({-2.15, -4.35, -0.01}, {2.15, -4.2, 0.1}), coat(0.15)},
               {boxBetween({-2.15, -4.2, -0.01}, {-2.0, 0.1, 0.1}), coat(0.15)},
               {boxBetween({2.0, -4.2, -0.01}, {2.15, 0.1, 0.1}), coat(0.15)}});
    furnisher_.fix(std::move(gate), poseAt(-1.2, 0.0, HallWalls::kBack_m), 0.2);
    for (const double x : {4.5, -5.5}) {
      Body door({{boxBetween({-0.5, -2.1, -0.04}, {0.5, 0.1, 0.04}), coat(0.25)},
                 {boxBetween({-0.42, -1.75, -0.05}, {0.42, -1.1, 0.05}), coat(0.6, 0.1)},
                 {boxBetween({0.36, -1.05, -0.1}, {0.42, -0.98, 0.1}), coat(0.7, 0.0)},
                 {boxBetween({-0.58, -2.18, -0.03}, {0.58, 0.1, 0.03}), coat(0.75)}});
      furnisher_.fix(
          std::move(door), poseAt(x, 0.0, x > 0.0 ? HallWalls::kFront_m : HallWalls::kBack_m), 0.2);
    }
  }

  /// Uprights and boards along x, open to -z and +z, with cartons on the boards.
  Body makeShelf(double width, double depth) {
    constexpr double kHeight = 2.9;
    std::vector<Part> parts;
    const double half = 0.5 * width;
    const double back = 0.5 * depth;
    for (const double x : {-half, half - 0.07}) {
      for (const double z : {-back, back - 0.07}) {
        parts.push_back({boxBetween({x, -kHeight, z}, {x + 0.07, 0.1, z + 0.07}), coat(0.24)});
      }
    }
    for (const double level : {0.12, 0.95, 1.8}) {
      parts.push_back({boxBetween({-half, -level - 0.1, -back}, {half, -level, back}), coat(0.5)});
      for (double x = -half + 0.12; x < half - 0.5;) {
        const double w = random_.uniform(0.25, 0.6);
        const double h = random_.uniform(0.2, 0.62);
        const double d = random_.uniform(0.6, 0.95) * back;
        const Eigen::Vector3d low(x, -level - 0.1 - h, -d);
        const Eigen::Vector3d high(std::min(x + w, half - 0.1), -level - 0.1, d);
        if (random_.chance(0.85)) {
          parts.push_back({boxBetween(low, high),
                           std::make_shared<Carton>(tiles_, 0.5 * (low + high), random_)});
        }
        x += w + random_.uniform(0.02, 0.2);
      }
    }
    return Body(std::move(parts));
  }

  void addShelves() {
    for (double z = HallWalls::kBack_m + 1.6; z < HallWalls::kFront_m - 2.0; z += 2.9) {
      if (random_.chance(0.2)) continue;
      furnisher_.stand(makeShelf(2.6, 0.9), {HallWalls::kRight_m - 0.6, z}, 0.5 * M_PI, 0.8);
    }
    for (double x = -6.0; x < 7.0; x += 2.8) {
      if (random_.chance(0.3)) continue;
      furnisher_.stand(makeShelf(2.5, 0.8), {x, HallWalls::kFront_m - 0.5}, 0.0, 0.8);
    }
  }

  Body makeMachine() {
    const double half = random_.uniform(0.6, 1.1);
    const double depth = random_.uniform(0.4, 0.7);
    const double height = random_.uniform(1.2, 2.1);
    const double tone =
        random_.chance(0.5) ? random_.uniform(0.45, 0.7) : random_.uniform(0.15, 0.3);
    auto housing = boxBetween({-half, -height, -depth}, {half, -0.1, depth});
    housing->cut({0.0, -1.0, -1.0}, {0.0, -height + 0.2, -depth});
    std::vector<Part> parts = {
        {housing, coat(tone)},
        {boxBetween({-half - 0.06, -0.12, -depth - 0.06}, {half + 0.06, 0.1, depth + 0.06}),
         coat(0.12)},
        {boxBetween({-0.6 * half, -0.8 * height, -depth - 0.03},
                    {0.1 * half, -0.45 * height, depth}),
         std::make_shared<ControlPanel>(
             tiles_,
             0.5 * tone + 0.2,
             randomBits(static_cast<std::uint64_t>(random_.index(1 << 30))))},
        {boxBetween({0.3 * half, -0.7 * height, -depth - 0.02},
                    {0.9 * half, -0.25 * height, depth}),
         coat(0.08, 0.1)}};
    const double radius = random_.uniform(0.15, 0.3);
    parts.push_back({std::make_shared<Cylinder>(
                         1, Eigen::Vector3d(0.5 * half, -height - 0.3, 0.0), radius, 0.35),
                     coat(random_.uniform(0.3, 0.7))});
    return Body(std::move(parts));
  }

  void addMachines() {
    for (int i = 0; i < 14; ++i) {
      const Eigen::Vector2d at(
          random_.uniform(HallWalls::kLeft_m + 1.5, HallWalls::kRight_m - 2.0),
          random_.uniform(HallWalls::kBack_m + 1.0, HallWalls::kFront_m - 1.5));
      furnisher_.stand(makeMachine(), at, 0.5 * M_PI * random_.index(4), 0.9);
    }
  }

  /// A pallet with cartons, each standing on others.
  Body makeStack() {
    std::vector<Part> parts = {{boxBetween({-0.6, -0.14, -0.4}, {0.6, 0.1, 0.4}),
                                std::make_shared<TexturedMaterial>(tiles_.bark, 0.34, 0.5)}};
    double top = 0.14;
    const int layers = 1 + random_.index(3);
    for (int layer = 0; layer < layers; ++layer) {
      const double height = random_.uniform(0.3, 0.55);
      const double split = random_.uniform(-0.2, 0.2);
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d low(side < 0.0 ? -0.57 : split + 0.01, -top - height, -0.37);
        const Eigen::Vector3d high(side < 0.0 ? split - 0.01 : 0.57, -top, 0.37);
        parts.push_back(
            {boxBetween(low, high), std::make_shared<Carton>(tiles_, 0.5 * (low + high), random_)});
      }
      top += height;
    }
    return Body(std::move(parts));
  }

  void addStacks() {
    for (int i = 0; i < 24; ++i) {
      const Eigen::Vector2d at(
          random_.uniform(HallWalls::kLeft_m + 0.8, HallWalls::kRight_m - 1.6),
          random_.uniform(HallWalls::kBack_m + 0.8, HallWalls::kFront_m - 1.2));
      furnisher_.stand(makeStack(), at, random_.uniform(-M_PI, M_PI), 0.8);
    }
  }

  void addNotices() {
    for (int i = 0; i < 26; ++i) {
      const double half = random_.uniform(0.15, 0.5);
      const double height = random_.uniform(1.45, 2.6);
      const Eigen::Vector3d middle(0.0, -height, 0.0);
      Body board(
          {{boxBetween({-half, -height - 0.7 * half, -0.015}, {half, -height + 0.7 * half, 0.015}),
            std::make_shared<Notice>(tiles_, middle, random_)}});
      const bool long_wall = random_.chance(0.7);
      const double along =
          long_wall ? random_.uniform(HallWalls::kBack_m + 1.0, HallWalls::kFront_m - 1.0)
                    : random_.uniform(HallWalls::kLeft_m + 1.0, HallWalls::kRight_m - 1.0);
      const bool far = random_.chance(0.35);
      const double x = long_wall ? (far ? HallWalls::kRight_m : HallWalls::kLeft_m) : along;
      const double z = long_wall ? along : (far ? HallWalls::kFront_m : HallWalls::kBack_m);
      const double heading = long_wall ? (far ? 0.5 : -0.5) * M_PI : (far ? 0.0 : M_PI);
      furnisher_.fix(std::move(board), poseAt(x, 0.0, z, heading), 0.3);
    }
  }

  Furnisher furnisher_;
  const TextureTiles& tiles_;
  RandomStream random_;
};

}  // namespace

std::vector<Lamp> hallLamps() {
  std::vector<Lamp> lamps;
  for (const double x : {-5.2, 0.0, 5.2}) {
    for (double z = HallWalls::kBack_m + 2.0; z < HallWalls::kFront_m; z += 4.0) {
      lamps.push_back({{x, -kLamps_m + 0.05, z}, 8.5});
    }
  }
  return lamps;
}

std::vector<Body> furnishHall(const Drive& drive, const TextureTiles& tiles, std::uint64_t seed) {
  return Furnishing(drive, tiles, seed).build();
}

}  // namespace rotrocc
