#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "motion/fitted_feature.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Finds how noisy disparities and flows are.
///
/// A wrong disparity moves a feature's projection along j = d pi / d disparity, and only along it:
/// residuals across j are of the flow alone, those along j have 1 + r^2 |j|^2 times their variance.
/// The likelihood's score for r^2 compares both; it is summed over the pairs together with its
/// information, which makes one step of Fisher's scoring a pair. Both are taken within the cells of
/// a grid, as deviations from what the features of a cell have in common: errors of lens and rig
/// are no noise, and a weight does not mend them.
class NoiseEstimator {
 public:
  using Config = NoiseEstimatorConfig;

  /// `ratio` is what to begin with; 0, all residuals alike, stays so.
  NoiseEstimator(const Config& config, double ratio);

  /// Takes other parameters. What was found stays, unless the ratio is to begin elsewhere or to
  /// stay.
  void configure(const Config& config, double ratio);

  const MeasurementNoise& noise() const { return noise_; }

  /// Takes a motion estimated from the flagged features.
  void observe(const StereoCamera& camera,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_prev_cur);

  /// Forgets everything: the camera is another one.
  void reset();

 private:
  /// A residual, its part along j and the one across.
  struct Residual {
    std::size_t cell;
    double j2;  // |j|^2
    double along_px;
    double across_px;
  };
  /// What the residuals of a cell have in common: an error of all disparities, and one across.
  struct Cell {
    int features = 0;
    double information = 0.0;
    double along_px = 0.0;
    double across_px = 0.0;
  };

  void collect(const StereoCamera& camera,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_prev_cur);
  void update();

  Config config_;
  double first_ratio_;
  MeasurementNoise noise_;

  // Sums over the pairs, each with its weight.
  double features_ = 0.0;
  double across_px2_ = 0.0;
  double ratio_information_ = 0.0;
  double ratio_weighted_ = 0.0;  // information times r^2

  Fit fit_;
  std::vector<Residual> residuals_;
  std::vector<Cell> cells_;
};

}  // namespace rotrocc
