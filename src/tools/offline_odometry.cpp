#include <cstdint>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

#include "inertial/gyro_file.h"
#include "rotrocc/parameters.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/trajectory.h"
#include "rotrocc/visual_odometry.h"
#include "tools/flow_pictures.h"
#include "tools/odometry_bag.h"
#include "tools/preloaded_source.h"
#include "tools/program.h"
#include "tools/progress_bar.h"
#include "tools/recorded_gyro.h"
#include "tools/run_statistics.h"
#include "tools/stereo_source.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const char* const kUsage =
    "Runs the odometry on all pairs of a recording, and writes the pose of the left "
    "camera for each.\n\n"
    "example: offline_odometry dataset/sequences/06 --trajectory 06.txt --stats 06.csv\n"
    "usage:   offline_odometry INPUT --trajectory OUT.txt [options]\n\n"
    "INPUT is a bag, or a directory in the layout of KITTI's odometry benchmark, in ASL "
    "format\n(EuRoC), or with folders left and right and files left.yaml and "
    "right.yaml of\ncamera_calibration. Images that are not rectified are.\n\n";

struct Options {
  std::string input;
  std::string trajectory;
  std::string format = "kitti";
  std::string config;
  std::vector<std::string> assignments;
  std::string statistics;
  std::string bag;
  std::string pictures;
  std::string left_image;
  std::string right_image;
  std::string rectify = "auto";
  std::string imu;
  std::string imu_rotation = "0 0 0 1";
  bool preload = false;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("trajectory", po::value(&options.trajectory)->required(), "output file for the poses");
  add("format", po::value(&options.format)->default_value(options.format), "kitti or tum");
  add("config", po::value(&options.config), "YAML file with parameters");
  add("set", po::value(&options.assignments), "name=value: set a parameter; may be repeated");
  add("stats",
      po::value(&options.statistics),
      "CSV output file with one row of statistics per pair");
  add("bag",
      po::value(&options.bag),
      "output bag with /stereo/odom and /tf, as the node publishes them");
  add("pictures", po::value(&options.pictures), "output folder for the flow picture of each pair");
  add("left-image",
      po::value(&options.left_image),
      "topic of the left images, if a bag has several stereo pairs");
  add("right-image", po::value(&options.right_image), "topic of the right images");
  add("rectify",
      po::value(&options.rectify)->default_value(options.rectify),
      "images of a bag by K, D, R and P of camera_info: yes, no, or auto: if the topic is not "
      "named image_rect or alike, and camera_info describes raw images");
  add("imu",
      po::value(&options.imu),
      "gyroscope that predicts rotations: a CSV file (timestamp [ns], three angular velocities "
      "[rad/s], ...), a topic of sensor_msgs/Imu in a bag, or a folder of an ASL sequence, as "
      "imu0");
  add("imu-rotation",
      po::value(&options.imu_rotation)->default_value(options.imu_rotation),
      "\"QX QY QZ QW\": rotation from axes of a CSV file to those of the left camera; that of a "
      "topic is from tf, that of a folder from sensor.yaml");
  add("preload", po::bool_switch(&options.preload), "read all images first; prints the memory use");
  PositionalArguments input;
  input.options.add_options()("input", po::value(&options.input)->required());
  input.order.add("input", 1);
  po::variables_map variables;
  return parseCommandLine(argc, argv, kUsage, visible, input, variables);
}

/// Time of a POSIX clock [ms].
double now(clockid_t clock) {
  timespec time;
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

PairRecord process(VisualOdometry& odometry,
                   const StereoPair& pair,
                   const StereoCamera& camera,
                   const RotationSource& rotation) {
  const double wall_ms = now(CLOCK_MONOTONIC);
  const double cpu_ms = now(CLOCK_PROCESS_CPUTIME_ID);
  PairRecord record;
  odometry.prepare();  // as in the node, where it is done before the pair arrives
  record.result = odometry.process(pair, camera, std::nullopt, rotation);
  record.cpu_ms = now(CLOCK_PROCESS_CPUTIME_ID) - cpu_ms;
  record.wall_ms = now(CLOCK_MONOTONIC) - wall_ms;
  return record;
}

Parameters readParameters(const Options& options) {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
  if (!options.config.empty()) {
    for (const std::string& warning : loadYaml(options.config, table)) {
      std::cerr << "offline_odometry: " << warning << '\n';
    }
  }
  for (const std::string& assignment : options.assignments) table.setAssignment(assignment);
  return parameters;
}

std::unique_ptr<StereoSource> openInput(const Options& options, const NodeParameters& node) {
  StereoBag::Options bag = bagOptions(node);
  bag.left_image = options.left_image;
  bag.right_image = options.right_image;
  bag.rectify = rectifyOption(options.rectify);
  return openStereoSource(options.input, bag);
}

std::optional<RecordedGyro> openGyro(const Options& options,
                                     const StereoSource& source,
                                     const NodeParameters& node) {
  if (options.imu.empty()) return std::nullopt;
  if (std::filesystem::is_regular_file(options.imu)) {
    return RecordedGyro({readGyroFile(options.imu), parseRotation(options.imu_rotation)});
  }
  return RecordedGyro(source.gyroscope(options.imu, node.base_frame));
}

void run(const Options& options) {
  const Parameters parameters = readParameters(options);

  std::unique_ptr<StereoSource> source = openInput(options, parameters.node);
  std::cerr << "offline_odometry: reading " << source->description() << '\n';
  std::optional<RecordedGyro> gyro = openGyro(options, *source, parameters.node);
  const PreloadedSource* preloaded = nullptr;
  if (options.preload) {
    auto all = std::make_unique<PreloadedSource>(std::move(source));
    preloaded = all.get();
    source = std::move(all);
  }
  TrajectoryWriter trajectory(options.trajectory, trajectoryFormat(options.format));
  std::optional<StatisticsFile> statistics;
  if (!options.statistics.empty()) statistics.emplace(options.statistics);
  std::optional<OdometryBag> bag;
  if (!options.bag.empty()) {
    bag.emplace(
        options.bag, source->mount(parameters.node.base_frame), parameters, source->start_ns());
  }
  std::optional<FlowPictures> pictures;
  if (!options.pictures.empty()) {
    pictures.emplace(options.pictures, flowView(parameters.node.flow_view));
  }

  RotationSource rotation;
  if (gyro) {
    rotation = [&](std::int64_t from_ns, std::int64_t to_ns) {
      return gyro->rotation(from_ns, to_ns);
    };
  }
  VisualOdometry odometry(parameters.odometry);
  PoseAccumulator accumulator;
  ProgressBar progress("odometry", source->size());
  std::vector<PairRecord> records;
  StereoPair pair;
  StereoCamera camera;
  while (source->next(pair, camera)) {
    records.push_back(process(odometry, pair, camera, rotation));
    if (gyro) gyro->observe(records.back().result);
    trajectory.write({pair.stamp_ns, accumulator.add(records.back().result.T_prev_cur)});
    if (statistics) statistics->write(records.back());
    if (bag) bag->write(records.back().result);
    if (pictures) pictures->write(pair, camera, odometry, records.back().result);
    progress.advance();
  }
  progress.finish();
  printSummary(std::cout, records);
  if (gyro) gyro->printSummary(std::cout);
  if (preloaded != nullptr) preloaded->printMemory(std::cout);
  if (const std::string left_out = source->leftOut(); !left_out.empty()) {
    std::cout << left_out << " within " << parameters.node.max_stamp_difference_s
              << " s (max_stamp_difference_s)\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("offline_odometry", argc, argv, parse, run);
}
