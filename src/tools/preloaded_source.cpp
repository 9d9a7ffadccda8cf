#include "tools/preloaded_source.h"

#include <sys/resource.h>

#include <cstdio>
#include <ostream>
#include <tuple>

namespace rotrocc {
namespace {

/// Peak resident memory of this process.
double peak_MB() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024e-6 * static_cast<double>(usage.ru_maxrss);
}

double size_MB(const cv::Mat& image) {
  return 1e-6 * static_cast<double>(image.total() * image.elemSize());
}

}  // namespace

PreloadedSource::PreloadedSource(std::unique_ptr<StereoSource> source)
    : source_(std::move(source)) {
  StereoPair pair;
  StereoCamera camera;
  while (source_->next(pair, camera)) {
    images_MB_ += size_MB(pair.left) + size_MB(pair.right);
    // The source may overwrite its images.
    pairs_.emplace_back(StereoPair{pair.stamp_ns, pair.left.clone(), pair.right.clone()}, camera);
  }
  loaded_MB_ = peak_MB();
}

bool PreloadedSource::next(StereoPair& pair, StereoCamera& camera) {
  if (next_ == pairs_.size()) return false;
  std::tie(pair, camera) = pairs_[next_];
  ++next_;
  return true;
}

void PreloadedSource::printMemory(std::ostream& out) const {
  const double peak = peak_MB();
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
