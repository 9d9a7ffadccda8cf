#include "rotrocc/visual_odometry.h"

#include "odometry/odometry_pipeline.h"

namespace rotrocc {

const char* toString(State state) {
  switch (state) {
    case State::kInitialising:
      return "initialising";
    case State::kOk:
      return "ok";
    case State::kDegraded:
      return "degraded";
    case State::kLost:
      return "lost";
  }
  return "unknown";
}

VisualOdometry::VisualOdometry(const Config& config)
    : pipeline_(std::make_unique<Pipeline>(config)) {}
VisualOdometry::~VisualOdometry() = default;
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;

OdometryResult VisualOdometry::process(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const std::optional<Eigen::Isometry3d>& expected,
                                       const RotationSource& measured_rotation) {
  return pipeline_->process(pair, camera, {expected, measured_rotation});
}

void VisualOdometry::prepare() {
  pipeline_->prepare();
}

void VisualOdometry::reset() {
  pipeline_->reset();
}

void VisualOdometry::configure(const Config& config) {
  pipeline_->configure(config);
}

const Correspondences& VisualOdometry::correspondences() const {
  return pipeline_->correspondences();
}
const FeatureSet& VisualOdometry::rotationInliers() const {
  return pipeline_->rotationInliers();
}
const FeatureSet& VisualOdometry::translationInliers() const {
  return pipeline_->translationInliers();
}

}  // namespace rotrocc
