#include "inertial/gyro_file.h"

#include "files/csv_file.h"
#include "files/image_times.h"
#include "files/text_file.h"

namespace rotrocc {

std::vector<GyroSample> readGyroFile(const std::string& path) {
  std::vector<GyroSample> samples;
  const std::vector<TextLine> lines = readTextLines(path);
  const std::int64_t unit_ns = timeUnit_ns(lines, 1);
  for (const TextLine& line : lines) {
    line.requireColumns(4, "timestamp [ns] and three angular velocities [rad/s]");
    samples.push_back({line.nanoseconds(0, unit_ns),
                       Eigen::Vector3d(line.number(1), line.number(2), line.number(3))});
  }
  return samples;
}

void writeGyroFile(const std::string& path, const std::vector<GyroSample>& samples) {
  CsvFile file(path,
               "#timestamp [ns],w_x [rad s^-1],w_y [rad s^-1],w_z [rad s^-1],a_x [m s^-2],"
               "a_y [m s^-2],a_z [m s^-2]");
  for (const GyroSample& sample : samples) {
    const Eigen::Vector3d& rate = sample.rate_rps;
    file << sample.stamp_ns;
    file.row({rate.x(), rate.y(), rate.z(), 0.0, 0.0, 0.0});
  }
}

}  // namespace rotrocc
