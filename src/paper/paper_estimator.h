#pragma once

#include <string>
#include <vector>

#include "motion/motion_estimator.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// The criterion that selects inliers, see criterionNames().
enum class Criterion { kRotrocc, kReprojection, kRocc, kMeanBased, kStdBased };

/// The criterion of that name. Throws std::invalid_argument on any other name.
Criterion criterionOf(const std::string& name);

/// Section V-B as published: plain least squares, without a retry. Stage 2 starts from all features
/// and the translation of the prediction. Alternatively one of the criteria that the paper compares
/// it with.
class PaperEstimator : public MotionEstimator {
 public:
  /// Throws std::invalid_argument on an unknown criterion.
  explicit PaperEstimator(const MotionEstimatorConfig& config);

  const MotionEstimate& estimate(const StereoCamera& camera,
                                 const Correspondences& features,
                                 const Eigen::Isometry3d& initial,
                                 double dt_s,
                                 const std::optional<Eigen::Isometry3d>& prediction) override;

 private:
  bool hasFixedLimit() const;
  double rotationThreshold(double limit_px);
  bool estimateRotation(double limit_px);
  void estimateTranslation(const Measurements& measured);
  template <class Measure, class Threshold>
  bool iterate(int max_iterations,
               Unknowns unknowns,
               const Measure& measure,
               const Threshold& threshold,
               FeatureSet& set);

  Criterion criterion_;
  MotionEstimate found_;

  // Buffers, reused.
  ReprojectionProblem problem_;
  std::vector<double> errors_, set_errors_, flow_px_;
};

}  // namespace rotrocc
