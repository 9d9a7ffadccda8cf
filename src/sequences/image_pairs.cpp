#include "sequences/image_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "common/to_seconds.h"
#include "evaluation/image_file.h"

namespace rotrocc {
namespace {

/// Removes images without a file; returns their number.
std::size_t removeMissing(std::vector<StampedImage>& images) {
  const auto present = std::remove_if(images.begin(), images.end(), [](const StampedImage& image) {
    return !std::filesystem::is_regular_file(image.path);
  });
  const auto count = static_cast<std::size_t>(images.end() - present);
  images.erase(present, images.end());
  return count;
}

/// The lower quartile of the steps, as most images may be lost.
std::int64_t period_ns(const std::vector<StampedImage>& images) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < images.size(); ++i) {
    steps.push_back(images[i].stamp_ns - images[i - 1].stamp_ns);
  }
  if (steps.empty()) return INT64_MAX;
  const auto quartile = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 4);
  std::nth_element(steps.begin(), quartile, steps.end());
  return *quartile;
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

ImagePairs::ImagePairs(std::vector<StampedImage> left,
                       std::vector<StampedImage> right,
                       double max_stamp_difference_s) {
  const std::string first_left = left.empty() ? "" : left.front().path;
  missing_files_ = removeMissing(left) + removeMissing(right);
  const std::int64_t tolerance_ns =
      std::min<std::int64_t>(std::llround(1e9 * max_stamp_difference_s), (period_ns(left) - 1) / 2);
  match(left, right, tolerance_ns);
  if (!pairs_.empty()) return;
  throw std::runtime_error("there is no pair: of " + counted(left.size(), "left image") + " and " +
                           counted(right.size(), "right image") +
                           cv::format(", none have stamps within %g s (max_stamp_difference_s); ",
                                      toSeconds(tolerance_ns)) +
                           counted(missing_files_, "listed file") +
                           " missing, the first left image is " +
                           (first_left.empty() ? "none" : first_left));
}

/// Each left image with the nearest right one, unless that is nearer to another left one.
void ImagePairs::match(const std::vector<StampedImage>& left,
                       const std::vector<StampedImage>& right,
                       std::int64_t tolerance_ns) {
  const auto difference = [&](std::size_t i, std::size_t j) {
    return std::llabs(left[i].stamp_ns - right[j].stamp_ns);
  };
  std::size_t j = 0;
  for (std::size_t i = 0; i < left.size() && j < right.size(); ++i) {
    while (j + 1 < right.size() && difference(i, j + 1) < difference(i, j)) ++j;
    const bool next_is_nearer = i + 1 < left.size() && difference(i + 1, j) < difference(i, j);
    if (next_is_nearer || difference(i, j) > tolerance_ns) continue;
    pairs_.push_back({left[i], right[j]});
    ++j;
  }
  left_alone_ = left.size() - pairs_.size();
  right_alone_ = right.size() - pairs_.size();
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
                       readGreyImageOfAnyDepth(pair.left.path),
                       readGreyImageOfAnyDepth(pair.right.path)};
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
