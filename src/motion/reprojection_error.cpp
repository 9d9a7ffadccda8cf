#include "motion/reprojection_error.h"

#include <algorithm>

#include "geometry/min_depth.h"

namespace rotrocc {
namespace {

Eigen::Vector2d finiteProjection(const StereoCamera& camera, Eigen::Vector3d point) {
  point.z() = std::max(point.z(), kMinDepth_m);
  return camera.project(point);
}

/// Sets each value to length(feature).
template <class Features, class Length>
void measureEach(const Features& features, std::vector<double>& lengths_px, const Length& length) {
  lengths_px.resize(features.size());
  std::transform(features.begin(), features.end(), lengths_px.begin(), length);
}

}  // namespace

void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px) {
  measureEach(features, errors_px, [&](const Correspondence& feature) {
    const Eigen::Vector3d point = T_keyframe_cur * feature.point_cur;
    return (feature.keyframe_px - finiteProjection(camera, point)).norm();
  });
}

void fittedErrors(const StereoCamera& camera, const Fit& fit, std::vector<double>& errors_px) {
  measureEach(fit.features, errors_px, [&](const FittedFeature& feature) {
    const Eigen::Vector3d point = feature.rotated_point + fit.T_keyframe_cur.translation();
    return (feature.whitening * (feature.target_px - finiteProjection(camera, point))).norm();
  });
}

void decoupledFlow(const StereoCamera& camera,
                   const Correspondences& features,
                   const Eigen::Matrix3d& R_keyframe_cur,
                   std::vector<double>& lengths_px) {
  measureEach(features, lengths_px, [&](const Correspondence& feature) {
    const Eigen::Vector3d rotated = R_keyframe_cur * feature.point_cur;       // Eq. 27
    return (feature.keyframe_px - finiteProjection(camera, rotated)).norm();  // Eq. 28
  });
}

void coupledFlow(const Correspondences& features, std::vector<double>& lengths_px) {
  measureEach(features, lengths_px, [](const Correspondence& feature) {
    return (feature.keyframe_px - feature.cur_px).norm();
  });
}

}  // namespace rotrocc
