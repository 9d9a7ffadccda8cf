#include "tools/preloaded_pairs.h"

#include <cstdio>
#include <fstream>
#include <ostream>
#include <string>
#include <tuple>

namespace rotrocc {
namespace {

/// Memory of this process, by its name in /proc/self/status: VmRSS is that now, VmHWM its peak. The
/// peak of getrusage() is no less than that of the process which has started this one.
double memory_MB(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind(name + ":", 0) == 0) return 1024e-6 * std::stod(line.substr(name.size() + 1));
  }
  return 0.0;
}

double size_MB(const cv::Mat& image) {
  return 1e-6 * static_cast<double>(image.total() * image.elemSize());
}

}  // namespace

PreloadedPairs::PreloadedPairs(RecordedPairs& pairs) {
  StereoPair pair;
  StereoCamera camera;
  while (pairs.next(pair, camera)) {
    images_MB_ += size_MB(pair.left) + size_MB(pair.right);
    // The next call overwrites its images.
    pairs_.emplace_back(StereoPair{pair.stamp_ns, pair.left.clone(), pair.right.clone()}, camera);
  }
  loaded_MB_ = memory_MB("VmRSS");
}

bool PreloadedPairs::next(StereoPair& pair, StereoCamera& camera) {
  if (next_ == pairs_.size()) return false;
  std::tie(pair, camera) = pairs_[next_];
  ++next_;
  return true;
}

void PreloadedPairs::printMemory(std::ostream& out) const {
  const double peak = memory_MB("VmHWM");
  char line[128];
  std::snprintf(
      line,
      sizeof(line),
      "peak memory: %.1f MB without the images (%.1f MB), of which %.1f MB for the odometry\n",
      peak - images_MB_,
      images_MB_,
      peak - loaded_MB_);
  out << line;
}

}  // namespace rotrocc
