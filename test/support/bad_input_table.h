#pragma once

#include <functional>
#include <string>
#include <vector>

namespace rotrocc {

/// A kind of bad input and the expected behaviour: a row of docs/bad_inputs.md.
struct BadInput {
  int row;  ///< from 1
  std::string input;
  std::string expected;  ///< for readers
  std::function<std::string()> observe;
  std::string pattern;  ///< must match the whole observation; a * stands for any text
};

/// The test of a row: bad_inputs_test, or bad_inputs_nodelet_test if it needs a ROS master.
enum class Observer { kRig, kNodelet };

/// Observes each of `inputs`, which must be all the rows of `observer`. Expects that the
/// observations match and that docs/bad_inputs.md contains them.
void expectRows(Observer observer, const std::vector<BadInput>& inputs);

}  // namespace rotrocc
