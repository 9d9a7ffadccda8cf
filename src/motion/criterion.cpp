#include "motion/criterion.h"

#include <algorithm>
#include <stdexcept>

#include "rotrocc/odometry_config.h"

namespace rotrocc {

const std::vector<std::string>& criterionNames() {
  static const std::vector<std::string> names = {
      "rotrocc", "reprojection", "rocc", "mean_based", "std_based"};
  return names;
}

Criterion criterionOf(const std::string& name) {
  const auto& names = criterionNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument(
        "criterion is \"" + name +
        "\", but must be rotrocc, reprojection, rocc, mean_based or std_based");
  }
  return static_cast<Criterion>(found - names.begin());
}

}  // namespace rotrocc
