#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "simulation/counter_random.h"
#include "simulation/drives/scenario.h"

namespace rotrocc {
namespace {

// The inside of the walls; the flight starts at the origin, and the ground is at y = 0.
const Eigen::AlignedBox3d kRoom(Eigen::Vector3d(-8.0, -6.0, -3.0), Eigen::Vector3d(8.0, 0.5, 21.0));

/// Two points at one place are a hover.
Trajectory flight() {
  const struct {
    double time_s;
    double x, height, z;
    double yaw_deg;  // positive to the right
  } points[] = {{0.0, 0.0, 0.25, 0.0, 0.0},
                {1.0, 0.0, 0.25, 0.0, 0.0},  // take-off
                {3.2, 0.0, 1.5, 0.0, 0.0},
                {5.0, 0.0, 1.5, 0.0, 0.0},
                {8.6, 0.3, 1.7, 7.5, 0.0},
                {9.2, 0.3, 1.7, 7.5, 0.0},  // turn of 100 deg/s
                {9.8, 0.3, 1.7, 7.5, 60.0},
                {10.4, 0.3, 1.7, 7.5, 120.0},
                {11.0, 0.3, 1.7, 7.5, 180.0},
                {11.5, 0.3, 1.7, 7.5, 180.0},
                {14.1, -4.5, 2.0, 3.0, 225.0},
                {16.1, -7.2, 1.8, 1.6, 325.0},
                {17.7, -7.3, 1.7, 4.5, 330.0},
                {20.7, -7.3, 1.6, 11.5, 335.0},  // along the wall
                {22.8, -5.0, 2.4, 15.5, 375.0},
                {25.1, 0.0, 3.0, 17.2, 460.0},
                {27.3, 4.2, 2.2, 13.0, 540.0},
                {29.5, 4.6, 1.5, 7.0, 540.0},
                {31.0, 4.6, 1.5, 7.0, 540.0}};
  constexpr double kDegree = M_PI / 180.0;
  Trajectory trajectory;
  for (const auto& point : points) {
    StampedPose pose;
    pose.stamp_ns = std::llround(1e9 * point.time_s);
    pose.T_world_body.translation() << point.x, -point.height, point.z;
    pose.T_world_body.rotate(Eigen::AngleAxisd(point.yaw_deg * kDegree, Eigen::Vector3d::UnitY()));
    pose.T_world_body.rotate(Eigen::AngleAxisd(-6.0 * kDegree, Eigen::Vector3d::UnitX()));
    trajectory.push_back(pose);
  }
  return trajectory;
}

/// Fills the hall with what stays clear of the flight.
class Furnishing {
 public:
  Furnishing(const Drive& drive, const TextureTiles& tiles, std::uint64_t seed)
      : tiles_(tiles), random_(seed, 0x4A11) {
    for (double time_s = 0.0; time_s < drive.duration_s(); time_s += 0.05) {
      way_.push_back(drive.pose(time_s).translation());
    }
  }

  std::vector<Body> build() {
    add(kRoom, tiles_.bricks);
    for (double z = kRoom.min().z() + 2.0; z < kRoom.max().z(); z += 3.0) {
      add({Eigen::Vector3d(kRoom.min().x(), -6.0, z),
           Eigen::Vector3d(kRoom.max().x(), -5.6, z + 0.3)},
          tiles_.roof_tiles);  // a beam
    }
    for (int i = 0; i < 90; ++i) addStack();
    for (int i = 0; i < 60; ++i) addNotice();
    return std::move(bodies_);
  }

 private:
  void add(const Eigen::AlignedBox3d& box, const Texture& texture) {
    const double contrast = random_.uniform(0.4, 0.8);
    const double mean = random_.uniform(0.3, 0.6);
    bodies_.push_back(Body({{std::make_shared<ConvexSolid>(box),
                             std::make_shared<TexturedMaterial>(texture, mean, contrast)}}));
  }

