#include "motion/reprojection_problem.h"

#include <cmath>

#include <Eigen/Cholesky>

namespace rotrocc {
namespace {

double sumOf(const FeatureBlock::Numbers& n) {
  return (n[0] + n[2] + (n[4] + n[6])) + (n[1] + n[3] + (n[5] + n[7]));
}

/// For each cell, the sum over its features of w A^T g, where A are all columns, and g are the
/// derivatives by an error of the disparity: column LinearBlock::kBias.
using SharedErrors =
    Eigen::Matrix<double, ReprojectionProblem::kColumns, int{SharedErrorGrid::kCells}>;

/// What the errors of the cells and the smooth ones explain of the sum of w A^T A.
ReprojectionProblem::NormalMatrix explainedBy(const SharedErrors& cells,
                                              double cell_ratio,
                                              double smooth_ratio) {
  ReprojectionProblem::NormalMatrix sum = ReprojectionProblem::NormalMatrix::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // about the smooth errors
  Eigen::Matrix<double, 3, ReprojectionProblem::kColumns> product;
  product.setZero();
  for (Eigen::Index i = 0; i < cells.cols(); ++i) {
    const auto cell = cells.col(i);
    const double of_cell = cell[LinearBlock::kBias];
    if (of_cell == 0.0) continue;
    const double known = 1.0 / (cell_ratio * cell_ratio);
    const double factor = 1.0 / (of_cell + known);
    sum += factor * cell * cell.transpose();
    const Eigen::Vector3d smooth = SharedErrorGrid::smoothErrors(static_cast<std::size_t>(i));
    information += factor * known * of_cell * smooth * smooth.transpose();
    product += factor * known * smooth * cell.transpose();
  }
  if (smooth_ratio == 0.0) return sum;
  information.diagonal().array() += 1.0 / (smooth_ratio * smooth_ratio);
  return sum + product.transpose() * information.llt().solve(product);
}

}  // namespace

void ReprojectionProblem::assign(const Measurements& measured,
                                 const Eigen::Isometry3d& T_keyframe_cur) {
  camera_ = measured.camera;
  noise_ratio_ = measured.noise_ratio;
  count_ = measured.features.size();
  blocks_.resize((count_ + kSize - 1) / kSize);
  cells_.clear();
  const SharedErrorGrid grid(camera_);
  for (std::size_t i = 0; i < kSize * blocks_.size(); ++i) {
    const Correspondence& feature = measured.features[std::min(i, count_ - 1)];
    FeatureBlock& block = blocks_[i / kSize];
    const std::size_t lane = i % kSize;
    block.target_x[lane] = feature.keyframe_px.x() - camera_.cx;
    block.target_y[lane] = feature.keyframe_px.y() - camera_.cy;
    block.x[lane] = feature.point_cur.x();
    block.y[lane] = feature.point_cur.y();
    block.z[lane] = feature.point_cur.z();
    block.disparity[lane] = feature.disparity_px - camera_.disparityAtInfinity();
    block.weight[lane] = i < count_ ? 1.0 : 0.0;
    cells_.push_back(
        static_cast<Eigen::Index>(grid.cell(feature.keyframe_px.x(), feature.keyframe_px.y())));
  }
  cell_ratio_ = 0.0;
  setMotion(T_keyframe_cur);
}

FeatureView ReprojectionProblem::viewFrom(const Eigen::Isometry3d& T_keyframe_cur) const {
  const bool is_seen = T_keyframe_cur.matrix() == motion().matrix();
  return {T_keyframe_cur.data(), camera_.fx, camera_.fy, kMinDepth_m, is_seen};
}

void ReprojectionProblem::setMotion(const Eigen::Isometry3d& T_keyframe_cur) {
  T_keyframe_cur_ = T_keyframe_cur;
  const FeatureView view = viewFrom(T_keyframe_cur_);
  for (FeatureBlock& block : blocks_) chooseKernels().fitDisparities(view, noise_ratio_, block);
}

void ReprojectionProblem::select(const FeatureSet& set) {
  for (std::size_t i = 0; i < count_; ++i) weightOf(i) = set[i] != 0 ? 1.0 : 0.0;
  cell_ratio_ = 0.0;
}

double ReprojectionProblem::weigh(double robust_factor) {
  errors(errors_px_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (weightOf(i) > 0.0) errors_px_[kept++] = errors_px_[i];
  }
  errors_px_.resize(kept);
  const double deviation_px = cauchyWeights(robust_factor, errors_px_, weights_);
  auto next = weights_.begin();
  for (std::size_t i = 0; i < count_; ++i) {
    if (weightOf(i) > 0.0) weightOf(i) *= *next++;
  }
  return deviation_px;
}

void ReprojectionProblem::squareWeights() {
  for (std::size_t i = 0; i < count_; ++i) weightOf(i) *= weightOf(i);
}

void ReprojectionProblem::shareErrors(double cell_ratio, double smooth_ratio) {
  cell_ratio_ = cell_ratio;
  smooth_ratio_ = smooth_ratio;
}

ReprojectionProblem::Term ReprojectionProblem::termOf(std::size_t i,
                                                      const FeatureBlock& block,
                                                      const LinearBlock& linear) {
  const std::size_t lane = i % kSize;
  Term term;
  term.feature = i;
  term.weight = block.weight[lane];
  const auto at = [&](int column) {
    return Eigen::Vector2d(linear.x[column][lane], linear.y[column][lane]);
  };
  term.residual_px = at(LinearBlock::kResidual);
  for (int i = 0; i < 6; ++i) term.jacobian.col(i) = at(LinearBlock::kMotion + i);
  term.by_disparity = {block.by_x[lane], block.by_y[lane]};
  return term;
}

ReprojectionProblem::NormalMatrix ReprojectionProblem::normalMatrix(
    const Eigen::Isometry3d& T_keyframe_cur, int first) const {
  const Kernels& kernels = chooseKernels();
  const FeatureView view = viewFrom(T_keyframe_cur);
  LinearBlock::Products sums[kColumns] = {};
  LinearBlock::Products products = {};
  const Eigen::Map<const Eigen::Matrix<double, kColumns, kSize, Eigen::RowMajor>> of_features(
      products[0]);
  SharedErrors shared = SharedErrors::Zero();
  LinearBlock linear;
  const bool has_shared = cell_ratio_ > 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    kernels.linearize(view, first, blocks_[b], linear);
    kernels.addProducts(blocks_[b], linear, first, sums, has_shared ? products : nullptr);
    for (std::size_t lane = 0; has_shared && lane < kSize; ++lane) {
      shared.col(cells_[b * kSize + lane]) += of_features.col(static_cast<Eigen::Index>(lane));
    }
  }
  NormalMatrix explained = NormalMatrix::Zero();
  if (has_shared) explained = explainedBy(shared, cell_ratio_, smooth_ratio_);
  NormalMatrix normal = NormalMatrix::Zero();
  for (int i = first; i < kColumns; ++i) {
    for (int j = i; j < kColumns; ++j) {
      normal(i, j) = normal(j, i) = sumOf(sums[i][j]) - explained(i, j);
    }
  }
  return normal;
}

void ReprojectionProblem::errors(std::vector<double>& errors_px) const {
  errors_px.resize(count_);
  const FeatureView view = viewFrom(T_keyframe_cur_);
  constexpr int kResidual = LinearBlock::kResidual;
  LinearBlock linear;
  for (std::size_t i = 0; i < count_; ++i) {
    if (i % kSize == 0) chooseKernels().linearize(view, kResidual, blocks_[i / kSize], linear);
    const double x = linear.x[kResidual][i % kSize];
    const double y = linear.y[kResidual][i % kSize];
    errors_px[i] = std::sqrt(x * x + y * y);
  }
}

}  // namespace rotrocc
