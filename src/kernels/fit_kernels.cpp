#include "kernels/fit_kernels.h"

// No explicit SIMD: the compiler vectorizes these loops.
namespace rotrocc::ROTROCC_INSTRUCTIONS {
namespace {

/// A fit changes the depth of a feature by at most this factor: a wrong match must not become an
/// inlier.
constexpr double kMaxStretch = 2.0;

void beginAtMeasured(const FitTerms terms, FitBlock& block) {
  const double* r = terms.rotation;
  for (int i = 0; i < FitBlock::kSize; ++i) {
    const double x = block.point_x[i];
    const double y = block.point_y[i];
    const double z = block.point_z[i];
    block.rotated_x[i] = r[0] * x + r[1] * y + r[2] * z;
    block.rotated_y[i] = r[3] * x + r[4] * y + r[5] * z;
    block.rotated_z[i] = r[6] * x + r[7] * y + r[8] * z;
    block.fitted[i] = block.measured[i];
    block.ray_x[i] = block.measured[i] * block.rotated_x[i];
    block.ray_y[i] = block.measured[i] * block.rotated_y[i];
    block.ray_z[i] = block.measured[i] * block.rotated_z[i];
  }
}

/// Projects the features at their current fitted disparities.
void project(const FitTerms terms, FitBlock& block) {
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

void improve(const FitTerms terms, FitBlock& block) {
  for (int i = 0; i < FitBlock::kSize; ++i) {
    const double j_x = block.slope_x[i];
    const double j_y = block.slope_y[i];
    const double measured = block.measured[i];
    const double along = j_x * (block.keyframe_x[i] - block.seen_x[i]) +
                         j_y * (block.keyframe_y[i] - block.seen_y[i]);
    const double next = block.fitted[i] + (terms.ratio2 * along - (block.fitted[i] - measured)) /
                                              (1.0 + terms.ratio2 * (j_x * j_x + j_y * j_y));
    const double least = measured / kMaxStretch;
    const double most = measured * kMaxStretch;
    const double not_less = next < least ? least : next;
    block.fitted[i] = not_less > most ? most : not_less;
  }
}

void describe(const FitTerms terms, FitBlock& block) {
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
    const double s = __builtin_sqrt(1.0 + terms.ratio2 * (j_x * j_x + j_y * j_y));
    const double less = terms.ratio2 / (s * (s + 1.0));
    block.whitening_xx[i] = 1.0 - less * j_x * j_x;
    block.whitening_xy[i] = -less * j_x * j_y;
    block.whitening_yy[i] = 1.0 - less * j_y * j_y;
  }
}

}  // namespace

void fitDisparities(const FitTerms terms, FitBlock& block) {
  beginAtMeasured(terms, block);
  project(terms, block);
  for (int step = 0; step < terms.steps; ++step) {
    improve(terms, block);
    project(terms, block);
  }
  describe(terms, block);
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
