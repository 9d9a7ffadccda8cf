#include "motion/reprojection_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include <Eigen/Cholesky>

namespace rotrocc {
namespace {

void put(const StereoCamera& camera,
         const FittedFeature& feature,
         ResidualBlock& block,
         std::size_t lane) {
  block.target_x[lane] = feature.target_px.x() - camera.cx;
  block.target_y[lane] = feature.target_px.y() - camera.cy;
  block.point_x[lane] = feature.rotated_point.x();
  block.point_y[lane] = feature.rotated_point.y();
  block.point_z[lane] = feature.rotated_point.z();
  block.whitening_xx[lane] = feature.whitening(0, 0);
  block.whitening_xy[lane] = feature.whitening(0, 1);
  block.whitening_yy[lane] = feature.whitening(1, 1);
  const Eigen::Vector2d by_disparity = feature.whitening * feature.by_disparity;
  block.by_disparity_x[lane] = by_disparity.x();
  block.by_disparity_y[lane] = by_disparity.y();
  block.weight[lane] = 1.0;
}

double sum(const ResidualBlock::Numbers& numbers) {
  return std::accumulate(std::begin(numbers), std::end(numbers), 0.0);
}

/// Eliminates the errors that the features share: those of the cells and the parabola. It needs
/// sums of w g^T g and of w A g, where g are the derivatives of the residuals by an error of the
/// disparity. The columns of A are the derivatives by what is left, and the residuals.
template <int kColumns>
class SharedErrors {
 public:
  using Column = Eigen::Matrix<double, kColumns, 1>;
  using Products = Eigen::Matrix<double, kColumns, kColumns>;

  /// Adds a feature with w g^T g and w A g.
  template <class Product>
  void add(std::size_t cell, double parabola, double information, const Product& product) {
    const double both = parabola * information;
    cells_[cell].information += information;
    cells_[cell].with_parabola += both;
    cells_[cell].product += product;
    parabola_information_ += parabola * both;
    parabola_product_ += parabola * product;
  }

  /// What the errors explain of the sum of w A A^T. Without an inverse variance there is no
  /// parabola.
  Products explained(double of_cell, double of_parabola) const {
    Products sum = Products::Zero();
    double information = of_parabola + parabola_information_;
    Column product = parabola_product_;
    for (const Cell& cell : cells_) {  // eliminates the error of the cell
      if (cell.information == 0.0) continue;
      const double factor = 1.0 / (cell.information + of_cell);
      sum += factor * cell.product * cell.product.transpose();
      information -= factor * cell.with_parabola * cell.with_parabola;
      product -= factor * cell.with_parabola * cell.product;
    }
    if (of_parabola > 0.0) sum += 1.0 / information * product * product.transpose();
    return sum;
  }

 private:
  struct Cell {
    double information = 0.0;
    double with_parabola = 0.0;  // sum of w g^T g times the parabola
    Column product = Column::Zero();
  };

  std::array<Cell, SharedErrorGrid::kCells> cells_;
  double parabola_information_ = 0.0;
  Column parabola_product_ = Column::Zero();
};

double inverseVariance(double ratio) {
  return ratio == 0.0 ? 0.0 : 1.0 / (ratio * ratio);
}

}  // namespace

template <int kParameters>
void ReprojectionProblem<kParameters>::assign(const StereoCamera& camera,
                                              const Fit& fit,
                                              const FeatureSet& set) {
  camera_ = camera;
  T_keyframe_cur_ = fit.T_keyframe_cur;
  indices_.clear();
  blocks_.clear();
  cells_.clear();
  parabolas_.clear();
  inverse_cell_variance_ = 0.0;
  inverse_parabola_variance_ = 0.0;
  const SharedErrorGrid grid(camera);
  for (std::size_t i = 0; i < fit.features.size(); ++i) {
    if (set[i] == 0) continue;
    const std::size_t lane = indices_.size() % kSize;
    if (lane == 0) blocks_.emplace_back();
    put(camera, fit.features[i], blocks_.back(), lane);
    indices_.push_back(i);
    cells_.push_back(grid.cell(fit.features[i].target_px));
    parabolas_.push_back(parabolaOverRows(camera, fit.features[i].target_px));
  }
}

template <int kParameters>
void ReprojectionProblem<kParameters>::shareErrors(double cell_ratio, double parabola_ratio) {
  inverse_cell_variance_ = inverseVariance(cell_ratio);
  inverse_parabola_variance_ = inverseVariance(parabola_ratio);
}

template <int kParameters>
MotionTerms ReprojectionProblem<kParameters>::termsAt(const Parameters& parameters) const {
  // The points are rotated already.
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (kRotates) motion.linear() = expRotation(parameters.template head<3>());
  motion.translation() = parameters.template tail<3>();
  return rotrocc::termsAt(camera_, motion);
}

template <int kParameters>
void ReprojectionProblem<kParameters>::weigh(const Parameters& parameters, double robust_factor) {
  if (robust_factor == 0.0) return;  // equal, as assigned
  errors_px_.clear();
  visitResiduals(parameters, [&](const Residual& residual) {
    errors_px_.push_back(residual.residual_px.norm());
  });
  cauchyWeights(robust_factor, errors_px_, weights_);
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    blocks_[i / kSize].weight[i % kSize] = weights_[i];
  }
}

