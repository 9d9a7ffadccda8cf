#include "simulation/places/interior.h"

#include <algorithm>
#include <cmath>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

TexturePoint movedBy(const TexturePoint& at,
                     const Eigen::Vector3d& centre,
                     const SurfacePoint& point) {
  return shifted(at, faceCoordinates(centre, point.normal));
}

/// Stains of some metres, and grain that shows at half a metre; about -0.5 to 0.5.
double stains(const TextureTiles& tiles, const TexturePoint& at) {
  return 0.55 * (tiles.plaster.at(at) - 0.5) + 0.45 * (tiles.asphalt.at(scaled(at, 4.3)) - 0.5) +
         0.5 * (tiles.blotches.at(scaled(at, 0.21)) - 0.5);
}

}  // namespace

double HallShell::reflectance(const SurfacePoint& point) const {
  const TexturePoint at = faceCoordinates(point);
  if (point.normal.y() > 0.5) return ceiling(at);
  const double brightness = wall(at);
  if (point.normal.x() < 0.5) return brightness;
  const double frame =
      coverageBetween(window_low_m_ - 0.08, window_high_m_ + 0.08, at.at.y(), at.pixelHeight());
  return mix(mix(brightness, 0.3, frame), 0.05, panes(at));
}

double HallShell::glow(const SurfacePoint& point) const {
  if (point.normal.x() < 0.5) return 0.0;
  const TexturePoint at = faceCoordinates(point);
  const double clouds = tiles_.blotches.at(scaled(at, 0.13));
  return panes(at) * (0.75 + 0.5 * (clouds - 0.5));
}

double HallShell::panes(const TexturePoint& at) const {
  return coverageBetween(window_low_m_, window_high_m_, at.at.y(), at.pixelHeight()) *
         coveragePeriodic(1.2, 1.12, at.at.x(), at.pixelWidth()) *
         (1.0 -
          coverageBetween(
              -0.03, 0.03, at.at.y() - 0.5 * (window_low_m_ + window_high_m_), at.pixelHeight()));
}

double HallShell::wall(const TexturePoint& at) const {
  constexpr double kBand_m = 1.3;
  const double above = coverageAbove(kBand_m, at.at.y(), at.pixelHeight());
  const double line = coverageBetween(kBand_m, kBand_m + 0.05, at.at.y(), at.pixelHeight());
  const double joint = coveragePeriodic(3.0, 0.012, at.at.x(), at.pixelWidth());
  const double scuffs = mix(0.9, 0.5, above);
  const double paint = mix(0.36, 0.66, above) * (1.0 + scuffs * stains(tiles_, at));
  const double foot = 1.0 - coverageAbove(0.12, at.at.y(), at.pixelHeight());
  return mix(mix(mix(paint, 0.16, line), 0.5 * paint, joint), 0.14, foot);
}

double HallShell::ceiling(const TexturePoint& at) const {
  const double ridge = coveragePeriodic(0.28, 0.11, at.at.x(), at.pixelWidth());
  const double seam = coveragePeriodic(5.6, 0.02, at.at.y(), at.pixelHeight());
  const double sheet = 0.55 * (1.0 + 0.35 * stains(tiles_, at));
  return mix(mix(sheet, 0.7 * sheet, ridge), 0.3, seam);
}

