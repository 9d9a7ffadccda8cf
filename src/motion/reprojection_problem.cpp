#include "motion/reprojection_problem.h"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace rotrocc {
namespace {

/// A fit changes the depth of a feature by at most this factor.
constexpr double kMaxStretch = 2.0;

/// Sums over the features of a cell of w g^T g and of w A^T g, where g are the derivatives of the
/// residuals by an error of the disparity, and A those by what is left, and the residuals.
struct SharedError {
  using Product = Eigen::Matrix<double, 1, ReprojectionProblem::kColumns>;

  double information = 0.0;
  Product product = Product::Zero();
};
using SharedErrors = std::array<SharedError, SharedErrorGrid::kCells>;

/// What the errors of the cells and the smooth ones explain of the sum of w A^T A.
ReprojectionProblem::NormalMatrix explainedBy(const SharedErrors& cells,
                                              double cell_ratio,
                                              double smooth_ratio) {
  ReprojectionProblem::NormalMatrix sum = ReprojectionProblem::NormalMatrix::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // about the smooth errors
  Eigen::Matrix<double, 3, ReprojectionProblem::kColumns> product;
  product.setZero();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const SharedError& cell = cells[i];
    if (cell.information == 0.0) continue;
    const double known = 1.0 / (cell_ratio * cell_ratio);
    const double factor = 1.0 / (cell.information + known);
    sum += factor * cell.product.transpose() * cell.product;
    const Eigen::Vector3d smooth = SharedErrorGrid::smoothErrors(i);
    information += factor * known * cell.information * smooth * smooth.transpose();
    product += factor * known * smooth * cell.product;
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
    Block& block = blocks_[i / kSize];
    const auto lane = static_cast<Eigen::Index>(i % kSize);
    block.target_x[lane] = feature.keyframe_px.x() - camera_.cx;
    block.target_y[lane] = feature.keyframe_px.y() - camera_.cy;
    block.x[lane] = feature.point_cur.x();
    block.y[lane] = feature.point_cur.y();
    block.z[lane] = feature.point_cur.z();
    block.disparity[lane] = feature.disparity_px - camera_.disparityAtInfinity();
    block.weight[lane] = i < count_ ? 1.0 : 0.0;
    cells_.push_back(grid.cell(feature.keyframe_px.x(), feature.keyframe_px.y()));
  }
  cell_ratio_ = 0.0;
  setMotion(T_keyframe_cur);
}

ReprojectionProblem::Seen ReprojectionProblem::look(const Eigen::Isometry3d& T_keyframe_cur,
                                                    const Block& block) const {
  const Eigen::Matrix3d R = T_keyframe_cur.linear();
  const Eigen::Vector3d t = T_keyframe_cur.translation();
  Seen seen;
  const Numbers x = block.nearer * block.x;
  const Numbers y = block.nearer * block.y;
  const Numbers z = block.nearer * block.z;
  seen.turned_x = R(0, 0) * x + R(0, 1) * y + R(0, 2) * z;
  seen.turned_y = R(1, 0) * x + R(1, 1) * y + R(1, 2) * z;
  seen.turned_z = R(2, 0) * x + R(2, 1) * y + R(2, 2) * z;
  const Numbers depth = seen.turned_z + t.z();
  seen.in_front = (depth >= kMinDepth_m).cast<double>();
  seen.per_z = depth.max(kMinDepth_m).inverse();
  seen.u = camera_.fx * (seen.turned_x + t.x()) * seen.per_z;
  seen.v = camera_.fy * (seen.turned_y + t.y()) * seen.per_z;
  return seen;
}

void ReprojectionProblem::setMotion(const Eigen::Isometry3d& T_keyframe_cur) {
  T_keyframe_cur_ = T_keyframe_cur;
  const Eigen::Vector3d t = T_keyframe_cur.translation();
  const double ratio2 = noise_ratio_ * noise_ratio_;
  Numbers j_x, j_y, s2;  // s^2 = 1 + r^2 j^2
  const auto differentiate = [&](const Seen& seen, const Block& block) {
    const Numbers scale = seen.per_z * block.nearer / block.disparity;
    j_x = scale * (camera_.fx * t.x() - seen.u * t.z());
    j_y = scale * (camera_.fy * t.y() - seen.v * t.z());
    s2 = 1.0 + ratio2 * (j_x * j_x + j_y * j_y);
  };
  for (Block& block : blocks_) {
    block.nearer = 1.0;
    const Seen seen = look(T_keyframe_cur, block);
    differentiate(seen, block);
    const Numbers along = j_x * (block.target_x - seen.u) + j_y * (block.target_y - seen.v);
    // One step: it is nearly linear. A wrong match must not become an inlier.
    const Numbers& d = block.disparity;
    block.moved =
        (ratio2 * along / s2).max((1.0 / kMaxStretch - 1.0) * d).min((kMaxStretch - 1.0) * d);
    block.nearer = d / (d + block.moved);
    block.seen = look(T_keyframe_cur, block);
    differentiate(block.seen, block);
    // S^-1/2 is 1 / s along j.
    const Numbers s = s2.sqrt();
    const Numbers less = ratio2 / (s * (s + 1.0));
    block.w_xx = 1.0 - less * j_x * j_x;
    block.w_xy = -less * j_x * j_y;
    block.w_yy = 1.0 - less * j_y * j_y;
    block.by_x = j_x / s;
    block.by_y = j_y / s;
  }
}

