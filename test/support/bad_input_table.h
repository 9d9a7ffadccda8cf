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

/// Observes each of `inputs`, which must be all rows that need no ROS master. Expects that the
/// observations match and that docs/bad_inputs.md contains them.
void expectRows(const std::vector<BadInput>& inputs);

}  // namespace rotrocc