double HallFloor::reflectance(const SurfacePoint& point) const {
  const TexturePoint at = project(point, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
  const double x = at.at.x();
  const double z = at.at.y();
  const double grain = tiles_.asphalt.at(scaled(at, 3.0)) - 0.47;
  double floor = 0.4 * (1.0 + 0.5 * grain + 0.6 * stains(tiles_, at));
  const double joints = std::min(1.0,
                                 coveragePeriodic(4.0, 0.012, x - 0.6, at.pixelWidth()) +
                                     coveragePeriodic(4.0, 0.012, z - 1.7, at.pixelHeight()));
  floor = mix(floor, 0.12, joints);
  const double side = std::abs(x);
  const double lanes = coverageBetween(2.45, 2.55, side, at.pixelWidth()) +
                       coverageBetween(5.9, 6.0, side, at.pixelWidth()) *
                           coveragePeriodic(1.5, 0.9, z, at.pixelHeight());
  const double worn = 0.5 + 0.5 * smoothStep(0.35, 0.55, tiles_.asphalt.at(scaled(at, 0.7)));
  return mix(floor, 0.75, worn * std::min(1.0, lanes));
}

double Coated::reflectance(const SurfacePoint& point) const {
  return tone_ * (1.0 + contrast_ * stains(tiles_, faceCoordinates(point)));
}

double Hazard::reflectance(const SurfacePoint& point) const {
  const TexturePoint at = faceCoordinates(point);
  const double width = std::hypot(at.pixelWidth(), at.pixelHeight());
  const double stripes = coveragePeriodic(0.34, 0.17, at.at.x() + at.at.y(), width);
  const double marked = 1.0 - coverageAbove(top_m_, at.at.y(), at.pixelHeight());
  return mix(coat_.reflectance(point), mix(0.06, 0.7, stripes), marked);
}

Carton::Carton(const TextureTiles& tiles, const Eigen::Vector3d& centre, RandomStream& random)
    : tiles_(tiles),
      centre_(centre),
      tone_(random.uniform(0.26, 0.55)),
      line_(random.index(8)),
      label_(random.uniform(-0.1, 0.1), random.uniform(-0.06, 0.06)),
      label_m_(random.uniform(0.06, 0.14)) {}

double Carton::reflectance(const SurfacePoint& point) const {
  const TexturePoint place = faceCoordinates(point);
  const TexturePoint at = movedBy(place, centre_, point);
  const double width = at.pixelWidth();
  const double height = at.pixelHeight();
  const double board = tone_ * (1.0 + 0.5 * stains(tiles_, place));
  const double tape = coverageBetween(-0.025, 0.025, at.at.x(), width);
  double brightness = mix(board, 0.75 * board + 0.1, tape);
  const TexturePoint label = shifted(at, label_);
  const double paper = coverageBetween(-label_m_, label_m_, label.at.x(), width) *
                       coverageBetween(-0.4 * label_m_, 0.4 * label_m_, label.at.y(), height);
  TexturePoint words = scaled(label, 0.5 / label_m_);
  words.at += Eigen::Vector2d(0.5, 0.125 * (line_ + 0.5));
  const double ink = tiles_.writing.at(words);
  return mix(brightness, mix(0.85, 0.08, ink), paper);
}

double ControlPanel::reflectance(const SurfacePoint& point) const {
  const TexturePoint at = faceCoordinates(point);
  const double width = at.pixelWidth();
  const double height = at.pixelHeight();
  constexpr double kField_m = 0.12;
  const auto cell = [&](int axis) {
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>(std::floor(at.at[axis] / kField_m)));
  };
  const double tone = randomUniform(key_, cell(0), cell(1));
  const double resolved = 1.0 - smoothStep(0.3, 0.6, std::max(width, height) / kField_m);
  const double shape = coveragePeriodic(kField_m, 0.07, at.at.x() - 0.02, width) *
                       coveragePeriodic(kField_m, 0.05, at.at.y() - 0.03, height);
  const double coat = tone_ * (1.0 + 0.3 * stains(tiles_, at));
  const double seams = coveragePeriodic(0.72, 0.008, at.at.x(), width);
  const double instrument = mix(0.3, tone > 0.45 ? 0.04 + 0.9 * (tone - 0.45) : tone_, resolved);
  return mix(mix(coat, 0.06, seams), instrument, shape);
}

Notice::Notice(const TextureTiles& tiles, const Eigen::Vector3d& centre, RandomStream& random)
    : tiles_(tiles),
      centre_(centre),
      board_(random.chance(0.7) ? random.uniform(0.7, 0.85) : random.uniform(0.1, 0.3)),
      ink_(board_ > 0.5 ? 0.08 : 0.8),
      line_m_(random.uniform(0.05, 0.14)),
      picture_(random.chance(0.35)) {}

double Notice::reflectance(const SurfacePoint& point) const {
  const TexturePoint at = movedBy(faceCoordinates(point), centre_, point);
  if (picture_) {
    const double shades = tiles_.leaves.at(scaled(at, 1.7));
    return 0.1 + 0.7 * smoothStep(0.2, 0.8, shades);
  }
  return mix(board_, ink_, tiles_.writing.at(scaled(at, 0.125 / line_m_)));
}

}  // namespace rotrocc
