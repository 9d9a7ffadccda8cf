#include "motion/reprojection_problem.h"

namespace rotrocc {

template <int kParameters>
void ReprojectionProblem<kParameters>::assign(const StereoCamera& camera,
                                              const Fit& fit,
                                              const FeatureSet& set) {
  camera_ = camera;
  T_keyframe_cur_ = fit.T_keyframe_cur;
  indices_.clear();
  features_.clear();
  for (std::size_t i = 0; i < fit.features.size(); ++i) {
    if (set[i] == 0) continue;
    indices_.push_back(i);
    features_.push_back(fit.features[i]);
  }
  weights_.assign(features_.size(), 1.0);
}

template <int kParameters>
void ReprojectionProblem<kParameters>::weigh(const Parameters& parameters, double robust_factor) {
  if (robust_factor == 0.0) return;  // equal, as assigned
  const Motion motion(parameters);
  errors_px_.clear();
  for (const FittedFeature& feature : features_) {
    errors_px_.push_back(residual(feature, motion, nullptr).norm());
  }
  cauchyWeights(robust_factor, errors_px_, weights_);
}

template <int kParameters>
typename ReprojectionProblem<kParameters>::Parameters ReprojectionProblem<kParameters>::start()
    const {
  Parameters parameters = Parameters::Zero();
  parameters.template tail<3>() = T_keyframe_cur_.translation();
  return parameters;
}

template <int kParameters>
typename ReprojectionProblem<kParameters>::NormalMatrix
ReprojectionProblem<kParameters>::normalMatrix(const Parameters& parameters) const {
  constexpr int kColumns = (kParameters + 2) / 2 * 2;  // even, for SIMD
  Eigen::Matrix<double, kColumns, kColumns> sum = Eigen::Matrix<double, kColumns, kColumns>::Zero();
  Eigen::Matrix<double, kColumns, 2> columns = Eigen::Matrix<double, kColumns, 2>::Zero();
  linearise(parameters, [&](const Term& term) {
    columns.row(kParameters) = term.residual_px.transpose();
    columns.template topRows<kParameters>() = term.jacobian.transpose();
    sum += (term.weight * columns).lazyProduct(columns.transpose());
  });
  NormalMatrix normal = sum.template topLeftCorner<kParameters + 1, kParameters + 1>();
  if (kRotates) {
    // The terms are derivatives by a rotation after that of the parameters; convert them to
    // derivatives by the parameters.
    const Eigen::Matrix3d by_parameters = leftJacobian(parameters.template head<3>());
    normal.template topRows<3>() = by_parameters.transpose() * normal.template topRows<3>().eval();
    normal.template leftCols<3>() = normal.template leftCols<3>().eval() * by_parameters;
  }
  return normal;
}

template <int kParameters>
double ReprojectionProblem<kParameters>::cost(const Parameters& parameters) const {
  const Motion motion(parameters);
  double sum = 0.0;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    sum += weights_[i] * residual(features_[i], motion, nullptr).squaredNorm();
  }
  return sum;
}

template class ReprojectionProblem<3>;
template class ReprojectionProblem<6>;

}  // namespace rotrocc
