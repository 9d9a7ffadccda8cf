#include "sequences/image_folders.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <boost/algorithm/string/case_conv.hpp>
#include <opencv2/core.hpp>

#include "files/image_times.h"
#include "files/text_file.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// Paths of images by what names them.
using NamedImages = std::map<std::string, std::string>;

bool isImage(const fs::path& file) {
  static const std::set<std::string> kExtensions = {
      ".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm", ".ppm", ".webp"};
  return file.filename().string().front() != '.' &&
         kExtensions.count(boost::algorithm::to_lower_copy(file.extension().string())) > 0;
}

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The name with numbers of equal length.
std::string sortKey(const std::string& name) {
  constexpr std::size_t kDigits = 20;
  std::string key;
  for (std::size_t i = 0; i < name.size();) {
    std::size_t end = i;
    while (end < name.size() && isDigit(name[end])) ++end;
    key.append(kDigits - std::min(kDigits, end - i), end > i ? '0' : ' ');
    if (end == i) ++end;
    key += name.substr(i, end - i);
    i = end;
  }
  return key;
}

std::string stemOf(const std::string& path) {
  return fs::path(path).stem().string();
}

/// The last of the longest numbers in a name; empty if it has none.
std::string numberIn(const std::string& name) {
  std::string longest;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::size_t end = i;
    while (end < name.size() && isDigit(name[end])) ++end;
    if (end > i && end - i >= longest.size()) longest = name.substr(i, end - i);
    i = end;
  }
  return longest;
}

NamedImages byName(const std::vector<std::string>& files, bool by_number) {
  NamedImages images;
  for (const std::string& file : files) {
    const std::string name = stemOf(file);
    images[sortKey(by_number ? numberIn(name) : name)] = file;
  }
  return images;
}

/// Left and right images by what names them, and what names either.
struct NamedPairs {
  NamedImages left, right;
  std::set<std::string> names;

  NamedPairs(const std::vector<std::string>& left_files,
             const std::vector<std::string>& right_files) {
    for (const bool by_number : {true, false}) {  // unless two have the same number
      left = byName(left_files, by_number);
      right = byName(right_files, by_number);
      if (left.size() == left_files.size() && right.size() == right_files.size()) break;
    }
    for (const auto& [name, file] : left) names.insert(name);
    for (const auto& [name, file] : right) names.insert(name);
  }

  /// The first with the first, of as many.
  void pairInOrder() {
    NamedImages renamed;
    auto partner = right.begin();
    for (const auto& [name, file] : left) renamed[name] = (partner++)->second;
    right = std::move(renamed);
    names.clear();
    for (const auto& [name, file] : left) names.insert(name);
  }

  std::size_t shared() const { return left.size() + right.size() - names.size(); }
};

/// The times of the left images. Those of names in the order of the names; of numbers from 0 on, if
/// the names are numbers.
std::map<std::string, std::int64_t> timesOf(const NamedPairs& images,
                                            const std::vector<std::int64_t>& stamps_ns,
                                            const std::string& path) {
  std::map<std::string, std::int64_t> times;
  std::size_t place = 0;
  if (stamps_ns.size() == images.names.size()) {
    for (const std::string& name : images.names) times[name] = stamps_ns[place++];
    return times;
  }
  const std::string& last = *images.names.rbegin();
  const bool are_numbers =
      std::all_of(images.names.begin(), images.names.end(), [](const auto& name) {
        return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
      });
  if (are_numbers && last < sortKey(std::to_string(stamps_ns.size()))) {
    for (const std::string& name : images.names) times[name] = stamps_ns[std::stoul(name)];
    return times;
  }
  const bool of_left = stamps_ns.size() == images.left.size();
  if (!of_left && stamps_ns.size() != images.shared()) {
    throw std::runtime_error(
        path +
        cv::format(" has %zu times, but there are %zu left and %zu right images, ",
                   stamps_ns.size(),
                   images.left.size(),
                   images.right.size()) +
        cv::format("%zu with the same name: give the time of each name", images.shared()));
  }
  for (const auto& [name, file] : images.left) {
    if (of_left || images.right.count(name) > 0) times[name] = stamps_ns[place++];
  }
  return times;
}

