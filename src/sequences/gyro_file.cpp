#include "sequences/gyro_file.h"

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

}  // namespace rotrocc
