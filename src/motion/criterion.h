#pragma once

#include <string>

namespace rotrocc {

/// The criterion that selects inliers, see criterionNames().
enum class Criterion { kRotrocc, kReprojection, kRocc, kMeanBased, kStdBased };

/// The criterion of that name. Throws std::invalid_argument on any other name.
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
