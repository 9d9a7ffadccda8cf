// The shortest use of the library, without ROS: the odometry on a KITTI sequence.

#include <exception>
#include <iostream>
#include <string>

#include "common/print_help.h"
#include "rotrocc/parameters.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/trajectory.h"
#include "rotrocc/visual_odometry.h"
#include "support/kitti_sequence.h"

namespace {

using namespace rotrocc;

const char* const kHelp =
    "Runs the odometry on a sequence of the KITTI benchmark; an example of the library without "
    "ROS.\n\n"
    "example: kitti_odometry dataset/sequences/06 06.txt\n"
    "usage:   kitti_odometry SEQUENCE TRAJECTORY [CONFIG.yaml]\n\n"
    "SEQUENCE     a directory with image_0, image_1, calib.txt and times.txt\n"
    "TRAJECTORY   output file for the poses of the left camera, in KITTI format\n"
    "CONFIG.yaml  parameters, as config/default.yaml\n";

void run(const std::string& directory, const std::string& output, const char* config) {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
  if (config != nullptr) loadYaml(config, table);

  const KittiSequence sequence(directory);
  TrajectoryWriter trajectory(output, TrajectoryFormat::kKitti);
  VisualOdometry odometry(parameters.odometry);
  PoseAccumulator accumulator;
  for (int i = 0; i < sequence.size(); ++i) {
    const StereoPair pair = sequence.pair(i);
    const OdometryResult result = odometry.process(pair, sequence.camera);
    trajectory.write({pair.stamp_ns, accumulator.add(result.T_prev_cur)});
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (printHelp(argc, argv, kHelp)) return 0;
  if (argc < 3 || argc > 4) {
    std::cerr << "kitti_odometry: expected a sequence and an output file; --help shows the usage\n";
    return 2;
  }
  try {
    run(argv[1], argv[2], argc == 4 ? argv[3] : nullptr);
  } catch (const std::exception& error) {
    std::cerr << "kitti_odometry: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
