#include "simulation/scene/ground_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "simulation/rows.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kSampling_m = 2.0;
constexpr double kReach_m = 50.0;     // lateral distance below which a place counts as visited
constexpr double kOwn_m = 20.0;       // closer places have the height of this visit only
constexpr double kClearance_m = 0.4;  // clearance of the camera over the corners of its cell
constexpr double kReturn_m = 80.0;    // least distance along the path between two visits
constexpr double kStep_m = 0.05;      // smaller changes of height are ignored
constexpr double kStage_m = 20.0;     // interval between changes

/// A point of a path: (x, z) and the height.
struct Sample {
  Eigen::Vector2d at;
  double height;
  double station_m;
};

/// A section of the camera path near a place: samples `first` to `last`.
struct Visit {
  std::size_t first, last;
  double distance_m;  // minimum
};

void append(const Path& path, double beyond_m, std::vector<Sample>& samples) {
  for (double s = -beyond_m; s < path.length_m() + beyond_m + kSampling_m; s += kSampling_m) {
    const Eigen::Vector3d position = path.position(s);
    samples.push_back({{position.x(), position.z()}, position.y(), s});
  }
}

/// Height of the ground by place and time.
class Surveyor {
 public:
  Surveyor(const GroundGrid& grid,
           const Path& path,
           double beyond_m,
           const std::vector<Path>& others,
           double below_m)
      : path_(path), neighbour_m_(grid.cell_m * std::sqrt(2.0)), below_m_(below_m) {
    append(path, beyond_m, samples_);
    own_ = samples_.size();
    for (const Path& other : others) append(other, 0.0, samples_);
  }

  std::vector<Visit> visits(const Eigen::Vector2d& place) const {
    std::vector<Visit> visits;
    for (std::size_t i = 0; i < own_; ++i) {
      const double distance = (samples_[i].at - place).norm();
      if (distance > kReach_m) continue;
      if (visits.empty() ||
          samples_[i].station_m - samples_[visits.back().last].station_m > kReturn_m) {
        visits.push_back({i, i, distance});
      }
      visits.back().last = i;
      visits.back().distance_m = std::min(visits.back().distance_m, distance);
    }
    return visits;
  }

  /// Height of the ground at a place: weighted mean of the samples, by distance. Away from the path
  /// of a visit, samples of other visits and paths contribute as well.
  double height(const Eigen::Vector2d& place, const Visit& visit) const {
    double height = below_m_ + meanHeight(place, visit);
    // Keeps the camera above the ground where recorded heights rise faster than any road.
    for (std::size_t i = visit.first; i <= visit.last; ++i) {
      if ((samples_[i].at - place).squaredNorm() > neighbour_m_ * neighbour_m_) continue;
      height = std::max(height, samples_[i].height + kClearance_m);
    }
    return height;
  }

  /// The same at places that are not visited.
  double remoteHeight(const Eigen::Vector2d& place) const {
    return below_m_ + meanHeight(place, {0, 0, std::numeric_limits<double>::infinity()});
  }

  /// A station between two visits where a place is (farthest) behind the camera.
  double changeBetween(const Visit& before,
                       const Visit& after,
                       const Eigen::Vector2d& place) const {
    const double end = samples_[after.first].station_m;
    double best = samples_[before.last].station_m;
    double best_ahead = std::numeric_limits<double>::infinity();
    for (double s = kStage_m * std::ceil(best / kStage_m); s < end; s += kStage_m) {
      const Eigen::Vector3d position = path_.position(s);
      const Eigen::Vector3d direction = path_.direction(s);
      const Eigen::Vector2d offset = place - Eigen::Vector2d(position.x(), position.z());
      const double ahead = offset.dot(Eigen::Vector2d(direction.x(), direction.z()).normalized());
      // Bodies there are within 20 m; allows for the rotation of the camera within a frame.
      if (ahead + 20.0 + 0.25 * offset.norm() < 0.0) return s;
      if (ahead >= best_ahead) continue;
      best = s;
      best_ahead = ahead;
    }
    return best;
  }

 private:
  double meanHeight(const Eigen::Vector2d& place, const Visit& visit) const {
    const double others = smoothStep(kOwn_m, kReach_m, visit.distance_m);
    double sum = 0.0;
    double weights = 0.0;
    const auto add = [&](std::size_t first, std::size_t end, double share) {
      for (std::size_t i = first; i < end && share > 0.0; ++i) {
        const double nearness = 1.0 / ((samples_[i].at - place).squaredNorm() + 4.0);
        const double weight = share * nearness * nearness;
        sum += weight * samples_[i].height;
        weights += weight;
      }
    };
    add(0, visit.first, others);
    add(visit.first, visit.last + 1, 1.0);
    add(visit.last + 1, samples_.size(), others);
    return sum / weights;
  }

  const Path& path_;
  double neighbour_m_;
  double below_m_;
  std::vector<Sample> samples_;  // of the path of the camera, then of the others
  std::size_t own_ = 0;
};

}  // namespace

GroundHistory::GroundHistory(const GroundGrid& grid,
                             const Path& path,
                             double beyond_m,
                             const std::vector<Path>& others,
                             double below_m)
    : first_(static_cast<std::size_t>(grid.columns + 1) * (grid.rows + 1)) {
  const Surveyor surveyor(grid, path, beyond_m, others, below_m);
  std::vector<std::vector<Change>> changes(static_cast<std::size_t>(grid.rows) + 1);
  forEachRow(grid.rows + 1, [&](int row) {
    for (int column = 0; column <= grid.columns; ++column) {
      const std::size_t corner = static_cast<std::size_t>(row) * (grid.columns + 1) + column;
      const Eigen::Vector2d place = grid.origin + grid.cell_m * Eigen::Vector2d(column, row);
      const std::vector<Visit> visits = surveyor.visits(place);
      double height =
          visits.empty() ? surveyor.remoteHeight(place) : surveyor.height(place, visits.front());
      first_[corner] = height;
      for (std::size_t i = 1; i < visits.size(); ++i) {
        const double next = surveyor.height(place, visits[i]);
        if (std::abs(next - height) < kStep_m) continue;
        height = next;
        const double station = surveyor.changeBetween(visits[i - 1], visits[i], place);
        changes[static_cast<std::size_t>(row)].push_back({station, corner, height});
      }
    }
  });
  for (const auto& row : changes) changes_.insert(changes_.end(), row.begin(), row.end());
  std::sort(changes_.begin(), changes_.end(), [](const Change& a, const Change& b) {
    return std::tie(a.station_m, a.corner) < std::tie(b.station_m, b.corner);
  });
}

GroundHistory::GroundHistory(const GroundGrid& grid,
                             const std::function<double(double, double)>& height) {
  for (int row = 0; row <= grid.rows; ++row) {
    for (int column = 0; column <= grid.columns; ++column) {
      first_.push_back(
          height(grid.origin.x() + grid.cell_m * column, grid.origin.y() + grid.cell_m * row));
    }
  }
}

std::size_t GroundHistory::stage(double station_m) const {
  const auto after = std::partition_point(
      changes_.begin(), changes_.end(), [&](const Change& c) { return c.station_m < station_m; });
  return static_cast<std::size_t>(after - changes_.begin());
}

std::vector<double> GroundHistory::heights(std::size_t stage) const {
  std::vector<double> heights = first_;
  for (std::size_t i = 0; i < stage; ++i) heights[changes_[i].corner] = changes_[i].height;
  return heights;
}

}  // namespace rotrocc
