#pragma once

#include <string>
#include <vector>

#include "motion/motion_estimator.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Section V-B as published: plain least squares, without a retry. Stage 2 starts from all features
/// and the translation of the prediction. Alternatively one of the criteria that the paper compares
/// it with.
class PaperEstimator : public MotionEstimator {
 public:
  /// `criterion`: one of criterionNames().
  explicit PaperEstimator(const std::string& criterion) : criterion_(criterion) {}

  const MotionEstimate& estimate(const StereoCamera& camera,
                                 const Correspondences& features,
                                 const Eigen::Isometry3d& initial,
                                 double dt_s,
                                 const std::optional<Eigen::Isometry3d>& prediction) override;

 private:
  void estimateTranslation(const Measurements& measured);
  template <class Measure>
  bool iterate(Unknowns unknowns, double limit, const Measure& measure, FeatureSet& set);
  double threshold(double limit);

  std::string criterion_;
  MotionEstimate found_;

  // Buffers, reused.
  ReprojectionProblem problem_;
  std::vector<double> errors_, set_errors_, flow_px_;
};

}  // namespace rotrocc
