#include "motion/feature_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>

#include "common/median.h"

namespace rotrocc {
namespace {

/// Median length of a vector of two independent Gaussian numbers, in their standard deviations:
/// sqrt(2 ln 2).
constexpr double kMedianLength = 1.1774100225154747;

double meanOf(const std::vector<double>& errors) {
  if (errors.empty()) return std::numeric_limits<double>::infinity();
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

Eigen::Vector2d finiteProjection(const StereoCamera& camera, Eigen::Vector3d point) {
  point.z() = std::max(point.z(), kMinDepth_m);
  return camera.project(point);
}

/// Sets each value to length(feature).
template <class Length>
void measureEach(const Correspondences& features,
                 std::vector<double>& lengths_px,
                 const Length& length) {
  lengths_px.resize(features.size());
  std::transform(features.begin(), features.end(), lengths_px.begin(), length);
}

}  // namespace

double deviationOf(std::vector<double>& lengths_px) {
  return median(lengths_px) / kMedianLength;
}

void cauchyWeights(double factor,
                   const std::vector<double>& errors_px,
                   std::vector<double>& weights) {
  weights = errors_px;
  double scale_px = 0.0;
  if (factor > 0.0 && !weights.empty()) scale_px = factor * deviationOf(weights);
  for (std::size_t i = 0; i < errors_px.size(); ++i) {
    const double ratio = scale_px > 0.0 ? errors_px[i] / scale_px : 0.0;
    weights[i] = 1.0 / (1.0 + ratio * ratio);
  }
}

double fixedLimit(double limit, double drop_share, std::vector<double>& errors) {
  if (errors.empty()) return std::numeric_limits<double>::infinity();
  const double dropped = std::ceil(drop_share * static_cast<double>(errors.size()));
  const auto highest = errors.begin() + static_cast<std::ptrdiff_t>(std::max(dropped, 1.0)) - 1;
  std::nth_element(errors.begin(), highest, errors.end(), std::greater<double>());
  return std::max(*highest, limit);
}

double meanBasedLimit(double factor, const std::vector<double>& errors) {
  return factor * meanOf(errors);
}

double deviationBasedLimit(double factor, const std::vector<double>& errors) {
  const double mean = meanOf(errors);
  double squares = 0.0;
  for (const double error : errors) squares += (error - mean) * (error - mean);
  return mean +
         factor * std::sqrt(squares / std::max(static_cast<double>(errors.size()) - 1.0, 1.0));
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

int count(const FeatureSet& set) {
  return static_cast<int>(std::count(set.begin(), set.end(), static_cast<char>(1)));
}

void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px) {
  measureEach(features, errors_px, [&](const Correspondence& feature) {
    const Eigen::Vector3d point = T_keyframe_cur * feature.point_cur;
    return (feature.keyframe_px - finiteProjection(camera, point)).norm();
  });
}

void decoupledFlow(const StereoCamera& camera,
                   const Correspondences& features,
                   const Eigen::Matrix3d& R_keyframe_cur,
                   std::vector<double>& lengths_px) {
  measureEach(features, lengths_px, [&](const Correspondence& feature) {
    const Eigen::Vector3d rotated = R_keyframe_cur * feature.point_cur;       // Eq. 27
    return (feature.keyframe_px - finiteProjection(camera, rotated)).norm();  // Eq. 28
  });
}

void coupledFlow(const Correspondences& features, std::vector<double>& lengths_px) {
  measureEach(features, lengths_px, [](const Correspondence& feature) {
    return (feature.keyframe_px - feature.cur_px).norm();
  });
}

}  // namespace rotrocc
