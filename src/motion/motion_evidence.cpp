#include "motion/motion_evidence.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/median.h"
#include "motion/consensus_motion.h"
#include "motion/outlier_rejection.h"
#include "motion/reprojection_error.h"

namespace rotrocc {
namespace {

/// Features with a larger error contradict a motion. Those that are only inexact have a smaller
/// one.
constexpr double kContradiction_px = 2.0;

/// What is this many times as deep is behind.
constexpr double kBehind = 2.0;

/// The smallest eigenvalue of part v = lambda whole v.
double leastShare(const Matrix6d& part, const Matrix6d& whole) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> shares(
      part, whole, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
  return shares.info() == Eigen::Success ? std::clamp(shares.eigenvalues()[0], 0.0, 1.0) : 0.0;
}

}  // namespace

MotionEvidence::Competitors MotionEvidence::competitors(const StereoCamera& camera,
                                                        const Correspondences& features,
                                                        const Eigen::Isometry3d& T_keyframe_cur,
                                                        const FeatureSet& inliers,
                                                        int min_count) {
  reprojectionErrors(camera, features, T_keyframe_cur, errors_px_);
  others_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (errors_px_[i] > kContradiction_px) others_.push_back(features[i]);
  }
  if (static_cast<int>(others_.size()) < min_count) return {};
  const auto competitor = consensusMotion(camera, others_);
  if (!competitor) return {};
  reprojectionErrors(camera, others_, *competitor, errors_px_);
  set_.resize(others_.size());
  keepBelow(errors_px_, kContradiction_px, set_);
  const int agree = count(set_);
  if (agree < min_count) return {};
  return {agree, medianDepth(others_, set_) > kBehind * medianDepth(features, inliers)};
}

double MotionEvidence::informationShare(const Measurements& measured,
                                        const Eigen::Isometry3d& T_keyframe_cur,
                                        const FeatureSet& inliers) {
  fitAt(measured, T_keyframe_cur, fit_);
  const auto informationOf = [&](const FeatureSet& set) -> Matrix6d {
    problem_.assign(measured.camera, fit_, set);
    return problem_.normalMatrix(problem_.start()).topLeftCorner<6, 6>();
  };
  set_.assign(inliers.size(), 1);
  const Matrix6d of_all = informationOf(set_);
  const Matrix6d of_inliers = informationOf(inliers);  // they stay in the problem
  const Eigen::LLT<Matrix6d> determined(of_inliers);
  if (determined.info() != Eigen::Success) return 0.0;
  const Matrix6d covariance = determined.solve(Matrix6d::Identity());
  double max_leverage = 0.0;
  Eigen::Matrix<double, 2, 6> of_most = Eigen::Matrix<double, 2, 6>::Zero();
  problem_.linearise(problem_.start(), [&](const ReprojectionProblem<6>::Term& term) {
    const double leverage = (term.jacobian * covariance).cwiseProduct(term.jacobian).sum();
    if (leverage <= max_leverage) return;
    max_leverage = leverage;
    of_most = term.jacobian;
  });
  return leastShare(of_inliers - of_most.transpose() * of_most, of_all);
}

double MotionEvidence::medianDepth(const Correspondences& features, const FeatureSet& set) {
  depths_m_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] != 0) depths_m_.push_back(features[i].point_cur.z());
  }
  return median(depths_m_);
}

}  // namespace rotrocc
