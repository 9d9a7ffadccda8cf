#pragma once

#include <string>

namespace rotrocc {

/// Which features are inliers, see criterionNames().
enum class Criterion { kRotrocc, kReprojection, kRocc, kMeanBased, kStdBased };

/// Throws std::invalid_argument if there is no criterion of that name.
Criterion criterionOf(const std::string& name);

/// Whether the criterion has a translation stage.
constexpr bool hasTwoStages(Criterion criterion) {
  return criterion == Criterion::kRotrocc || criterion == Criterion::kRocc;
}

/// Whether the criterion has a fixed limit of the reprojection error in stage 1.
constexpr bool hasFixedLimit(Criterion criterion) {
  return criterion != Criterion::kMeanBased && criterion != Criterion::kStdBased;
}

}  // namespace rotrocc
