#include "parameters/sections.h"

namespace rotrocc {

void addMotionEstimator(MotionEstimatorConfig& c, ParameterTable& table) {
  const std::string s = "motion_estimator/";
  table.add(s + "criterion",
            c.criterion,
            criterionNames(),
            "criterion that selects the inliers; as published only with config/paper.yaml");
  table.add(s + "noise_ratio",
            c.noise_ratio,
            0.0,
            100.0,
            "",
            "ratio of disparity noise to flow noise; 0: disparities are exact, as in the paper");
  table.add(
      s + "shared_ratio",
      c.shared_ratio,
      0.0,
      100.0,
      "",
      "ratio of the disparity error that neighbours share to flow noise, start of an estimate "
      "of at most three times this; 0: there is none, as in the paper");
  table.add(s + "robust_factor",
            c.robust_factor,
            0.0,
            1000.0,
            "",
            "residual, in standard deviations, at which the Cauchy weight is 1/2; 0: equal "
            "weights, as in the paper");
  table.add(s + "rotation_limit_px",
            c.rotation_limit_px,
            0.01,
            100.0,
            "px",
            "stage 1: termination limit of the reprojection error (Eq. 26)");
  table.add(s + "rotation_drop_share",
            c.rotation_drop_share,
            0.001,
            1.0,
            "",
            "stage 1: largest share of features dropped per iteration (b of Eq. 26)");
  table.add(s + "rotation_max_iterations",
            c.rotation_max_iterations,
            1,
            1000,
            "",
            "stage 1: largest number of iterations");
  table.add(s + "retry_share",
            c.retry_share,
            0.0,
            1.0,
            "",
            "stage 1: retry if the share of inliers is below this");
  table.add(s + "retry_agreement_px",
            c.retry_agreement_px,
            0.0,
            1000.0,
            "px",
            "stage 1: a retry starts from features with an error below this at the predicted "
            "motion; 0: no retry");
  table.add(s + "translation_limit",
            c.translation_limit,
            0.001,
            100.0,
            "",
            "stage 2: termination limit of the DNRE (Eq. 30)");
  table.add(s + "translation_noise_factor",
            c.translation_noise_factor,
            0.0,
            100.0,
            "",
            "stage 2: number of standard deviations of the noise that the limit admits where the "
            "flow is small; 0: none, as in the paper");
  table.add(s + "translation_drop_share",
            c.translation_drop_share,
            0.001,
            1.0,
            "",
            "stage 2: largest share of features dropped per iteration (b of Eq. 30)");
  table.add(s + "translation_max_iterations",
            c.translation_max_iterations,
            1,
            1000,
            "",
            "stage 2: largest number of iterations");
  table.add(s + "translation_from_prediction",
            c.translation_from_prediction,
            "stage 2: starts from the predicted translation, as in the paper, not from stage 1's");
  table.add(s + "translation_initial_px",
            c.translation_initial_px,
            0.0,
            1000.0,
            "px",
            "stage 2: starts from features with a stage-1 error below this; 0: from all");
  table.add(s + "min_speed_mps",
            c.min_speed_mps,
            0.0,
            1000.0,
            "m/s",
            "stage 2 is skipped below this speed");
  table.add(
      s + "mean_factor", c.mean_factor, 0.1, 1000.0, "", "criterion mean_based: factor of Eq. 32");
  table.add(s + "deviation_factor",
            c.deviation_factor,
            0.1,
            1000.0,
            "",
            "criterion std_based: factor of Eq. 31");
  table.add(s + "comparison_iterations",
            c.comparison_iterations,
            1,
            1000,
            "",
            "criteria mean_based and std_based: largest number of iterations");
}

}  // namespace rotrocc
