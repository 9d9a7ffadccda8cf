#include "motion/reprojection_problem.h"

#include <algorithm>
#include <array>

#include "motion/shared_error.h"

namespace rotrocc {
namespace {

/// The derivative of a feature's residual by the error of its disparity, up to the sign.
Eigen::Vector2d byDisparityError(const FittedFeature& feature) {
  return feature.whitening * feature.by_disparity;
}

/// Eliminates the errors that the features of a cell share: sums of w g^T g and of w A g for each
/// cell, where g are the derivatives of the residuals by the error. The columns of A are the
/// derivatives by what is left, and the residuals.
template <int kColumns>
class SharedErrors {
 public:
  using Column = Eigen::Matrix<double, kColumns, 1>;

  SharedErrors() { products_.fill(Column::Zero()); }

  void add(std::size_t cell,
           double weight,
           const Eigen::Vector2d& by_error,
           const Column& product) {
    information_[cell] += weight * by_error.squaredNorm();
    products_[cell] += weight * product;
  }

  /// What to subtract from the sum of w A A^T.
  template <class Subtract>
  void eliminate(double inverse_variance, const Subtract& subtract) const {
    for (std::size_t cell = 0; cell < SharedErrorGrid::kCells; ++cell) {
      if (information_[cell] == 0.0) continue;
      subtract(products_[cell], 1.0 / (information_[cell] + inverse_variance));
    }
  }

 private:
  std::array<double, SharedErrorGrid::kCells> information_{};
  std::array<Column, SharedErrorGrid::kCells> products_;
};

}  // namespace

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
  cells_.clear();
}

template <int kParameters>
void ReprojectionProblem<kParameters>::shareErrors(double ratio) {
  cells_.clear();
  if (ratio == 0.0) return;
  inverse_shared_variance_ = 1.0 / (ratio * ratio);
  const SharedErrorGrid grid(camera_);
  for (const FittedFeature& feature : features_) cells_.push_back(grid.cell(feature));
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
  SharedErrors<kColumns> shared;
  std::size_t feature = 0;
  linearise(parameters, [&](const Term& term) {
    columns.row(kParameters) = term.residual_px.transpose();
    columns.template topRows<kParameters>() = term.jacobian.transpose();
    sum += (term.weight * columns).lazyProduct(columns.transpose());
    if (!sharesErrors()) return;
    const Eigen::Vector2d by_error = byDisparityError(term.fitted);
    shared.add(cells_[feature++], term.weight, by_error, columns * by_error);
  });
  shared.eliminate(inverse_shared_variance_, [&](const auto& product, double factor) {
    sum -= (factor * product).lazyProduct(product.transpose());
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
  SharedErrors<1> shared;
  for (std::size_t i = 0; i < features_.size(); ++i) {
    const Eigen::Vector2d residual_px = residual(features_[i], motion, nullptr);
    sum += weights_[i] * residual_px.squaredNorm();
    if (!sharesErrors()) continue;
    const Eigen::Vector2d by_error = byDisparityError(features_[i]);
    const Eigen::Matrix<double, 1, 1> product(by_error.dot(residual_px));
    shared.add(cells_[i], weights_[i], by_error, product);
  }
  shared.eliminate(inverse_shared_variance_, [&](const auto& product, double factor) {
    sum -= factor * product.squaredNorm();
  });
  return std::max(sum, 0.0);  // it is zero for exact features, except for rounding
}

template class ReprojectionProblem<3>;
template class ReprojectionProblem<6>;

}  // namespace rotrocc
