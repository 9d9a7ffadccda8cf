#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace rotrocc {

/// A file for readers that need a path. It stays open, because opening and truncating files would
/// take most of the time of a small input.
class InputFile {
 public:
  explicit InputFile(const std::string& path)
      : path_(path), descriptor_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0) throw std::runtime_error("cannot write " + path);
  }
  ~InputFile() { close(descriptor_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }

  void write(std::string_view text) const {
    const auto size = static_cast<ssize_t>(text.size());
    if (pwrite(descriptor_, text.data(), text.size(), 0) != size ||
        ftruncate(descriptor_, size) != 0) {
      throw std::runtime_error("cannot write to " + path_);
    }
  }

 private:
  std::string path_;
  int descriptor_;
};

}  // namespace rotrocc
