#include "evaluation/trajectory_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "evaluation/pose_text.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// Written at once.
constexpr off_t kPart_bytes = 1 << 16;

std::system_error failure(int error, const std::string& what) {
  return std::system_error(error, std::generic_category(), what);
}

/// What is not a file, in words.
std::string nameOf(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "a directory";
    case fs::file_type::fifo:
      return "a FIFO";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::character:
    case fs::file_type::block:
      return "a device";
    default:
      return "not a file";
  }
}

/// The file that a path leads to, through links.
std::string targetOf(const std::string& path) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(fs::absolute(path), error);
  return error ? path : target.string();
}

/// A name in the same directory that no other has.
std::string temporaryName(const std::string& target) {
  static std::atomic<unsigned> count{0};
  return target + "." + std::to_string(getpid()) + "-" + std::to_string(++count) + ".tmp";
}

/// So that the new name of a file survives a power failure.
void syncDirectoryOf(const std::string& path) {
  const int descriptor = ::open(fs::path(path).parent_path().c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;  // it may be written without being readable
  ::fsync(descriptor);
  ::close(descriptor);
}

void requireDirectoryOf(const std::string& path) {
  const fs::path directory = fs::absolute(path).parent_path();
  if (::access(directory.c_str(), W_OK | X_OK) == 0) return;
  throw failure(errno, "cannot write " + path + " into its directory");
}

}  // namespace

void requireFile(const std::string& path) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type == fs::file_type::none) throw failure(error.value(), "cannot write " + path);
  if (type != fs::file_type::regular && type != fs::file_type::not_found) {
    throw std::runtime_error("cannot write " + path + ": it is " + nameOf(type) +
                             ", give the name of a file");
  }
  requireDirectoryOf(path);
}

TrajectoryFile::TrajectoryFile(const std::string& path,
                               TrajectoryFormat format,
                               const std::string& name)
    : name_(name),
      format_(format),
      descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw failure(errno, "cannot write " + name);
  preparePoseText(text_);
}

TrajectoryFile::~TrajectoryFile() {
  ::close(descriptor_);
}

void TrajectoryFile::add(const StampedPose& pose) {
  writePose(pose, format_, text_);
  if (text_.tellp() >= kPart_bytes) flush();
}

void TrajectoryFile::flush() {
  const std::string text = text_.str();
  text_.str("");
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = ::write(descriptor_, text.data() + written, text.size() - written);
    if (count >= 0) {
      written += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      int error = errno;
      const std::size_t whole_lines = text.substr(0, written).rfind('\n') + 1;
      size_ += static_cast<off_t>(whole_lines);
      if (::ftruncate(descriptor_, size_) != 0) error = errno;
      throw failure(error, "cannot write to " + name_);
    }
  }
  size_ += static_cast<off_t>(text.size());
}

void TrajectoryFile::sync() {
  // Some file systems do not know fsync().
  if (::fsync(descriptor_) != 0 && errno != EINVAL)
    throw failure(errno, "cannot write to " + name_);
}

TrajectoryReplacement::TrajectoryReplacement(const std::string& path, TrajectoryFormat format)
    : target_(targetOf(path)), temporary_(temporaryName(target_)) {
  requireFile(path);
  struct stat old {};
  const bool replaces = ::stat(target_.c_str(), &old) == 0;
  if (replaces && ::access(target_.c_str(), W_OK) != 0) {
    throw failure(errno, "cannot write " + path);
  }
  file_.emplace(temporary_, format, path);
  if (replaces) ::chmod(temporary_.c_str(), old.st_mode & 07777);
}

TrajectoryReplacement::~TrajectoryReplacement() {
  if (file_) ::unlink(temporary_.c_str());
}

void TrajectoryReplacement::finish() {
  file_->flush();
  file_->sync();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw failure(errno, "cannot replace " + target_);
  }
  file_.reset();
  syncDirectoryOf(target_);
}

}  // namespace rotrocc
