#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstring>
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
    require(directory);
    namespace fs = std::filesystem;
    std::error_code error;
    fs::create_directories(directory_, error);
    if (!fs::is_directory(directory_)) {
      throw std::runtime_error(directory + " cannot be created: " + error.message());
    }
    const fs::path list = directory_ / kList;
    std::ifstream earlier(list);
    for (std::string name; std::getline(earlier, name);) {
      fs::remove(directory_ / fs::path(name).filename(), error);
    }
    earlier.close();
    list_.open(list);
    if (!list_) throw std::runtime_error(list.string() + " cannot be written");
  }

  /// Throws what the constructor would, before there is a report to write; changes nothing.
  static void require(const std::string& directory) {
    namespace fs = std::filesystem;
    if (fs::exists(directory) && !fs::is_directory(directory)) {
      throw std::runtime_error(directory + " cannot be created: there is a file of that name");
    }
    fs::path existing = fs::absolute(directory).lexically_normal();
    while (!fs::exists(existing)) existing = existing.parent_path();
    if (::access(existing.c_str(), W_OK | X_OK) != 0) {
      throw std::runtime_error(directory + " cannot be written: " + std::strerror(errno));
    }
    if (!fs::exists(directory) || fs::is_empty(directory)) return;
    if (fs::exists(fs::path(directory) / kList)) return;
    throw std::runtime_error(directory + " has files that are not of a report, e.g. " +
                             fs::directory_iterator(directory)->path().filename().string() +
                             ": name an empty directory, or one that does not exist");
  }

  /// The path of a file of the report.
  std::string path(const std::string& name) {
    list_ << name << std::endl;
    return (directory_ / name).string();
  }

 private:
  static constexpr const char* kList = ".rotrocc_report";

  std::filesystem::path directory_;
  std::ofstream list_;
};

}  // namespace rotrocc
