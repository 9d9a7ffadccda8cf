#pragma once

#include <memory>

#include "check/rig_report.h"
#include "check/windows.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// A pair of a recording, with what the odometry made of it.
struct CheckedPair {
  double time_s;  ///< since the first pair
  const StereoPair& images;
  const StereoCamera& camera;
  const OdometryResult& result;
  const Correspondences& features;  ///< between the keyframe and this pair
  const FeatureSet& inliers;        ///< of these, those that agree with the motion
  double flow_px;                   ///< median length of theirs; 0 if there are none
  /// Whether features have moved since the last pair for which this was true: what stands still
  /// shows the same again, wrong matches included.
  bool has_moved;
};

/// A check of the pairs of a recording.
class PairCheck {
 public:
  virtual ~PairCheck() = default;

  virtual void observe(const CheckedPair& pair) = 0;

  /// Adds its findings and tables.
  virtual void report(const Windows& windows, RigReport& report) const = 0;
};

/// Compares the gray levels and the sharpness of the images where both show the same: section
/// photometry.
std::unique_ptr<PairCheck> makePhotometryCheck();

/// What compression or dirt take away from one image: section photometry. Reports after the view,
/// whose mask explains a lack of detail.
std::unique_ptr<PairCheck> makeDetailCheck();

/// Compares the rotations of the cameras with those of a gyroscope: the offset between their
/// clocks, the rotation between their axes, and the bias. Section time.
std::unique_ptr<PairCheck> makeGyroCheck(const GyroRecording& gyroscope);

/// The subject of the finding that a mask is proposed.
constexpr char kMasked[] = "parts that stand still while the rest moves";

/// What the cameras see: how many corners have a disparity, where there are features, and where
/// they never agree with the motion. Section view, and a mask if one is proposed.
std::unique_ptr<PairCheck> makeViewCheck();

}  // namespace rotrocc
