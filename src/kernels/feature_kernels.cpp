#include "kernels/feature_kernels.h"

// No explicit SIMD: the compiler vectorizes these loops.
namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

/// Rotates the points of a block.
template <class Block>
void rotate(const double* r,
            const Block& block,
            typename Block::Numbers& rotated_x,
            typename Block::Numbers& rotated_y,
            typename Block::Numbers& rotated_z) {
  for (int i = 0; i < Block::kSize; ++i) {
    const double x = block.point_x[i];
    const double y = block.point_y[i];
    const double z = block.point_z[i];
    rotated_x[i] = r[0] * x + r[1] * y + r[2] * z;
    rotated_y[i] = r[3] * x + r[4] * y + r[5] * z;
    rotated_z[i] = r[6] * x + r[7] * y + r[8] * z;
  }
}

/// A fit changes the depth of a feature by at most this factor: a wrong match must not become an
/// inlier.
constexpr double kMaxStretch = 2.0;

void beginAtMeasured(const MotionTerms terms, FitBlock& block) {
  rotate(terms.rotation, block, block.rotated_x, block.rotated_y, block.rotated_z);
  for (int i = 0; i < FitBlock::kSize; ++i) {
    block.fitted[i] = block.measured[i];
    block.ray_x[i] = block.measured[i] * block.rotated_x[i];
    block.ray_y[i] = block.measured[i] * block.rotated_y[i];
    block.ray_z[i] = block.measured[i] * block.rotated_z[i];
  }
}

/// Projects the features at their current fitted disparities.
void project(const MotionTerms terms, FitBlock& block) {
  const double* t = terms.translation;
  for (int i = 0; i < FitBlock::kSize; ++i) {
    const double disparity = block.fitted[i];
    const double depth = block.ray_z[i] + disparity * t[2];  // times disparity, like x and y
    const double least = terms.least_depth * disparity;
    const double per_z = 1.0 / (depth < least ? least : depth);
    const double x = per_z * (block.ray_x[i] + disparity * t[0]);
    const double y = per_z * (block.ray_y[i] + disparity * t[1]);
    block.seen_x[i] = terms.fx * x + terms.cx;
    block.seen_y[i] = terms.fy * y + terms.cy;
    block.slope_x[i] = terms.fx * per_z * (t[0] - x * t[2]);
    block.slope_y[i] = terms.fy * per_z * (t[1] - y * t[2]);
  }
}

void improve(const double ratio2, FitBlock& block) {
  for (int i = 0; i < FitBlock::kSize; ++i) {
    const double j_x = block.slope_x[i];
    const double j_y = block.slope_y[i];
    const double measured = block.measured[i];
    const double along = j_x * (block.keyframe_x[i] - block.seen_x[i]) +
                         j_y * (block.keyframe_y[i] - block.seen_y[i]);
    const double next = block.fitted[i] + (ratio2 * along - (block.fitted[i] - measured)) /
                                              (1.0 + ratio2 * (j_x * j_x + j_y * j_y));
    const double least = measured / kMaxStretch;
    const double most = measured * kMaxStretch;
    const double not_less = next < least ? least : next;
    block.fitted[i] = not_less > most ? most : not_less;
  }
}

void describe(const double ratio2, FitBlock& block) {
  for (int i = 0; i < FitBlock::kSize; ++i) {
    const double j_x = block.slope_x[i];
    const double j_y = block.slope_y[i];
    const double moved = block.fitted[i] - block.measured[i];
    const double nearer = block.measured[i] / block.fitted[i];
    block.target_x[i] = block.keyframe_x[i] + moved * j_x;
    block.target_y[i] = block.keyframe_y[i] + moved * j_y;
    block.rotated_x[i] *= nearer;
    block.rotated_y[i] *= nearer;
    block.rotated_z[i] *= nearer;
    // (I + r^2 j j^T)^-1/2: 1 / s along j, where s^2 = 1 + r^2 j^2.
    const double s = __builtin_sqrt(1.0 + ratio2 * (j_x * j_x + j_y * j_y));
    const double less = ratio2 / (s * (s + 1.0));
    block.whitening_xx[i] = 1.0 - less * j_x * j_x;
    block.whitening_xy[i] = -less * j_x * j_y;
    block.whitening_yy[i] = 1.0 - less * j_y * j_y;
  }
}

constexpr int kSize = ResidualBlock::kSize;

/// The features at the motion: relative to the camera without and with the translation.
struct Moved {
  ResidualBlock::Numbers turned_x, turned_y, turned_z;
  ResidualBlock::Numbers per_z;
  ResidualBlock::Numbers u, v;  // projections, from the principal point [px]
  ResidualBlock::Numbers in_front;
};

void move(const MotionTerms& terms, const ResidualBlock& block, Moved& moved) {
  const double* t = terms.translation;
  rotate(terms.rotation, block, moved.turned_x, moved.turned_y, moved.turned_z);
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

void fitDisparities(const MotionTerms terms,
                    const double ratio2,
                    const int steps,
                    FitBlock& block) {
  beginAtMeasured(terms, block);
  project(terms, block);
  for (int step = 0; step < steps; ++step) {
    improve(ratio2, block);
    project(terms, block);
  }
  describe(ratio2, block);
}

void linearize(const MotionTerms terms,
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