void ReprojectionProblem::select(const FeatureSet& set) {
  for (std::size_t i = 0; i < count_; ++i) {
    blocks_[i / kSize].weight[static_cast<Eigen::Index>(i % kSize)] = set[i] != 0 ? 1.0 : 0.0;
  }
  cell_ratio_ = 0.0;
}

double ReprojectionProblem::weigh(double robust_factor) {
  errors(errors_px_);
  std::size_t kept = 0;
  const auto weightOf = [&](std::size_t i) -> double& {
    return blocks_[i / kSize].weight[static_cast<Eigen::Index>(i % kSize)];
  };
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
  for (Block& block : blocks_) block.weight = block.weight.square();
}

void ReprojectionProblem::shareErrors(double cell_ratio, double smooth_ratio) {
  cell_ratio_ = cell_ratio;
  smooth_ratio_ = smooth_ratio;
}

void ReprojectionProblem::linearize(const Eigen::Isometry3d& T_keyframe_cur,
                                    int first,
                                    const Block& block,
                                    Linear& linear) const {
  const bool is_seen = T_keyframe_cur.matrix() == motion().matrix();
  const Seen seen = is_seen ? block.seen : look(T_keyframe_cur, block);
  const auto whiten = [&](int column, const Numbers& x, const Numbers& y) {
    linear.x[column] = block.w_xx * x + block.w_xy * y;
    linear.y[column] = block.w_xy * x + block.w_yy * y;
  };
  whiten(kResidual, block.target_x - seen.u, block.target_y - seen.v);
  linear.x[kResidual] += block.moved * block.by_x;
  linear.y[kResidual] += block.moved * block.by_y;
  if (first > kTranslation) return;
  // The projection is subtracted from the target, hence the signs.
  const Numbers u_by_x = -camera_.fx * seen.per_z;
  const Numbers v_by_y = -camera_.fy * seen.per_z;
  const Numbers per_z = seen.in_front * seen.per_z;
  whiten(kTranslation, u_by_x, Numbers::Zero());
  whiten(kTranslation + 1, Numbers::Zero(), v_by_y);
  whiten(kTranslation + 2, seen.u * per_z, seen.v * per_z);
  if (first == kTranslation) return;
  for (Numbers* row : {linear.x, linear.y}) {
    const Numbers* by = row + kTranslation;
    row[kMotion] = seen.turned_y * by[2] - seen.turned_z * by[1];
    row[kMotion + 1] = seen.turned_z * by[0] - seen.turned_x * by[2];
    row[kMotion + 2] = seen.turned_x * by[1] - seen.turned_y * by[0];
  }
  linear.x[kBias] = -block.by_x;
  linear.y[kBias] = -block.by_y;
}

ReprojectionProblem::Term ReprojectionProblem::termOf(std::size_t i,
                                                      const Block& block,
                                                      Eigen::Index lane,
                                                      const Linear& linear) {
  Term term;
  term.feature = i;
  term.weight = block.weight[lane];
  term.residual_px = {linear.x[kResidual][lane], linear.y[kResidual][lane]};
  for (int i = 0; i < 6; ++i) {
    term.jacobian.col(i) << linear.x[kMotion + i][lane], linear.y[kMotion + i][lane];
  }
  term.by_disparity = {block.by_x[lane], block.by_y[lane]};
  return term;
}

ReprojectionProblem::NormalMatrix ReprojectionProblem::normalMatrix(
    const Eigen::Isometry3d& T_keyframe_cur, int first) const {
  Numbers sums[kColumns][kColumns];
  for (auto& row : sums) std::fill_n(row, kColumns, Numbers::Zero());
  SharedErrors shared;
  Linear linear;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    linearize(T_keyframe_cur, first, block, linear);
    for (int i = first; i < kColumns; ++i) {
      const Numbers x = block.weight * linear.x[i];
      const Numbers y = block.weight * linear.y[i];
      for (int j = i; j < kColumns; ++j) sums[i][j] += x * linear.x[j] + y * linear.y[j];
    }
    if (cell_ratio_ == 0.0) continue;
    const Numbers x = block.weight * block.by_x;
    const Numbers y = block.weight * block.by_y;
    const Numbers information = x * block.by_x + y * block.by_y;
    Eigen::Array<double, kSize, kColumns> products = Eigen::Array<double, kSize, kColumns>::Zero();
    for (int i = first; i < kColumns; ++i) products.col(i) = x * linear.x[i] + y * linear.y[i];
    for (std::size_t lane = 0; lane < kSize; ++lane) {
      SharedError& cell = shared[cells_[b * kSize + lane]];
      const auto row = static_cast<Eigen::Index>(lane);
      cell.information += information[row];
      cell.product += products.row(row).matrix();
    }
  }
  NormalMatrix normal = NormalMatrix::Zero();
  for (int i = first; i < kColumns; ++i) {
    for (int j = i; j < kColumns; ++j) normal(i, j) = normal(j, i) = sums[i][j].sum();
  }
  if (cell_ratio_ > 0.0) normal -= explainedBy(shared, cell_ratio_, smooth_ratio_);
  return normal;
}

void ReprojectionProblem::errors(std::vector<double>& errors_px) const {
  errors_px.resize(kSize * blocks_.size());
  Linear linear;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    linearize(T_keyframe_cur_, kResidual, blocks_[b], linear);
    Eigen::Map<Numbers>(errors_px.data() + b * kSize) =
        (linear.x[kResidual].square() + linear.y[kResidual].square()).sqrt();
  }
  errors_px.resize(count_);
}

}  // namespace rotrocc
