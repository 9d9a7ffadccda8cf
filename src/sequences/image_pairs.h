#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

struct StampedImage {
  std::int64_t stamp_ns = 0;
  std::string path;
};

/// Left and right images of the same time.
class ImagePairs {
 public:
  /// Both lists have increasing stamps. Images whose stamps differ by at most
  /// `max_stamp_difference_s`, and by less than half of the period of the left images, may be a
  /// pair. Files that are missing count as images without a partner. Throws std::runtime_error if
  /// no pair is left.
  ImagePairs(std::vector<StampedImage> left,
             std::vector<StampedImage> right,
             double max_stamp_difference_s);

  struct Pair {
    StampedImage left;
    StampedImage right;
  };

  /// Pairs of so many images, whose files may be missing yet; `missing_files` others are listed.
  ImagePairs(std::vector<Pair> pairs,
             std::size_t left_images,
             std::size_t right_images,
             std::size_t missing_files = 0)
      : pairs_(std::move(pairs)),
        left_alone_(left_images - pairs_.size()),
        right_alone_(right_images - pairs_.size()),
        missing_files_(missing_files) {}

  int size() const { return static_cast<int>(pairs_.size()); }
  std::int64_t stamp_ns(int index) const { return pairs_.at(index).left.stamp_ns; }
  std::vector<std::int64_t> stamps_ns() const;
  const Pair& pair(int index) const { return pairs_.at(static_cast<std::size_t>(index)); }

  /// Whether the files of a pair are there; the right one is written last.
  bool hasFiles(int index) const;

  /// CV_8UC1, or CV_16UC1 where a file has 16 bits. Throws std::runtime_error if a file is
  /// unreadable or has not the size `size`.
  StereoPair read(int index, const cv::Size& size) const;

  /// What was left out, e.g. "3 left images and 1 right image without a partner"; empty if nothing.
  std::string leftOut() const;

 private:
  std::vector<Pair> pairs_;
  std::size_t left_alone_ = 0;
  std::size_t right_alone_ = 0;
  std::size_t missing_files_ = 0;
};

}  // namespace rotrocc
