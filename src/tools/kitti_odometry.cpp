// The shortest use of the library, without ROS: the odometry on a KITTI sequence.

#include <exception>
#include <iostream>
#include <string>

#include "rotrocc/kitti.h"
#include "rotrocc/parameters.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/trajectory.h"
#include "rotrocc/visual_odometry.h"

namespace {

using namespace rotrocc;

void run(const std::string& directory, const std::string& output, const char* config) {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
  if (config != nullptr) loadYaml(config, table);

  const KittiSequence sequence(directory);
  TrajectoryWriter trajectory(output, TrajectoryFormat::kKitti);
  VisualOdometry odometry(parameters.odometry);
  PoseAccumulator accumulator;
  for (int i = 0; i < sequence.size(); ++i) {
    const StereoPair pair = {sequence.stamp_ns(i), sequence.readLeft(i), sequence.readRight(i)};
    const OdometryResult result = odometry.process(pair, sequence.camera());
    trajectory.write({pair.stamp_ns, accumulator.add(result.T_prev_cur)});
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool help = argc == 2 && std::string(argv[1]) == "--help";
  if (argc < 3 || argc > 4) {
    (help ? std::cout : std::cerr) << "usage: kitti_odometry SEQUENCE TRAJECTORY [CONFIG.yaml]\n";
    return help ? 0 : 2;
  }
  try {
    run(argv[1], argv[2], argc == 4 ? argv[3] : nullptr);
  } catch (const std::exception& error) {
    std::cerr << "kitti_odometry: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
