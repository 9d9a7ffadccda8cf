#include "evaluation/report_directory.h"

#include <filesystem>
#include <stdexcept>

namespace rotrocc {

namespace fs = std::filesystem;

ReportDirectory::ReportDirectory(const std::string& directory) : directory_(directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (!fs::is_directory(directory)) {
    throw std::runtime_error(directory + " cannot be created: " + error.message());
  }
  const fs::path list = fs::path(directory) / ".rotrocc_report";
  std::ifstream earlier(list);
  if (!earlier && !fs::is_empty(directory)) {
    throw std::runtime_error(directory + " has files that are not of a report, e.g. " +
                             fs::directory_iterator(directory)->path().filename().string() +
                             ": name an empty directory, or one that does not exist");
  }
  for (std::string name; std::getline(earlier, name);) {
    fs::remove(fs::path(directory) / fs::path(name).filename(), error);
  }
  list_.open(list);
  if (!list_) throw std::runtime_error(list.string() + " cannot be written");
}

std::string ReportDirectory::path(const std::string& name) {
  list_ << name << std::endl;
  return (fs::path(directory_) / name).string();
}

}  // namespace rotrocc
