#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/stereo_source.h"

namespace rotrocc {

/// All pairs of another source, read before the first one is asked for: so the reading of one pair
/// does not disturb the timing of another.
class PreloadedSource : public StereoSource {
 public:
  /// Throws as next() of `source`.
  explicit PreloadedSource(std::unique_ptr<StereoSource> source);

  std::string description() const override { return source_->description(); }
  int size() const override { return source_->size(); }
  bool next(StereoPair& pair, StereoCamera& camera) override;
  Eigen::Isometry3d mount(const std::string& base_frame) const override {
    return source_->mount(base_frame);
  }
  std::int64_t start_ns() const override { return source_->start_ns(); }

  /// Writes what the process takes of memory at its peak, and for what.
  void printMemory(std::ostream& out) const;

 private:
  std::unique_ptr<StereoSource> source_;
  std::vector<std::pair<StereoPair, StereoCamera>> pairs_;
  std::size_t next_ = 0;
  double images_MB_ = 0.0;
  double loaded_MB_ = 0.0;  // of the process, when all images are read
};

}  // namespace rotrocc
