#pragma once

#include <fstream>
#include <iomanip>
#include <stdexcept>
#include <string>
#include <vector>

namespace rotrocc {

/// A table of comma-separated values, with ten digits of numbers. Each row is in the file when it
/// ends. Members throw std::runtime_error with the path if the file cannot be written.
class CsvFile {
 public:
  /// `columns` are separated by commas.
  CsvFile(const std::string& path, const std::string& columns) : path_(path), file_(path) {
    file_ << std::setprecision(10) << columns;
    endRow();
  }

  /// Adds a cell to the current row.
  template <class Cell>
  CsvFile& operator<<(const Cell& cell) {
    file_ << separator_ << cell;
    separator_ = ",";
    return *this;
  }

  void endRow() {
    separator_ = "";
    if (!(file_ << std::endl)) throw std::runtime_error(path_ + " cannot be written");
  }

  void row(const std::vector<double>& cells) {
    for (const double cell : cells) *this << cell;
    endRow();
  }

 private:
  std::string path_;
  std::ofstream file_;
  const char* separator_ = "";
};

}  // namespace rotrocc
