#include "motion/feature_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "common/median.h"

namespace rotrocc {
namespace {

/// Median length of a vector of two independent Gaussian numbers, in their standard deviations:
/// sqrt(2 ln 2).
constexpr double kMedianLength = 1.1774100225154747;

/// Lower limit of the flow [px], so that normalized errors stay finite without flow.
constexpr double kMinFlow_px = 1e-6;

}  // namespace

double deviationOf(std::vector<double>& lengths_px) {
  return median(lengths_px) / kMedianLength;
}

double cauchyWeights(double factor,
                     const std::vector<double>& errors_px,
                     std::vector<double>& weights) {
  weights = errors_px;
  const double deviation_px = weights.empty() ? 0.0 : deviationOf(weights);
  const double scale_px = factor * deviation_px;
  for (std::size_t i = 0; i < errors_px.size(); ++i) {
    const double ratio = scale_px > 0.0 ? errors_px[i] / scale_px : 0.0;
    weights[i] = 1.0 / (1.0 + ratio * ratio);
  }
  return deviation_px;
}

double fixedLimit(double limit, double drop_share, std::vector<double>& errors) {
  if (errors.empty()) return std::numeric_limits<double>::infinity();
  const double dropped = std::ceil(drop_share * static_cast<double>(errors.size()));
  const auto highest = errors.begin() + static_cast<std::ptrdiff_t>(std::max(dropped, 1.0)) - 1;
  std::nth_element(errors.begin(), highest, errors.end(), std::greater<double>());
  return std::max(*highest, limit);
}

bool keepBelow(const std::vector<double>& errors, double threshold, FeatureSet& set) {
  bool changed = false;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const char kept = errors[i] < threshold ? 1 : 0;
    changed = changed || kept != set[i];
    set[i] = kept;
  }
  return changed;
}

double medianFlow_px(const Correspondences& features, const FeatureSet& set) {
  thread_local std::vector<double> flows_px;  // buffer
  flows_px.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] != 0) flows_px.push_back((features[i].cur_px - features[i].keyframe_px).norm());
  }
  return flows_px.empty() ? 0.0 : median(flows_px);
}

int count(const FeatureSet& set) {
  return static_cast<int>(std::count(set.begin(), set.end(), static_cast<char>(1)));
}

void reprojectionErrors(const Measurements& measured,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px) {
  errors_px.clear();
  for (const Correspondence& feature : measured.features) {
    Eigen::Vector3d point = T_keyframe_cur * feature.point_cur;
    point.z() = std::max(point.z(), kMinDepth_m);
    errors_px.push_back((feature.keyframe_px - measured.camera.project(point)).norm());
  }
}

void decoupledFlow(const Measurements& measured,
                   const Eigen::Isometry3d& T_keyframe_cur,
                   std::vector<double>& lengths_px) {
  Eigen::Isometry3d rotation = T_keyframe_cur;
  rotation.translation().setZero();
  reprojectionErrors(measured, rotation, lengths_px);
}

void normalizedErrors(const Measurements& measured,
                      const Eigen::Isometry3d& T_keyframe_cur,
                      const std::vector<double>& flow_px,
                      std::vector<double>& errors) {
  reprojectionErrors(measured, T_keyframe_cur, errors);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] /= std::max(flow_px[i], kMinFlow_px);
}

}  // namespace rotrocc
