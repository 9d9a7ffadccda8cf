#include "motion/consensus_motion.h"

#include <vector>

#include <opencv2/calib3d.hpp>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

constexpr std::size_t kMinFeatures = 4;

/// As many determine the motion that most agree on; all of them take several times as long.
constexpr std::size_t kMaxFeatures = 200;

/// Of four features each, three for the motion and one to choose among its solutions: one of these
/// samples is without an outlier in 98 % of all cases if a quarter of the features agree.
constexpr int kSamples = 1000;
constexpr double kConfidence = 0.999;

}  // namespace

std::optional<Eigen::Isometry3d> consensusMotion(const StereoCamera& camera,
                                                 const Correspondences& features,
                                                 double tolerance) {
  if (features.size() < kMinFeatures) return std::nullopt;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  const std::size_t step = (features.size() + kMaxFeatures - 1) / kMaxFeatures;
  for (std::size_t i = 0; i < features.size(); i += step) {
    const Correspondence& feature = features[i];
    points.emplace_back(feature.point_cur.x(), feature.point_cur.y(), feature.point_cur.z());
    pixels.emplace_back(feature.keyframe_px.x(), feature.keyframe_px.y());
  }
  const cv::Matx33d intrinsics(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  cv::Vec3d rotation;
  cv::Vec3d translation;
  const bool found = cv::solvePnPRansac(points,
                                        pixels,
                                        intrinsics,
                                        cv::noArray(),
                                        rotation,
                                        translation,
                                        false,
                                        kSamples,
                                        static_cast<float>(camera.detail_px * tolerance),
                                        kConfidence,
                                        cv::noArray(),
                                        cv::SOLVEPNP_P3P);
  Eigen::Isometry3d T_keyframe_cur = Eigen::Isometry3d::Identity();
  T_keyframe_cur.linear() = expRotation({rotation[0], rotation[1], rotation[2]});
  T_keyframe_cur.translation() = Eigen::Vector3d(translation[0], translation[1], translation[2]);
  if (!found || !T_keyframe_cur.matrix().allFinite()) return std::nullopt;
  return T_keyframe_cur;
}

}  // namespace rotrocc
