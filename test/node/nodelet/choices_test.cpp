// Each documented value of a parameter with choices, written to a file as a user does.

#include <fstream>

#include "nodelet_drive.h"
#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

TEST(ChoicesTest, EachCanBeWrittenWithoutQuotes) {
  Parameters parameters;
  const ParameterTable table = makeParameterTable(parameters);
  std::vector<std::pair<std::string, std::string>> choices;  // names and values
  for (const auto& parameter : table.parameters()) {
    for (const std::string& choice : parameter.choices)
      choices.emplace_back(parameter.name, choice);
  }
  const TemporaryDirectory directory;
  std::ofstream file(directory / "choices.yaml");
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const auto& [name, choice] = choices[i];
    const std::size_t slash = name.find('/');
    file << "node_" << i << ":\n  ";
    if (slash != std::string::npos) file << name.substr(0, slash) << ":\n    ";
    file << name.substr(slash + 1) << ": " << choice << "\n";
  }
  file.close();
  const CommandResult loaded =
      runCommand("rosparam load " + (directory / "choices.yaml") + " /choices");
  ASSERT_EQ(loaded.status, 0) << loaded.output;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const auto& [name, choice] = choices[i];
    Parameters read = readParameters(ros::NodeHandle("/choices/node_" + std::to_string(i)));
    const ParameterTable read_table = makeParameterTable(read);
    for (const auto& parameter : read_table.parameters()) {
      if (parameter.name != name) continue;
      EXPECT_EQ(parameter.get(), choice) << name;
    }
  }
}

}  // namespace
}  // namespace rotrocc
