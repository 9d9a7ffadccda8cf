#include "sequences/image_pairs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "common/to_seconds.h"
#include "files/image_file.h"
#include "input/stamps.h"

namespace rotrocc {
namespace {

/// Removes images without a file, and counts them; returns the stamps of the others.
Stamps removeMissing(std::vector<StampedImage>& images, std::size_t& missing) {
  std::vector<StampedImage> present;
  Stamps stamps_ns;
  for (const StampedImage& image : images) {
    if (!std::filesystem::is_regular_file(image.path)) continue;
    present.push_back(image);
    stamps_ns.push_back(image.stamp_ns);
  }
  missing += images.size() - present.size();
  images = std::move(present);
  return stamps_ns;
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

ImagePairs::ImagePairs(std::vector<StampedImage> left,
                       std::vector<StampedImage> right,
                       double max_stamp_difference_s) {
  const std::string first_left = left.empty() ? "" : left.front().path;
  const Stamps left_ns = removeMissing(left, missing_files_);
  const Stamps right_ns = removeMissing(right, missing_files_);
  std::int64_t tolerance_ns = std::llround(1e9 * max_stamp_difference_s);
  if (const auto period_ns = periodOf(left_ns)) {
    tolerance_ns = std::min(tolerance_ns, (*period_ns - 1) / 2);
  }
  for (const auto& [i, j] : matchStamps(left_ns, right_ns, tolerance_ns)) {
    pairs_.push_back({left[i], right[j]});
  }
  left_alone_ = left.size() - pairs_.size();
  right_alone_ = right.size() - pairs_.size();
  if (!pairs_.empty()) return;
  throw std::runtime_error("there is no pair: of " + counted(left.size(), "left image") + " and " +
                           counted(right.size(), "right image") +
                           cv::format(", none have stamps within %g s (max_stamp_difference_s); ",
                                      toSeconds(tolerance_ns)) +
                           counted(missing_files_, "listed file") +
                           " missing, the first left image is " +
                           (first_left.empty() ? "none" : first_left));
}

std::vector<std::int64_t> ImagePairs::stamps_ns() const {
  std::vector<std::int64_t> stamps_ns;
  for (const Pair& pair : pairs_) stamps_ns.push_back(pair.left.stamp_ns);
  return stamps_ns;
}

bool ImagePairs::hasFiles(int index) const {
  return std::filesystem::exists(pairs_.at(static_cast<std::size_t>(index)).right.path);
}

StereoPair ImagePairs::read(int index, const cv::Size& size) const {
  const Pair& pair = pairs_.at(static_cast<std::size_t>(index));
  StereoPair images = {pair.left.stamp_ns,
                       readGrayImageOfAnyDepth(pair.left.path),
                       readGrayImageOfAnyDepth(pair.right.path)};
  requireImageSize(pair.left.path, images.left, size, "the calibrated image");
  requireImageSize(pair.right.path, images.right, size, "the calibrated image");
  return images;
}

std::string ImagePairs::leftOut() const {
  std::string text;
  if (left_alone_ + right_alone_ > 0) {
    text = counted(left_alone_, "left image") + " and " + counted(right_alone_, "right image") +
           " without a partner";
  }
  if (missing_files_ > 0) {
    text +=
        (text.empty() ? "" : ", ") + counted(missing_files_, "listed image") + " without a file";
  }
  return text;
}

}  // namespace rotrocc
