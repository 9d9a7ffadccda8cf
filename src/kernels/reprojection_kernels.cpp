#include "kernels/reprojection_kernels.h"

#include <math.h>

namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

using Numbers = FeatureBlock::Numbers;
constexpr int kSize = FeatureBlock::kSize;

/// A fit changes the depth of a feature by at most this factor.
constexpr double kMaxStretch = 2.0;

/// At the fitted depths.
void look(const FeatureView& view, const FeatureBlock& block, FeatureBlock::Seen& __restrict seen) {
  const double* r_x = view.T;
  const double* r_y = view.T + 4;
  const double* r_z = view.T + 8;
  const double* t = view.T + 12;
  for (int i = 0; i < kSize; ++i) {
    const double x = block.nearer[i] * block.x[i];
    const double y = block.nearer[i] * block.y[i];
    const double z = block.nearer[i] * block.z[i];
    seen.turned_x[i] = r_x[0] * x + r_y[0] * y + r_z[0] * z;
    seen.turned_y[i] = r_x[1] * x + r_y[1] * y + r_z[1] * z;
    seen.turned_z[i] = r_x[2] * x + r_y[2] * y + r_z[2] * z;
    const double depth = seen.turned_z[i] + t[2];
    seen.in_front[i] = depth >= view.least_depth_m ? 1.0 : 0.0;
    seen.per_z[i] = 1.0 / (depth >= view.least_depth_m ? depth : view.least_depth_m);
    seen.u[i] = view.fx * (seen.turned_x[i] + t[0]) * seen.per_z[i];
    seen.v[i] = view.fy * (seen.turned_y[i] + t[1]) * seen.per_z[i];
  }
}

/// j, and 1 + r^2 j^2.
struct ByDisparity {
  double x, y, s2;
};

ByDisparity differentiate(const FeatureView& view, const FeatureBlock& block, int i, double r2) {
  const double* t = view.T + 12;
  const double scale = block.seen.per_z[i] * block.nearer[i] / block.disparity[i];
  const double x = scale * (view.fx * t[0] - block.seen.u[i] * t[2]);
  const double y = scale * (view.fy * t[1] - block.seen.v[i] * t[2]);
  return {x, y, 1.0 + r2 * (x * x + y * y)};
}

/// Derivatives by a rotation, from those by the translation.
void rotate(const FeatureBlock::Seen& seen, int i, Numbers* row) {
  const Numbers* by = row + LinearBlock::kTranslation;
  row += LinearBlock::kMotion;
  row[0][i] = seen.turned_y[i] * by[2][i] - seen.turned_z[i] * by[1][i];
  row[1][i] = seen.turned_z[i] * by[0][i] - seen.turned_x[i] * by[2][i];
  row[2][i] = seen.turned_x[i] * by[1][i] - seen.turned_y[i] * by[0][i];
}

}  // namespace

void fitDisparities(const FeatureView& view, double noise_ratio, FeatureBlock& __restrict block) {
  const double ratio2 = noise_ratio * noise_ratio;
  for (double& nearer : block.nearer) nearer = 1.0;
  look(view, block, block.seen);
  for (int i = 0; i < kSize; ++i) {
    const ByDisparity far = differentiate(view, block, i, ratio2);
    const double along = far.x * (block.target_x[i] - block.seen.u[i]) +
                         far.y * (block.target_y[i] - block.seen.v[i]);
    // One step: it is nearly linear. A wrong match must not become an inlier.
    const double d = block.disparity[i];
    const double least = (1.0 / kMaxStretch - 1.0) * d;
    const double most = (kMaxStretch - 1.0) * d;
    const double moved = ratio2 * along / far.s2;
    block.moved[i] = moved < least ? least : moved > most ? most : moved;
    block.nearer[i] = d / (d + block.moved[i]);
  }
  look(view, block, block.seen);
  for (int i = 0; i < kSize; ++i) {
    const ByDisparity j = differentiate(view, block, i, ratio2);
    // S^-1/2 is 1 / s along j.
    const double s = sqrt(j.s2);
    const double less = ratio2 / (s * (s + 1.0));
    block.w_xx[i] = 1.0 - less * j.x * j.x;
    block.w_xy[i] = -less * j.x * j.y;
    block.w_yy[i] = 1.0 - less * j.y * j.y;
    block.by_x[i] = j.x / s;
    block.by_y[i] = j.y / s;
  }
}

void linearize(const FeatureView& view,
               int first,
               const FeatureBlock& block,
               LinearBlock& __restrict linear) {
  constexpr int kR = LinearBlock::kResidual;
  constexpr int kT = LinearBlock::kTranslation;
  FeatureBlock::Seen other;
  if (!view.is_seen) look(view, block, other);
  const FeatureBlock::Seen& seen = view.is_seen ? block.seen : other;
  const auto whiten = [&](int i, int column, double x, double y) {
    linear.x[column][i] = block.w_xx[i] * x + block.w_xy[i] * y;
    linear.y[column][i] = block.w_xy[i] * x + block.w_yy[i] * y;
  };
  for (int i = 0; i < kSize; ++i) {
    whiten(i, kR, block.target_x[i] - seen.u[i], block.target_y[i] - seen.v[i]);
    linear.x[kR][i] += block.moved[i] * block.by_x[i];
    linear.y[kR][i] += block.moved[i] * block.by_y[i];
    linear.x[LinearBlock::kBias][i] = -block.by_x[i];
    linear.y[LinearBlock::kBias][i] = -block.by_y[i];
  }
  if (first > kT) return;
  for (int i = 0; i < kSize; ++i) {
    // The projection is subtracted from the target, hence the signs.
    const double per_z = seen.in_front[i] * seen.per_z[i];
    whiten(i, kT, -view.fx * seen.per_z[i], 0.0);
    whiten(i, kT + 1, 0.0, -view.fy * seen.per_z[i]);
    whiten(i, kT + 2, seen.u[i] * per_z, seen.v[i] * per_z);
  }
  if (first == kT) return;
  for (int i = 0; i < kSize; ++i) rotate(seen, i, linear.x);
  for (int i = 0; i < kSize; ++i) rotate(seen, i, linear.y);
}

void addProducts(const FeatureBlock& block,
                 const LinearBlock& linear,
                 int first,
                 LinearBlock::Products* __restrict sums,
                 Numbers* __restrict shared) {
  constexpr int kBias = LinearBlock::kBias;
  Numbers x, y;
  const auto weigh = [&](int column) {
    for (int i = 0; i < kSize; ++i) x[i] = block.weight[i] * linear.x[column][i];
    for (int i = 0; i < kSize; ++i) y[i] = block.weight[i] * linear.y[column][i];
  };
  const auto product = [&](int i, int b) { return x[i] * linear.x[b][i] + y[i] * linear.y[b][i]; };
  for (int a = first; a < LinearBlock::kColumns; ++a) {
    weigh(a);
    for (int b = a; b < LinearBlock::kColumns; ++b) {
      for (int i = 0; i < kSize; ++i) sums[a][b][i] += product(i, b);
    }
  }
  if (shared == nullptr) return;
  weigh(kBias);
  for (int b = kBias; b < LinearBlock::kColumns; b = b < first ? first : b + 1) {
    for (int i = 0; i < kSize; ++i) shared[b][i] = product(i, b);
  }
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