ImagePairs pairsByName(const std::vector<std::string>& left,
                       const std::vector<std::string>& right,
                       const std::string& times_path) {
  NamedPairs images(left, right);
  if (2 * images.shared() < std::min(left.size(), right.size())) {
    if (left.size() != right.size()) {
      throw std::runtime_error(
          left.front() + " and " + right.front() +
          cv::format(" begin %zu left and %zu right images that share no names, so it is unknown "
                     "which are pairs; give both images of a pair the same name",
                     left.size(),
                     right.size()));
    }
    images.pairInOrder();
  }
  const std::vector<std::int64_t> stamps_ns = readTimes(times_path);
  const std::map<std::string, std::int64_t> times = timesOf(images, stamps_ns, times_path);
  std::vector<ImagePairs::Pair> pairs;
  for (const auto& [name, file] : images.left) {
    const auto partner = images.right.find(name);
    if (partner == images.right.end()) continue;
    pairs.push_back({{times.at(name), file}, {times.at(name), partner->second}});
  }
  const std::size_t missing = stamps_ns.size() - std::min(stamps_ns.size(), times.size());
  return {std::move(pairs), left.size(), right.size(), missing};
}

/// By the times that are the names.
std::vector<StampedImage> stampedImages(const std::vector<std::string>& files) {
  std::vector<TextLine> names;
  for (const std::string& file : files) {
    names.push_back({file, {stemOf(file)}});
    const std::string& name = names.back().words[0];
    const bool is_number = name.find_first_not_of("0123456789.") == std::string::npos;
    constexpr std::size_t kDigits = 10;  // of seconds since 1970
    if (is_number && (name.size() >= kDigits || name.find('.') != std::string::npos)) continue;
    throw std::runtime_error(file +
                             " is not named by its time, e.g. 1403636579763555584.png [ns] or "
                             "1403636579.763556.png [s]: "
                             "rename the images, or add times.txt with the time [s] of each pair");
  }
  const auto has_dot = [](const TextLine& name) {
    return name.words[0].find('.') != std::string::npos;
  };
  const auto dotted = std::stable_partition(names.begin(), names.end(), has_dot);
  std::vector<StampedImage> images;
  for (const auto& [group, unit_ns] :
       {std::pair(std::vector(names.begin(), dotted), kSecond_ns),
        std::pair(std::vector(dotted, names.end()), std::int64_t{1})}) {
    if (group.empty()) continue;
    const std::vector<std::int64_t> stamps_ns = imageStamps(group, unit_ns);
    for (std::size_t i = 0; i < group.size(); ++i) images.push_back({stamps_ns[i], group[i].where});
  }
  std::sort(images.begin(), images.end(), [](const StampedImage& a, const StampedImage& b) {
    return a.stamp_ns < b.stamp_ns;
  });
  return images;
}

}  // namespace

std::vector<std::string> listImages(const std::string& folder) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder + " is missing");
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (isImage(entry.path())) files.push_back(entry.path().string());
  }
  if (files.empty()) throw std::runtime_error(folder + " has no images");
  std::sort(files.begin(), files.end(), [](const std::string& a, const std::string& b) {
    return std::pair(sortKey(stemOf(a)), a) < std::pair(sortKey(stemOf(b)), b);
  });
  return files;
}

ImagePairs pairFolders(const std::string& left,
                       const std::string& right,
                       const std::string& times,
                       double max_stamp_difference_s) {
  const std::vector<std::string> left_files = listImages(left);
  const std::vector<std::string> right_files = listImages(right);
  if (fs::exists(times)) return pairsByName(left_files, right_files, times);
  return {stampedImages(left_files), stampedImages(right_files), max_stamp_difference_s};
}

}  // namespace rotrocc
