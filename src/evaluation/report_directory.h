#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace rotrocc {

/// The directory of a report. A hidden file in it lists what a report has written there, so that
/// the next one removes these files, and no others.
class ReportDirectory {
 public:
  /// Creates the directory, or removes the earlier report in it. Throws std::runtime_error if it
  /// cannot be created, or has files but no report.
  explicit ReportDirectory(const std::string& directory) : directory_(directory) {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::create_directories(directory_, error);
    if (!fs::is_directory(directory_)) {
      throw std::runtime_error(directory + " cannot be created: " + error.message());
    }
    const fs::path list = directory_ / ".rotrocc_report";
    std::ifstream earlier(list);
    if (!earlier && !fs::is_empty(directory_)) {
      throw std::runtime_error(directory + " has files that are not of a report, e.g. " +
                               fs::directory_iterator(directory_)->path().filename().string() +
                               ": name an empty directory, or one that does not exist");
    }
    for (std::string name; std::getline(earlier, name);) {
      fs::remove(directory_ / fs::path(name).filename(), error);
    }
    list_.open(list);
    if (!list_) throw std::runtime_error(list.string() + " cannot be written");
  }

  /// The path of a file of the report.
  std::string path(const std::string& name) {
    list_ << name << std::endl;
    return (directory_ / name).string();
  }

 private:
  std::filesystem::path directory_;
  std::ofstream list_;
};

}  // namespace rotrocc
