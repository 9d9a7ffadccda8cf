#include "tools/frame_alignment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Steps are so much of the path.
constexpr double kStepShare = 0.05;
/// An odometry drives in a wrong direction by so much, all the way: more steps do not help [rad].
constexpr double kDirection_rad = 0.01;
/// Of the place on the body, where turns do not show it.
constexpr double kFarAway_m = 10.0;
/// Of motions, as a share of their way.
constexpr double kUsualError = 0.02;
constexpr int kIterations = 20;

struct Motions {
  std::vector<Eigen::Isometry3d> truth, estimate;
  double way_m = 0.0;  // of all
};

Motions motionsOf(const MatchedTrajectories& matched) {
  const std::vector<double> path_m = pathLengths(matched.truth);
  const double step_m = kStepShare * path_m.back();
  Motions motions;
  std::size_t end = 0;
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    while (end < path_m.size() && path_m[end] - path_m[i] <= step_m) ++end;
    if (end == path_m.size()) break;
    const auto between = [&](const Trajectory& poses) {
      return poses[i].T_world_body.inverse() * poses[end].T_world_body;
    };
    motions.truth.push_back(between(matched.truth));
    motions.estimate.push_back(between(matched.estimate));
    motions.way_m += motions.truth.back().translation().norm();
  }
  return motions;
}

/// The inverse variance of a turn, by what is left of all turns; steps overlap.
double weightOfTurns(const Motions& motions, const Eigen::Matrix3d& R_estimate_truth) {
  double left2 = 0.0, turn2 = 0.0;
  for (std::size_t i = 0; i < motions.truth.size(); ++i) {
    const Eigen::Vector3d turn = logRotation(motions.estimate[i].linear());
    left2 += (R_estimate_truth * logRotation(motions.truth[i].linear()) - turn).squaredNorm();
    turn2 += turn.squaredNorm();
  }
  return 1.0 / (kStepShare * left2 + kDirection_rad * kDirection_rad * turn2 + 1e-12);
}

/// The inverse variance of a way, so that all together do not know the direction any better.
double weightOfWays(const Motions& motions) {
  double way2 = 0.0;
  for (const Eigen::Isometry3d& motion : motions.truth) way2 += motion.translation().squaredNorm();
  return 1.0 / (kDirection_rad * kDirection_rad * std::max(way2, 1e-12));
}

/// The rotation that turns the ways of the truth to those of the estimate (Kabsch).
Eigen::Matrix3d rotationOfWays(const Motions& motions) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < motions.truth.size(); ++i) {
    sum += motions.estimate[i].translation() * motions.truth[i].translation().transpose();
    sum += logRotation(motions.estimate[i].linear()) *
           logRotation(motions.truth[i].linear()).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs.z() = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// Where the motions of both bodies agree best, from nearby (Gauss-Newton).
Eigen::Isometry3d improved(const Motions& motions, const Eigen::Isometry3d& T_estimate_truth) {
  const double of_ways = weightOfWays(motions);
  const double of_turns = weightOfTurns(motions, T_estimate_truth.linear());
  Matrix6d normal = Matrix6d::Zero();  // of a turn and of the place
  Vector6d right = Vector6d::Zero();
  const double of_place = 1.0 / (kFarAway_m * kFarAway_m);
  normal.topLeftCorner<3, 3>().setIdentity();  // what nothing shows stays
  normal.bottomRightCorner<3, 3>() = of_place * Eigen::Matrix3d::Identity();
  right.tail<3>() = -of_place * T_estimate_truth.translation();
  for (std::size_t i = 0; i < motions.truth.size(); ++i) {
    const Eigen::Isometry3d& estimate = motions.estimate[i];
    const Eigen::Matrix3d turn = estimate.linear() - Eigen::Matrix3d::Identity();
    const Eigen::Vector3d way = T_estimate_truth.linear() * motions.truth[i].translation();
    const Eigen::Vector3d angle =
        T_estimate_truth.linear() * logRotation(motions.truth[i].linear());
    Eigen::Matrix<double, 3, 6> by_way, by_turn;
    by_way << skew(way), turn;
    by_turn << skew(angle), Eigen::Matrix3d::Zero();
    const Eigen::Vector3d way_error =
        estimate.translation() + turn * T_estimate_truth.translation() - way;
    const Eigen::Vector3d turn_error = logRotation(estimate.linear()) - angle;
    normal += of_ways * by_way.transpose() * by_way + of_turns * by_turn.transpose() * by_turn;
    right -= of_ways * by_way.transpose() * way_error + of_turns * by_turn.transpose() * turn_error;
  }
  const Vector6d change = normal.ldlt().solve(right);
  Eigen::Isometry3d T = T_estimate_truth;
  T.linear() = expRotation(change.head<3>()) * T.linear();
  T.translation() += change.tail<3>();
  return T;
}

/// Mean difference of the motions, as a share of their way.
double differenceOf(const Motions& motions, const Eigen::Isometry3d& T_estimate_truth) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i < motions.truth.size(); ++i) {
    const Eigen::Isometry3d moved =
        T_estimate_truth.inverse() * motions.estimate[i] * T_estimate_truth;
    sum_m += (moved.translation() - motions.truth[i].translation()).norm();
  }
  return motions.way_m > 0.0 ? sum_m / motions.way_m : 0.0;
}

}  // namespace

bool FrameAlignment::isNeeded() const {
  return error_before > kUsualError && error_after < 0.5 * error_before;
}

std::string FrameAlignment::describe() const {
  const Eigen::Vector3d& place = T_estimate_truth.translation();
  const double angle_deg = logRotation(T_estimate_truth.linear()).norm() * 180.0 / M_PI;
  return cv::format("turned by %.1f deg and %.2f m away (%.2f %.2f %.2f m)",
                    angle_deg,
                    place.norm(),
                    place.x(),
                    place.y(),
                    place.z());
}

FrameAlignment alignFrames(const MatchedTrajectories& matched) {
  const Motions motions = motionsOf(matched);
  FrameAlignment alignment;
  if (motions.truth.empty()) return alignment;
  alignment.error_before = differenceOf(motions, Eigen::Isometry3d::Identity());
  Eigen::Isometry3d& T = alignment.T_estimate_truth;
  T.linear() = rotationOfWays(motions);
  for (int i = 0; i < kIterations; ++i) T = improved(motions, T);
  alignment.error_after = differenceOf(motions, T);
  return alignment;
}

Trajectory withFrame(const Trajectory& estimate, const FrameAlignment& alignment) {
  Trajectory poses = estimate;
  for (StampedPose& pose : poses)
    pose.T_world_body = pose.T_world_body * alignment.T_estimate_truth;
  return poses;
}

}  // namespace rotrocc
