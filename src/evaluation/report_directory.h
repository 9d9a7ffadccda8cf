#pragma once

#include <fstream>
#include <string>

namespace rotrocc {

/// The directory of a report. A hidden file in it lists what a report has written there, so that
/// the next one removes these files, and no others.
class ReportDirectory {
 public:
  /// Creates the directory, or removes the earlier report in it. Throws std::runtime_error if it
  /// cannot be created, or has files but no report.
  explicit ReportDirectory(const std::string& directory);

  /// The path of a file of the report.
  std::string path(const std::string& name);

 private:
  std::string directory_;
  std::ofstream list_;
};

}  // namespace rotrocc
