#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "kernels/kernels.h"
#include "motion/feature_errors.h"
#include "motion/fitted_feature.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Divides an image into cells of equal size, numbered row by row.
class ImageGrid {
 public:
  ImageGrid(const StereoCamera& camera, int columns, int rows)
      : columns_(columns),
        rows_(rows),
        columns_per_px_(static_cast<double>(columns) / camera.width),
        rows_per_px_(static_cast<double>(rows) / camera.height) {}

  /// The cell of a pixel. Pixels outside the image belong to the nearest cell.
  std::size_t cell(const Eigen::Vector2d& pixel) const {
    const int column = std::clamp(static_cast<int>(pixel.x() * columns_per_px_), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(pixel.y() * rows_per_px_), 0, rows_ - 1);
    return static_cast<std::size_t>(row * columns_ + column);
  }

 private:
  int columns_;
  int rows_;
  double columns_per_px_;
  double rows_per_px_;
};

/// Neighboring features share an error of their disparities: what calibration and rectification
/// leave of the lenses, and texture that their windows have in common. The image is divided into
/// cells, and the features of a cell share one unknown error.
///
/// What the lenses leave is also smooth over the whole image. On KITTI most of it is a parabola
/// over the rows, see parabolaOverRows().
struct SharedErrorGrid : ImageGrid {
  static constexpr int kColumns = 12;
  static constexpr int kRows = 4;
  static constexpr std::size_t kCells = kColumns * kRows;

  explicit SharedErrorGrid(const StereoCamera& camera) : ImageGrid(camera, kColumns, kRows) {}
};

/// Ratio of the standard deviation of a cell's error to the flow noise: 2.4 to 6 on the rigs of
/// KITTI, Karlsruhe and EuRoC.
constexpr double kSharedRatio = 3.0;

/// The same ratio for a smooth error at the borders of the image: 0.6 times kSharedRatio.
constexpr double kSmoothRatio = 1.8;

/// y^2 of a pixel, where y is -1 at the top and 1 at the bottom of the image.
inline double parabolaOverRows(const StereoCamera& camera, const Eigen::Vector2d& pixel) {
  const double y = 2.0 * pixel.y() / camera.height - 1.0;
  return y * y;
}

/// Least squares over a set of fitted features: residuals W (target - pi(R X + T)) [px], Jacobian
/// and weights.
///
/// With kParameters = 6 the parameters are a rotation vector relative to R_0, the rotation of the
/// fit, and the translation (Eq. 25): R = Exp(p[0..2]) R_0, T = p[3..5]. With kParameters = 3 they
/// are the translation alone, and the rotation is R_0 (Eq. 29).
template <int kParameters>
class ReprojectionProblem {
 public:
  using Parameters = Eigen::Matrix<double, kParameters, 1>;

  /// The residual of one feature.
  struct Residual {
    std::size_t feature;  ///< index among all features of the pair
    std::size_t cell;     ///< of SharedErrorGrid
    double parabola;      ///< parabolaOverRows()
    double weight;        ///< of both rows
    Eigen::Vector2d residual_px;
    Eigen::Vector2d by_disparity;  ///< derivative by an error of the disparity, up to the sign
  };

  /// The same with derivatives by a rotation applied after that of the parameters, and by the
  /// translation.
  struct Term : Residual {
    Eigen::Matrix<double, 2, kParameters> jacobian;
  };

  /// sum w [J r]^T [J r]: J^T J, with J^T r in the last column and r^T r in the lower right corner.
  using NormalMatrix = Eigen::Matrix<double, kParameters + 1, kParameters + 1>;

  /// Takes the features flagged in `set`, with equal weights.
  void assign(const StereoCamera& camera, const Fit& fit, const FeatureSet& set);

  /// Weights the features by their residuals at `parameters`, using cauchyWeights() with the given
  /// factor.
  void weigh(const Parameters& parameters, double robust_factor);

  /// Replaces the weights by their squares.
  void squareWeights();

  /// Adds an unknown for each cell of SharedErrorGrid, a disparity error that its features share.
  /// Its standard deviation is `cell_ratio` times that of a flow. One more unknown is a disparity
  /// error that grows with parabolaOverRows(). At the top and the bottom of the image it has a
  /// standard deviation of `parabola_ratio` times that of a flow. The unknowns are eliminated
  /// (Schur complement) from normalMatrix() and cost(). A ratio of 0: there are none, as after
  /// assign(). The parabola needs the cells.
  void shareErrors(double cell_ratio, double parabola_ratio);

  /// The parameters of the motion of the fit.
  Parameters start() const;

  Eigen::Isometry3d motionAt(const Parameters& parameters) const;

  std::size_t size() const { return indices_.size(); }

