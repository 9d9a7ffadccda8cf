#include "inertial/gyro_file.h"

#include <fstream>
#include <iomanip>
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

void writeGyroFile(const std::string& path, const std::vector<GyroSample>& samples) {
  std::ofstream file(path);
  file << "#timestamp [ns],w_x [rad s^-1],w_y [rad s^-1],w_z [rad s^-1],a_x [m s^-2],a_y [m s^-2],"
          "a_z [m s^-2]\n"
       << std::setprecision(10);
  for (const GyroSample& sample : samples) {
    const Eigen::Vector3d& rate = sample.rate_rps;
    file << sample.stamp_ns << ',' << rate.x() << ',' << rate.y() << ',' << rate.z() << ",0,0,0\n";
  }
  file.flush();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace rotrocc
