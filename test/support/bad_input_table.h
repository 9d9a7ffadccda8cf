#pragma once

#include <map>
#include <string>
#include <vector>

namespace rotrocc {

/// The rows of docs/bad_inputs.md that need no ROS master. What is observed must be in the page,
/// word by word.
class BadInputTable {
 public:
  /// A kind of bad input: its row from 1, what readers expect, and what was observed, which is
  /// joined by semicolons.
  void add(int row,
           const std::string& input,
           const std::string& expected,
           const std::vector<std::string>& observed);

  /// Expects that all these rows were added, and that the page has them.
  void expectInPage() const;

 private:
  std::map<int, std::string> rows_;
};

}  // namespace rotrocc