  const Texture& anyTexture() {
    const Texture* const textures[] = {
        &tiles_.writing, &tiles_.leaves, &tiles_.bark, &tiles_.asphalt, &tiles_.paving};
    return *textures[random_.index(5)];
  }

  /// Boxes on each other, where there is room for them.
  void addStack() {
    Eigen::Vector3d half = Eigen::Vector3d::Zero();
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (const int axis : {2, 0}) half[axis] = random_.uniform(0.25, 0.7);
    for (const int axis : {2, 0}) {
      at[axis] = random_.uniform(kRoom.min()[axis] + 0.8, kRoom.max()[axis] - 0.8);
    }
    const int boxes = 1 + random_.index(4);
    std::vector<Eigen::AlignedBox3d> stack;
    double top = -0.1;  // height; the lowest stands in the ground
    for (int i = 0; i < boxes; ++i) {
      const double height = random_.uniform(0.35, 0.8);
      stack.push_back({at - half - Eigen::Vector3d(0.0, top + height, 0.0),
                       at + half - Eigen::Vector3d(0.0, top, 0.0)});
      top += height;
    }
    const Eigen::AlignedBox3d all = stack.front().merged(stack.back());
    if (isInTheWay(all)) return;
    taken_.push_back(all);
    for (const Eigen::AlignedBox3d& box : stack) add(box, anyTexture());
    bodies_.back().contact_shadow = true;
  }

  /// A board on a wall.
  void addNotice() {
    constexpr double kThickness_m = 0.02;
    const double width = random_.uniform(0.3, 1.6);
    const double height = random_.uniform(0.4, 1.2);
    const int axis = random_.chance(0.6) ? 2 : 0;  // along the wall
    const int across = 2 - axis;
    const bool high = random_.chance(0.5);
    Eigen::Vector3d low;
    low.y() = -random_.uniform(1.5, 5.0);
    low[axis] = random_.uniform(kRoom.min()[axis], kRoom.max()[axis] - width);
    low[across] = high ? kRoom.max()[across] - kThickness_m : kRoom.min()[across];
    Eigen::Vector3d size(0.0, height, 0.0);
    size[axis] = width;
    size[across] = kThickness_m;
    add({low, low + size}, anyTexture());
  }

  bool isInTheWay(const Eigen::AlignedBox3d& box) const {
    constexpr double kClearance_m = 0.8;
    return std::any_of(taken_.begin(),
                       taken_.end(),
                       [&](const Eigen::AlignedBox3d& other) { return other.intersects(box); }) ||
           std::any_of(way_.begin(), way_.end(), [&](const Eigen::Vector3d& position) {
             return box.exteriorDistance(position) < kClearance_m;
           });
  }

  std::vector<Eigen::Vector3d> way_;
  const TextureTiles& tiles_;
  RandomStream random_;
  std::vector<Eigen::AlignedBox3d> taken_;
  std::vector<Body> bodies_;
};

}  // namespace

Scenario hall(std::uint64_t seed) {
  Scenario scenario;
  scenario.drive = std::make_shared<RecordedDrive>(flight());
  scenario.traffic.oncoming_mps = 0.0;
  scenario.traffic.leader = false;
  WorldPlan& world = scenario.world;
  world.indoors = true;
  world.lighting.sun = 0.0;
  world.lighting.ambient = 0.9;
  world.streets = {Path({{0.0, 0.0, kRoom.min().z()}, {0.0, 0.0, kRoom.max().z()}})};
  world.drives = {scenario.drive->path()};
  world.style.zones = {{kRoom.min().x(), kRoom.max().x(), Pavement::kSlabs}};
  world.furniture = [drive = scenario.drive, seed](const TextureTiles& tiles) {
    return Furnishing(*drive, tiles, seed).build();
  };
  world.seed = seed;
  return scenario;
}

}  // namespace rotrocc
