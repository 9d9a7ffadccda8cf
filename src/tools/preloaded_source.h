#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/stereo_source.h"

namespace rotrocc {

/// Reads all pairs of another source in advance, so that reading does not disturb the timing.
class PreloadedSource : public StereoSource {
 public:
  /// Throws like next() of `source`.
  explicit PreloadedSource(std::unique_ptr<StereoSource> source);

  std::string description() const override { return source_->description(); }
  int size() const override { return source_->size(); }
  bool next(StereoPair& pair, StereoCamera& camera) override;
  Eigen::Isometry3d mount(const std::string& base_frame) const override {
    return source_->mount(base_frame);
  }
  GyroRecording gyroscope(const std::string& name, const std::string& base_frame) const override {
    return source_->gyroscope(name, base_frame);
  }
  std::int64_t start_ns() const override { return source_->start_ns(); }
  std::string leftOut() const override { return source_->leftOut(); }

  /// Prints the peak memory of the process, split by use.
  void printMemory(std::ostream& out) const;

 private:
  std::unique_ptr<StereoSource> source_;
  std::vector<std::pair<StereoPair, StereoCamera>> pairs_;
  std::size_t next_ = 0;
  double images_MB_ = 0.0;
  double loaded_MB_ = 0.0;  // memory of the process after reading all images
};

}  // namespace rotrocc
