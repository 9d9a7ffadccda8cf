#include "inertial/gyro_file.h"

#include <stdexcept>

#include "evaluation/text_file.h"

namespace rotrocc {

std::vector<GyroSample> readGyroFile(const std::string& path) {
  std::vector<GyroSample> samples;
  for (const TextLine& line : readTextLines(path, ',')) {
    if (line.words.size() < 4) {
      throw std::runtime_error(line.where + " has " + std::to_string(line.words.size()) +
                               " columns: timestamp [ns] and three angular velocities [rad/s] are "
                               "expected, separated by commas");
    }
    samples.push_back(
        {line.integer(0), Eigen::Vector3d(line.number(1), line.number(2), line.number(3))});
  }
  return samples;
}

}  // namespace rotrocc
