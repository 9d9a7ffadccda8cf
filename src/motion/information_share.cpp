#include "motion/information_share.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace rotrocc {
namespace {

/// The smallest eigenvalue of part v = lambda whole v.
double leastShare(const Matrix6d& part, const Matrix6d& whole) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> shares(
      part, whole, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
  return shares.info() == Eigen::Success ? std::clamp(shares.eigenvalues()[0], 0.0, 1.0) : 0.0;
}

}  // namespace

double InformationShare::minimum(const Measurements& measured,
                                 const Eigen::Isometry3d& T_keyframe_cur,
                                 const FeatureSet& inliers) {
  fitAt(measured, T_keyframe_cur, fit_);
  all_.assign(inliers.size(), 1);
  const Matrix6d of_all = informationOf(measured.camera, all_);
  const Matrix6d of_inliers = informationOf(measured.camera, inliers);
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

/// Leaves the features of the set in the problem.
Matrix6d InformationShare::informationOf(const StereoCamera& camera, const FeatureSet& set) {
  problem_.assign(camera, fit_, set);
  return problem_.normalMatrix(problem_.start()).topLeftCorner<6, 6>();
}

}  // namespace rotrocc
