#pragma once

#include <string>
#include <vector>

#include "sequences/image_pairs.h"

namespace rotrocc {

/// The images in a folder, in the order of their names, where numbers count as numbers: 2 is before
/// 10. Hidden files are none. Throws std::runtime_error if the folder or images are missing.
std::vector<std::string> listImages(const std::string& folder);

/// The pairs of two folders of images.
///   `times` has one time for each image name, for each number from 0 on that is one, for each left
///   image, or for each pair, see readTimes(). Images of the same number or name are a pair, or
///   where no names are shared, those at the same place in folders of as many images.
///   Without `times`, the names are the times of the images: seconds with a dot, else nanoseconds
///   or what their digits imply, see imageStamps(). Images of the same time are a pair, as in
///   ImagePairs.
/// Throws std::runtime_error with names, counts and a remedy if that leaves more than one choice.
ImagePairs pairFolders(const std::string& left,
                       const std::string& right,
                       const std::string& times,
                       double max_stamp_difference_s);

}  // namespace rotrocc
