#include "bags/bag_reading.h"

#include <filesystem>
#include <stdexcept>

namespace rotrocc {

rosbag::Bag openBag(const std::string& path) {
  try {
    return rosbag::Bag(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw std::runtime_error(path +
                             " was not closed when it was written: run 'rosbag reindex' on it");
  } catch (const rosbag::BagException& error) {
    // Launch files start programs in a directory of their own, so say where it was looked for.
    throw std::runtime_error(std::filesystem::absolute(path).string() +
                             " is not readable as a bag: " + error.what());
  }
}

}  // namespace rotrocc
