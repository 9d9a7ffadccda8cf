#include "sequences/kitti_layout.h"

#include <filesystem>
#include <stdexcept>

#include "inertial/gyro_file.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {

KittiLayout::KittiLayout(const std::string& directory, bool being_written)
    : sequence_(directory, being_written), calibration_(rectifiedCalibration(sequence_.camera())) {}

StereoPair KittiLayout::read(int index) {
  return {sequence_.stamp_ns(index), sequence_.readLeft(index), sequence_.readRight(index)};
}

Eigen::Isometry3d KittiLayout::T_base_camera() const {
  return kittiMount();
}

GyroRecording KittiLayout::gyroscope(const std::string& name) const {
  const std::string file = directory() + "/" + (name.empty() ? "imu.csv" : name);
  if (std::filesystem::is_regular_file(file)) {
    return {readGyroFile(file), Eigen::Matrix3d::Identity()};
  }
  if (name.empty()) return {};
  throw std::runtime_error("there is no file " + name + " with a gyroscope");
}

}  // namespace rotrocc
