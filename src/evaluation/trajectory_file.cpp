#include "evaluation/trajectory_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// Written at once.
constexpr std::size_t kPart_bytes = 1 << 16;

/// The line of a pose, with its end.
std::string poseLine(const StampedPose& pose, TrajectoryFormat format) {
  static const Eigen::IOFormat kInOneLine(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", " ");
  std::ostringstream line;
  line.imbue(std::locale::classic());  // no decimal comma
  line.precision(9);
  if (format == TrajectoryFormat::kKitti) {
    line << std::scientific << pose.T_world_body.affine().format(kInOneLine) << '\n';
    return line.str();
  }
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  Eigen::Quaterniond quaternion(pose.T_world_body.linear());
  quaternion.normalize();
  if (quaternion.w() < 0.0) quaternion.coeffs() *= -1.0;
  line << cv::format("%s%lld.%09lld ",
                     pose.stamp_ns < 0 ? "-" : "",
                     std::llabs(pose.stamp_ns / kSecond_ns),
                     std::llabs(pose.stamp_ns % kSecond_ns))
       << std::fixed << pose.T_world_body.translation().transpose().format(kInOneLine) << ' '
       << quaternion.coeffs().transpose().format(kInOneLine) << '\n';  // x y z w
  return line.str();
}

std::system_error failure(int error, const std::string& what) {
  return std::system_error(error, std::generic_category(), what);
}

/// What is not a file, in words.
std::string nameOf(const fs::file_status& status) {
  if (fs::is_directory(status)) return "a directory";
  if (fs::is_fifo(status)) return "a FIFO";
  if (fs::is_socket(status)) return "a socket";
  const bool is_device = fs::is_character_file(status) || fs::is_block_file(status);
  return is_device ? "a device" : "not a file";
}

}  // namespace

void requireFile(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::status_known(status)) throw failure(error.value(), "cannot write " + path);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw std::runtime_error("cannot write " + path + ": it is " + nameOf(status) +
                             ", give the name of a file");
  }
  if (::access(fs::absolute(path).parent_path().c_str(), W_OK | X_OK) == 0) return;
  throw failure(errno, "cannot write " + path + " into its directory");
}

TrajectoryWriter::TrajectoryWriter(const std::string& path, TrajectoryFormat format)
    : path_(path), format_(format), file_(path) {
  if (!file_) throw std::runtime_error("cannot write " + path_);
}

void TrajectoryWriter::write(const StampedPose& pose) {
  file_ << poseLine(pose, format_) << std::flush;
  if (!file_) throw std::runtime_error("cannot write to " + path_ + ": is the disk full?");
}

TrajectoryFile::TrajectoryFile(const std::string& path,
                               TrajectoryFormat format,
                               const std::string& name)
    : name_(name),
      format_(format),
      descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw failure(errno, "cannot write " + name);
}

TrajectoryFile::~TrajectoryFile() {
  ::close(descriptor_);
}

void TrajectoryFile::add(const StampedPose& pose) {
  if (text_.size() >= kPart_bytes) flush();
  text_ += poseLine(pose, format_);
}

void TrajectoryFile::flush() {
  for (std::size_t written = 0; written < text_.size();) {
    const ssize_t count = ::write(descriptor_, text_.data() + written, text_.size() - written);
    if (count >= 0) {
      written += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      int error = errno;
      const std::size_t whole_lines = text_.substr(0, written).rfind('\n') + 1;
      text_.erase(0, whole_lines);
      const off_t end =
          ::lseek(descriptor_, 0, SEEK_CUR) - static_cast<off_t>(written - whole_lines);
      // What may be written later begins there too, not after a gap.
      if (::ftruncate(descriptor_, end) != 0 || ::lseek(descriptor_, end, SEEK_SET) < 0) {
        error = errno;
      }
      throw failure(error, "cannot write to " + name_);
    }
  }
  text_.clear();
}

void TrajectoryFile::sync() {
  // Some file systems do not know fsync().
  if (::fsync(descriptor_) != 0 && errno != EINVAL)
    throw failure(errno, "cannot write to " + name_);
}

TrajectoryReplacement::TrajectoryReplacement(const std::string& path, TrajectoryFormat format) {
  requireFile(path);
  std::error_code error;
  target_ = fs::weakly_canonical(fs::absolute(path), error);  // through links
  if (error) target_ = path;
  static std::atomic<unsigned> count{0};
  temporary_ =
      target_.string() + "." + std::to_string(getpid()) + "-" + std::to_string(++count) + ".tmp";
  const fs::file_status old = fs::status(target_, error);
  if (fs::exists(old) && ::access(target_.c_str(), W_OK) != 0) {
    throw failure(errno, "cannot write " + path);
  }
  file_.emplace(temporary_, format, path);
  if (fs::exists(old)) fs::permissions(temporary_, old.permissions(), error);
}

TrajectoryReplacement::~TrajectoryReplacement() {
  if (file_) ::unlink(temporary_.c_str());
}

void TrajectoryReplacement::finish() {
  file_->flush();
  file_->sync();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw failure(errno, "cannot replace " + target_.string());
  }
  file_.reset();
  // So that the new name survives a power failure. The directory may be writable only.
  const int directory = ::open(target_.parent_path().c_str(), O_RDONLY | O_CLOEXEC);
  if (directory < 0) return;
  ::fsync(directory);
  ::close(directory);
}

}  // namespace rotrocc
