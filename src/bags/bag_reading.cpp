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
    // Programs of a launch file have their own working directory, so print the absolute path.
    throw std::runtime_error(std::filesystem::absolute(path).string() +
                             " is not readable as a bag: " + error.what());
  }
}

}  // namespace rotrocc
