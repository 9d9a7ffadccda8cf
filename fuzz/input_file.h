#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "../test/temporary_directory.h"

namespace rotrocc {

/// A file for readers that take a path.
class InputFile {
 public:
  explicit InputFile(const std::string& name) : path_(directory_ / name) {}

  const std::string& path() const { return path_; }

  void write(const std::uint8_t* data, std::size_t size) const {
    std::ofstream file(path_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }

 private:
  TemporaryDirectory directory_;
  std::string path_;
};

}  // namespace rotrocc
