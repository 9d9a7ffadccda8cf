#include "motion/motion_solver.h"

#include "motion/shared_error.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

constexpr std::size_t kMinForMotion = 3;
constexpr std::size_t kMinForTranslation = 2;

}  // namespace

bool MotionSolver::solveMotion(const Measurements& measured, const FeatureSet& set, Fit& fit) {
  motion_problem_.assign(measured.camera, fit, set);
  if (motion_problem_.size() < kMinForMotion) return false;
  Vector6d parameters = motion_problem_.start();
  motion_problem_.weigh(parameters, options_.robust_factor);
  // Without the parabola: a rotation hardly depends on disparities, and needs all features.
  if (options_.shares_errors) motion_problem_.shareErrors(measured.shared_ratio, 0.0);
  if (!minimise(motion_problem_, options_.minimise, parameters)) return false;
  Eigen::Isometry3d T_keyframe_cur = fit.T_keyframe_cur;
  const Eigen::Matrix3d R = expRotation(parameters.head<3>()) * T_keyframe_cur.linear();
  T_keyframe_cur.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T_keyframe_cur.translation() = parameters.tail<3>();
  fitAt(measured, T_keyframe_cur, fit);
  return true;
}

bool MotionSolver::solveTranslation(const Measurements& measured, const FeatureSet& set, Fit& fit) {
  translation_problem_.assign(measured.camera, fit, set);
  if (translation_problem_.size() < kMinForTranslation) return false;
  Eigen::Vector3d translation = translation_problem_.start();
  translation_problem_.weigh(translation, options_.robust_factor);
  if (options_.shares_errors) {
    translation_problem_.shareErrors(measured.shared_ratio, kSmoothShare * measured.shared_ratio);
  }
  if (!minimise(translation_problem_, options_.minimise, translation)) return false;
  Eigen::Isometry3d T_keyframe_cur = fit.T_keyframe_cur;
  T_keyframe_cur.translation() = translation;
  fitAt(measured, T_keyframe_cur, fit);
  return true;
}

}  // namespace rotrocc
