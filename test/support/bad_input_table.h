#pragma once

#include <functional>
#include <string>
#include <vector>

namespace rotrocc {

/// A kind of bad input, and what is expected of it: a row of docs/bad_inputs.md.
struct BadInput {
  int row;  ///< from 1
  std::string input;
  std::string expected;  ///< for readers
  std::function<std::string()> observe;
  std::string pattern;  ///< of all that is observed; a * stands for any text
};

/// Who observes a row: bad_inputs_test, or bad_inputs_nodelet_test where it takes a ROS master.
enum class Observer { kRig, kNodelet };

/// Observes each of `inputs`, which must be all the rows of `observer`. Expects that what is
/// observed matches, and that docs/bad_inputs.md says so.
void expectRows(Observer observer, const std::vector<BadInput>& inputs);

}  // namespace rotrocc