  /// Calls visit(const Term&) for each feature, in order.
  template <class Visit>
  void linearize(const Parameters& parameters, Visit&& visit) const {
    const MotionTerms terms = termsAt(parameters);
    LinearBlock linear;
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      const std::size_t lane = i % kSize;
      if (lane == 0) chooseKernels().linearize(terms, kFirst, blocks_[i / kSize], linear);
      Term term;
      static_cast<Residual&>(term) = residualOf(i, linear);
      for (int column = 0; column < kParameters; ++column) {
        term.jacobian(0, column) = linear.x[kFirst + column][lane];
        term.jacobian(1, column) = linear.y[kFirst + column][lane];
      }
      visit(static_cast<const Term&>(term));
    }
  }

  /// Calls visit(const Residual&) for each feature, in order.
  template <class Visit>
  void visitResiduals(const Parameters& parameters, const Visit& visit) const {
    const MotionTerms terms = termsAt(parameters);
    LinearBlock linear;
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      if (i % kSize == 0) {
        chooseKernels().linearize(terms, LinearBlock::kResidual, blocks_[i / kSize], linear);
      }
      visit(residualOf(i, linear));
    }
  }

  /// The products of a feature with g, its derivative by an error of the disparity.
  struct ByDisparity {
    std::size_t feature, cell;                          ///< as those of Residual
    double parabola;                                    ///< likewise
    double information;                                 ///< w g^T g
    Eigen::Matrix<double, kParameters + 1, 1> product;  ///< w [J r]^T g
  };

  /// The normal matrix with derivatives as those of Term. Calls visit(const ByDisparity&) for each
  /// feature, in order, unless it is null.
  template <class Visit>
  NormalMatrix sumTerms(const Parameters& parameters, const Visit& visit) const {
    const Kernels& kernels = chooseKernels();
    const MotionTerms terms = termsAt(parameters);
    LinearBlock linear;
    ColumnProducts sums = {};
    for (std::size_t first = 0; first < size(); first += kSize) {
      const ResidualBlock& block = blocks_[first / kSize];
      kernels.linearize(terms, kFirst, block, linear);
      kernels.addColumnProducts(kFirst, block, linear, sums);
      if constexpr (!std::is_null_pointer_v<Visit>) visitByDisparity(first, block, linear, visit);
    }
    return normalMatrixOf(sums);
  }

  /// The normal matrix of all terms by the parameters, without shared errors.
  NormalMatrix normalMatrix(const Parameters& parameters) const;

  /// Sum of w |r|^2, without the part that shared errors explain.
  double cost(const Parameters& parameters) const;

  // For ceres::TinySolver: a problem with few residuals and the same J^T J, J^T r and r^T r. The
  // solver uses nothing else.
  using Scalar = double;
  enum { NUM_RESIDUALS = kParameters + 1, NUM_PARAMETERS = kParameters };
  bool operator()(const double* parameters, double* residuals, double* jacobian) const;

 private:
  static constexpr bool kRotates = kParameters == 6;
  static constexpr std::size_t kSize = ResidualBlock::kSize;
  static constexpr int kFirst = LinearBlock::kResidual - kParameters;  // column of the blocks

  MotionTerms termsAt(const Parameters& parameters) const;

  static NormalMatrix normalMatrixOf(const ColumnProducts& sums);

  template <class Visit>
  void visitByDisparity(std::size_t first,
                        const ResidualBlock& block,
                        const LinearBlock& linear,
                        const Visit& visit) const {
    ResidualBlock::Numbers information;
    ResidualBlock::Numbers products[LinearBlock::kColumns];
    chooseKernels().multiplyByDisparity(kFirst, block, linear, information, products);
    ByDisparity by_disparity;
    for (std::size_t i = first; i < std::min(first + kSize, size()); ++i) {
      const std::size_t lane = i - first;
      by_disparity.feature = indices_[i];
      by_disparity.cell = cells_[i];
      by_disparity.parabola = parabolas_[i];
      by_disparity.information = information[lane];
      for (int column = 0; column <= kParameters; ++column) {
        by_disparity.product[column] = products[kFirst + column][lane];
      }
      visit(static_cast<const ByDisparity&>(by_disparity));
    }
  }

  Residual residualOf(std::size_t i, const LinearBlock& linear) const {
    const ResidualBlock& block = blocks_[i / kSize];
    const std::size_t lane = i % kSize;
    return {indices_[i],
            cells_[i],
            parabolas_[i],
            block.weight[lane],
            {linear.x[LinearBlock::kResidual][lane], linear.y[LinearBlock::kResidual][lane]},
            {block.by_disparity_x[lane], block.by_disparity_y[lane]}};
  }

  StereoCamera camera_;
  Eigen::Isometry3d T_keyframe_cur_;  // of the fit
  std::vector<std::size_t> indices_;
  std::vector<ResidualBlock> blocks_;        // what is free in the last one has no weight
  std::vector<std::size_t> cells_;           // of SharedErrorGrid
  std::vector<double> parabolas_;            // parabolaOverRows()
  double inverse_cell_variance_ = 0.0;       // 0: no shared errors
  double inverse_parabola_variance_ = 0.0;   // 0: no parabola
  std::vector<double> errors_px_, weights_;  // reused
};

}  // namespace rotrocc
