#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "check/rig_causes.h"
#include "check/windows.h"

namespace rotrocc {

/// A turn of the right camera about x or y, and a shift of its principal point, are the same in the
/// middle of the image; only the shape of their errors elsewhere differs, and lenses have such
/// shapes, too.
enum class TurnOrShift { kEither, kTurn, kShift };

struct RigModel {
  RigCauses causes = {};
  /// The same, but kOffset and kBias are in the middle of the image, with what pitch and yaw do
  /// there, unless these are all of it.
  RigCauses values = {};
  RigCauses sigmas = {};  ///< of values
  /// The causes that a calibration of the right camera can correct, and that cost something; not
  /// shapes that may be those of lenses, unless they must be fixed.
  RigCauses correctable = {};
  /// What one unit of each value does to the scale, as the error of all disparities that would do
  /// the same, and to rows, root mean square [px].
  std::array<Eigen::Vector2d, kRigCauses> effects_px = {};
  TurnOrShift vertical = TurnOrShift::kEither;    ///< pitch or offset
  TurnOrShift horizontal = TurnOrShift::kEither;  ///< yaw or bias
  double typical_disparity_px = 0.0;              ///< corrected one of the mean depth
  double fix_rows_px = 0.0;                       ///< rows to be fixed: a share of the detail
  /// By how much rows and flows fit better in windows that the calibration by the other windows
  /// corrects: sums of squares over noise. What does not repeat itself is worth nothing.
  Estimate rows_gain, flow_gain;

  Estimate value(RigCause cause) const { return {values[cause], sigmas[cause]}; }

  /// How many times its limit of what needs fixing an effect on disparities and rows is.
  double severityOf(const Eigen::Vector2d& effect_px) const;

  /// That of a value; with its uncertainty, also if it was left out.
  Estimate severity(RigCause cause) const;

  /// Whether it is more than a limit for certain.
  bool exceeds(double limit, RigCause cause) const { return severity(cause).certain() > limit; }
};

/// Limits: from half a row of the detail on, windows contain another row; errors of the scale, if
/// nobody corrects the disparities. Below kAcceptable, of these, they cost nothing.
constexpr double kFixScale = 0.03;
constexpr double kAcceptable = 0.3;

/// Finds the causes by rows and disparities together: least squares with robust weights, for each
/// pair with the error of its motion, which takes a part of most errors of disparities. Values that
/// are not significant are left out, least significant first, and are zero then. All sigmas, see
/// RigProblem, are at least those with all values. With fewer samples than kLeastSamples all is
/// zero, and sigmas are infinite.
RigModel fitRig(const StereoCamera& camera,
                const std::vector<PairSamples>& pairs,
                const Windows& windows);

constexpr std::size_t kLeastSamples = 100;

}  // namespace rotrocc
