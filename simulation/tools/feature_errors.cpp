#include "simulation/tools/feature_errors.h"

#include <cmath>
#include <stdexcept>

#include "motion/reprojection_error.h"
#include "rotrocc/correspondence.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kFrame_s = 0.1;

/// R_z R_y R_x of roll, yaw and pitch [rad], as above Eq. 4.
Eigen::Matrix3d rotation(double pitch, double yaw, double roll) {
  return (Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// `amounts` are pitch, yaw, roll [rad] and t_x, t_y, t_z [m].
Eigen::Isometry3d motion(const Eigen::Matrix<double, 6, 1>& amounts) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation(amounts[0], amounts[1], amounts[2]);
  T.translation() = amounts.tail<3>();
  return T;
}

}  // namespace

std::vector<AssumedMotion> singleAxisMotions() {
  constexpr double kExcess = 1.1;
  const char* names[6] = {"pitch", "yaw", "roll", "t_x", "t_y", "t_z"};
  std::vector<AssumedMotion> hypotheses;
  for (int axis = 0; axis < 6; ++axis) {
    Eigen::Matrix<double, 6, 1> amounts = Eigen::Matrix<double, 6, 1>::Zero();
    amounts[axis] = axis < 3 ? 3.0 * kDegree : 1.0;
    hypotheses.push_back({names[axis], motion(amounts), motion(kExcess * amounts)});
  }
  return hypotheses;
}

AssumedMotion turnMotion() {
  constexpr double kExcess = 1.05;
  const double speed_mps = 50.0 / 3.6;
  AssumedMotion turn;
  turn.name = "turn";
  turn.T_keyframe_cur_true.linear() =
      rotation(10.0 * kDegree * kFrame_s, 50.0 * kDegree * kFrame_s, 5.0 * kDegree * kFrame_s);
  turn.T_keyframe_cur_true.translation() = Eigen::Vector3d(0.0, 0.0, speed_mps * kFrame_s);
  turn.T_keyframe_cur_assumed = turn.T_keyframe_cur_true;
  turn.T_keyframe_cur_assumed.translation() *= kExcess;
  return turn;
}

std::vector<FeatureErrors> judgeFeatures(const StereoCamera& camera,
                                         const std::vector<Eigen::Vector3d>& points_cur,
                                         const AssumedMotion& hypothesis,
                                         const std::vector<double>& depth_factors) {
  if (!depth_factors.empty() && depth_factors.size() != points_cur.size()) {
    throw std::invalid_argument("there are " + std::to_string(depth_factors.size()) +
                                " depth factors for " + std::to_string(points_cur.size()) +
                                " points; expected one per point, or none");
  }
  Correspondences features(points_cur.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    features[i].keyframe_px = camera.project(hypothesis.T_keyframe_cur_true * points_cur[i]);
    features[i].cur_px = camera.project(points_cur[i]);
    features[i].disparity_px = camera.disparity(points_cur[i].z());
    features[i].point_cur = (depth_factors.empty() ? 1.0 : depth_factors[i]) * points_cur[i];
  }

  std::vector<double> reprojection_px, flow_px, translation_flow_px;
  reprojectionErrors(camera, features, hypothesis.T_keyframe_cur_assumed, reprojection_px);
  coupledFlow(features, flow_px);
  decoupledFlow(camera, features, hypothesis.T_keyframe_cur_assumed.linear(), translation_flow_px);
  std::vector<FeatureErrors> errors(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    errors[i] = {reprojection_px[i],
                 reprojection_px[i] / flow_px[i],
                 reprojection_px[i] / translation_flow_px[i]};
  }
  return errors;
}

}  // namespace rotrocc