template <int kParameters>
void ReprojectionProblem<kParameters>::squareWeights() {
  for (ResidualBlock& block : blocks_) {
    for (double& weight : block.weight) weight *= weight;
  }
}

template <int kParameters>
typename ReprojectionProblem<kParameters>::Parameters ReprojectionProblem<kParameters>::start()
    const {
  Parameters parameters = Parameters::Zero();
  parameters.template tail<3>() = T_keyframe_cur_.translation();
  return parameters;
}

template <int kParameters>
Eigen::Isometry3d ReprojectionProblem<kParameters>::motionAt(const Parameters& parameters) const {
  Eigen::Isometry3d T_keyframe_cur = T_keyframe_cur_;
  if (kRotates) {
    const Eigen::Matrix3d R = expRotation(parameters.template head<3>()) * T_keyframe_cur_.linear();
    T_keyframe_cur.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  }
  T_keyframe_cur.translation() = parameters.template tail<3>();
  return T_keyframe_cur;
}

template <int kParameters>
typename ReprojectionProblem<kParameters>::NormalMatrix
ReprojectionProblem<kParameters>::normalMatrixOf(const ColumnProducts& sums) {
  NormalMatrix normal;
  for (int a = 0; a <= kParameters; ++a) {
    for (int b = a; b <= kParameters; ++b) {
      normal(a, b) = normal(b, a) = sum(sums.of[kFirst + a][kFirst + b]);
    }
  }
  return normal;
}

template <int kParameters>
typename ReprojectionProblem<kParameters>::NormalMatrix
ReprojectionProblem<kParameters>::normalMatrix(const Parameters& parameters) const {
  NormalMatrix normal;
  if (inverse_cell_variance_ == 0.0) {
    normal = sumTerms(parameters, nullptr);
  } else {
    SharedErrors<kParameters + 1> shared;
    normal = sumTerms(parameters, [&](const ByDisparity& feature) {
      shared.add(feature.cell, feature.parabola, feature.information, feature.product);
    });
    normal -= shared.explained(inverse_cell_variance_, inverse_parabola_variance_);
  }
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
  const bool shares = inverse_cell_variance_ > 0.0;
  double sum = 0.0;
  SharedErrors<1> shared;
  visitResiduals(parameters, [&](const Residual& residual) {
    const Eigen::Vector2d& by_error = residual.by_disparity;
    sum += residual.weight * residual.residual_px.squaredNorm();
    if (!shares) return;
    const Eigen::Matrix<double, 1, 1> product(residual.weight * by_error.dot(residual.residual_px));
    shared.add(residual.cell, residual.parabola, residual.weight * by_error.squaredNorm(), product);
  });
  if (shares) sum -= shared.explained(inverse_cell_variance_, inverse_parabola_variance_).value();
  return std::max(sum, 0.0);  // it is zero for exact features, except for rounding
}

template <int kParameters>
bool ReprojectionProblem<kParameters>::operator()(const double* parameters,
                                                  double* residuals,
                                                  double* jacobian) const {
  const Eigen::Map<const Parameters> p(parameters);
  Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, 1>> r(residuals);
  if (jacobian == nullptr) {
    r.setZero();
    r[0] = std::sqrt(cost(p));
    return true;
  }
  // A square root of the normal matrix, which is positive semidefinite except for rounding errors.
  const Eigen::LDLT<NormalMatrix> ldlt(normalMatrix(p));
  const NormalMatrix root = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                            NormalMatrix(ldlt.matrixU()) *
                            NormalMatrix(ldlt.transpositionsP() * NormalMatrix::Identity());
  r = root.col(kParameters);
  Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, kParameters>> J(jacobian);
  J = root.template leftCols<kParameters>();
  return true;
}

template class ReprojectionProblem<3>;
template class ReprojectionProblem<6>;

}  // namespace rotrocc
