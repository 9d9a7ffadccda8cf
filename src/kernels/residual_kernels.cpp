#include "kernels/residual_kernels.h"

// No explicit SIMD: the compiler vectorizes these loops.
namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

constexpr int kSize = ResidualBlock::kSize;

/// The features at the motion: relative to the camera without and with the translation.
struct Moved {
  ResidualBlock::Numbers turned_x, turned_y, turned_z;
  ResidualBlock::Numbers per_z;
  ResidualBlock::Numbers u, v;  // projections, from the principal point [px]
  ResidualBlock::Numbers in_front;
};

void move(const ResidualTerms& terms, const ResidualBlock& block, Moved& moved) {
  const double* r = terms.rotation;
  const double* t = terms.translation;
  for (int i = 0; i < kSize; ++i) {
    const double x = block.point_x[i];
    const double y = block.point_y[i];
    const double z = block.point_z[i];
    moved.turned_x[i] = r[0] * x + r[1] * y + r[2] * z;
    moved.turned_y[i] = r[3] * x + r[4] * y + r[5] * z;
    moved.turned_z[i] = r[6] * x + r[7] * y + r[8] * z;
  }
  for (int i = 0; i < kSize; ++i) {
    const double depth = moved.turned_z[i] + t[2];
    moved.in_front[i] = depth < terms.least_depth ? 0.0 : 1.0;
    moved.per_z[i] = 1.0 / (depth < terms.least_depth ? terms.least_depth : depth);
    moved.u[i] = terms.fx * (moved.turned_x[i] + t[0]) * moved.per_z[i];
    moved.v[i] = terms.fy * (moved.turned_y[i] + t[1]) * moved.per_z[i];
  }
}

void subtract(const ResidualBlock& block, const Moved& moved, LinearBlock& linear) {
  double* residual_x = linear.x[LinearBlock::kResidual];
  double* residual_y = linear.y[LinearBlock::kResidual];
  for (int i = 0; i < kSize; ++i) {
    const double x = block.target_x[i] - moved.u[i];
    const double y = block.target_y[i] - moved.v[i];
    residual_x[i] = block.whitening_xx[i] * x + block.whitening_xy[i] * y;
    residual_y[i] = block.whitening_xy[i] * x + block.whitening_yy[i] * y;
  }
}

}  // namespace

void linearise(const ResidualTerms terms,
               const int first,
               const ResidualBlock& block,
               LinearBlock& linear) {
  Moved moved;
  move(terms, block, moved);
  subtract(block, moved, linear);
  if (first > LinearBlock::kTranslation) return;
  auto* by_x = linear.x + LinearBlock::kTranslation;
  auto* by_y = linear.y + LinearBlock::kTranslation;
  for (int i = 0; i < kSize; ++i) {
    const double u_by_x = -terms.fx * moved.per_z[i];
    const double v_by_y = -terms.fy * moved.per_z[i];
    const double u_by_z = moved.in_front[i] * moved.u[i] * moved.per_z[i];
    const double v_by_z = moved.in_front[i] * moved.v[i] * moved.per_z[i];
    by_x[0][i] = block.whitening_xx[i] * u_by_x;
    by_x[1][i] = block.whitening_xy[i] * v_by_y;
    by_x[2][i] = block.whitening_xx[i] * u_by_z + block.whitening_xy[i] * v_by_z;
    by_y[0][i] = block.whitening_xy[i] * u_by_x;
    by_y[1][i] = block.whitening_yy[i] * v_by_y;
    by_y[2][i] = block.whitening_xy[i] * u_by_z + block.whitening_yy[i] * v_by_z;
  }
  if (first == LinearBlock::kTranslation) return;
  for (int i = 0; i < kSize; ++i) {
    const double x = moved.turned_x[i];
    const double y = moved.turned_y[i];
    const double z = moved.turned_z[i];
    linear.x[0][i] = y * by_x[2][i] - z * by_x[1][i];
    linear.x[1][i] = z * by_x[0][i] - x * by_x[2][i];
    linear.x[2][i] = x * by_x[1][i] - y * by_x[0][i];
    linear.y[0][i] = y * by_y[2][i] - z * by_y[1][i];
    linear.y[1][i] = z * by_y[0][i] - x * by_y[2][i];
    linear.y[2][i] = x * by_y[1][i] - y * by_y[0][i];
  }
}

void addColumnProducts(const int first,
                       const ResidualBlock& block,
                       const LinearBlock& linear,
                       ColumnProducts& sums) {
  for (int a = first; a < LinearBlock::kColumns; ++a) {
    ResidualBlock::Numbers x, y;
    for (int i = 0; i < kSize; ++i) {
      x[i] = block.weight[i] * linear.x[a][i];
      y[i] = block.weight[i] * linear.y[a][i];
    }
    for (int b = a; b < LinearBlock::kColumns; ++b) {
      for (int i = 0; i < kSize; ++i) {
        sums.of[a][b][i] += x[i] * linear.x[b][i] + y[i] * linear.y[b][i];
      }
    }
  }
}

void multiplyByDisparity(const int first,
                         const ResidualBlock& block,
                         const LinearBlock& linear,
                         ResidualBlock::Numbers& squares,
                         ResidualBlock::Numbers* const products) {
  ResidualBlock::Numbers x, y;
  for (int i = 0; i < kSize; ++i) {
    x[i] = block.weight[i] * block.by_disparity_x[i];
    y[i] = block.weight[i] * block.by_disparity_y[i];
    squares[i] = x[i] * block.by_disparity_x[i] + y[i] * block.by_disparity_y[i];
  }
  for (int a = first; a < LinearBlock::kColumns; ++a) {
    for (int i = 0; i < kSize; ++i) {
      products[a][i] = x[i] * linear.x[a][i] + y[i] * linear.y[a][i];
    }
  }
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
