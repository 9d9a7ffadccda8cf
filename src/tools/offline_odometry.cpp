#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <Eigen/Geometry>
#include <boost/program_options.hpp>
#include <opencv2/core.hpp>

#include "bags/recorded_pairs.h"
#include "common/stage_timer.h"
#include "inertial/gyro_predictor.h"
#include "input/to_text.h"
#include "node/health/recording_inspector.h"
#include "rotrocc/parameters.h"
#include "rotrocc/visual_odometry.h"
#include "sequences/gyro_file.h"
#include "tools/input_options.h"
#include "tools/odometry_outputs.h"
#include "tools/program.h"
#include "tools/progress_bar.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const std::string kUsage =
    std::string(
        "Runs the odometry on all pairs of a recording, and writes the pose of the left "
        "camera, or of the base, for each.\n\n"
        "example: offline_odometry dataset/sequences/06 --trajectory 06.txt --stats 06.csv\n"
        "usage:   offline_odometry INPUT... --trajectory OUT.txt [options]\n\n"
        "INPUT ") +
    kRecordingHelp + "Unrectified images are rectified, unusable ones dropped and counted.\n\n";

struct Options {
  InputOptions input;
  bool preload = false;
  std::string imu;
  OutputFiles output;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description output("Output");
  auto add = output.add_options();
  add("trajectory", po::value(&options.output.trajectory)->required(), "file for the poses");
  add("format", withDefault(options.output.format), "kitti or tum");
  add("frame",
      withDefault(options.output.frame),
      "body whose poses are written, relative to the first pose: camera (the left one) or base");
  add("mount",
      po::value(&options.output.mount),
      "\"x y z qx qy qz qw\" of the left camera's optical frame on the base, instead of tf's or "
      "the sequence's");
  add("stats", po::value(&options.output.statistics), "CSV file with a row of statistics per pair");
  add("bag",
      po::value(&options.output.bag),
      "bag with /stereo/odom and /tf, as the node publishes them");
  add("pictures", po::value(&options.output.pictures), "folder for the flow picture of each pair");

  po::options_description gyroscope("Gyroscope");
  add = gyroscope.add_options();
  add("imu",
      po::value(&options.imu),
      "gyroscope to predict rotations: a CSV file (timestamp [ns], three angular velocities "
      "[rad/s] in axes of the left camera, ...), a topic of sensor_msgs/Imu in a bag (axes from "
      "tf), or a folder of an ASL sequence such as imu0 (axes from sensor.yaml)");

  po::options_description images = imageOptions(options.input);
  add = images.add_options();
  add("preload", po::bool_switch(&options.preload), "read all images first; prints the memory use");

  po::variables_map variables;
  po::options_description visible("Options");
  visible.add_options()("help,h", "show this help");
  visible.add(output).add(parameterOptions(options.input)).add(gyroscope).add(images);
  if (!parseCommandLine(argc, argv, kUsage.c_str(), visible, options.input.paths, variables))
    return false;
  if (options.input.paths.empty()) throw po::error("expected a recording");
  return true;
}

PairRecord process(VisualOdometry& odometry,
                   const StereoPair& pair,
                   const StereoCamera& camera,
                   const RotationSource& rotation) {
  PairRecord record;
  const std::clock_t cpu = std::clock();  // of all threads
  {
    const StageTimer timer(record.wall_ms);
    odometry.prepare();  // as in the node, where it is done before the pair arrives
    record.result = odometry.process(pair, camera, std::nullopt, rotation);
  }
  record.cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  return record;
}

/// Predicts rotations from a recording, as GyroPredictor does while the samples arrive.
class RecordedGyro {
 public:
  explicit RecordedGyro(GyroRecording recording)
      : samples_(std::move(recording.samples)), predictor_(recording.R_camera_gyro) {}

  std::optional<Eigen::Matrix3d> rotation(std::int64_t from_ns, std::int64_t to_ns) {
    // Up to the first sample that is not earlier than the image.
    while (next_ < samples_.size() &&
           predictor_.history().newest_ns().value_or(to_ns - 1) < to_ns) {
      predictor_.add(samples_[next_++]);
    }
    const auto R_from_to = predictor_.rotation(from_ns, to_ns);
    if (!R_from_to) why_missed_ = *predictor_.whyNot();
    return R_from_to;
  }

  void observe(const OdometryResult& result) { predictor_.observe(result); }

  /// How many rotations were predicted, and the bias.
  void printSummary(std::ostream& out) const {
    const GyroPredictor::Counts& counts = predictor_.counts();
    const Eigen::Vector3d& bias = predictor_.bias().bias_rps();
    out << "gyroscope: " << counts.predicted << " of " << counts.predicted + counts.missed
        << cv::format(" rotations predicted, bias %.4f %.4f %.4f (+- %.4f) rad/s\n",
                      bias.x(),
                      bias.y(),
                      bias.z(),
                      std::sqrt(predictor_.bias().covariance().trace()));
    if (counts.missed > 0) out << "  last one missed: " << why_missed_ << '\n';
    if (counts.rejected > 0) out << "  " << counts.rejected << " samples rejected\n";
  }

 private:
  std::vector<GyroSample> samples_;
  std::size_t next_ = 0;
  GyroPredictor predictor_;
  std::string why_missed_;  // the last one that was
};

std::optional<RecordedGyro> openGyro(const Options& options, const Recording& recording) {
  if (options.imu.empty()) return std::nullopt;
  if (std::filesystem::is_regular_file(options.imu)) {
    return RecordedGyro({readGyroFile(options.imu)});
  }
  return RecordedGyro(recording.gyroscope(options.imu));
}

/// Memory of this process, by its name in /proc/self/status: VmRSS is that now, VmHWM its peak. The
/// peak of getrusage() is no less than that of the process which has started this one.
double memory_MB(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind(name + ":", 0) == 0) return 1024e-6 * std::stod(line.substr(name.size() + 1));
  }
  return 0.0;
}

/// All pairs of a recording, read in advance, so that reading does not disturb the timing.
class PreloadedPairs {
 public:
  explicit PreloadedPairs(RecordedPairs& pairs) {
    StereoPair pair;
    StereoCamera camera;
    while (pairs.next(pair, camera)) {
      for (const cv::Mat& image : {pair.left, pair.right}) {
        images_MB_ += 1e-6 * static_cast<double>(image.total() * image.elemSize());
      }
      // The next call overwrites its images.
      pair.left = pair.left.clone();
      pair.right = pair.right.clone();
      pairs_.emplace_back(pair, camera);
    }
    loaded_MB_ = memory_MB("VmRSS");
  }

  /// Returns false and leaves the arguments unchanged at the end.
  bool next(StereoPair& pair, StereoCamera& camera) {
    if (next_ == pairs_.size()) return false;
    std::tie(pair, camera) = pairs_[next_];
    ++next_;
    return true;
  }

  /// Prints the peak memory of the process, split by use.
  void printMemory() const {
    const double peak_MB = memory_MB("VmHWM");
    std::cout << cv::format(
        "peak memory: %.1f MB without the images (%.1f MB), of which %.1f MB for the odometry\n",
        peak_MB - images_MB_,
        images_MB_,
        peak_MB - loaded_MB_);
  }

 private:
  std::vector<std::pair<StereoPair, StereoCamera>> pairs_;
  std::size_t next_ = 0;
  double images_MB_ = 0.0;
  double loaded_MB_ = 0.0;  // memory of the process after reading all images
};

void run(const Options& options) {
  const Parameters parameters = readParameters(options.input);
  const std::unique_ptr<Recording> recording = openInput(options.input, parameters.node);
  RecordedPairs pairs(*recording, parameters.node, options.input.rectify);
  std::cerr << "offline_odometry: reading " << recording->description()
            << (pairs.rectifies()                ? ", rectified by camera_info"
                : recording->hasRawCalibration() ? ", taken as rectified: camera_info is of raw "
                                                   "images (see --rectify)"
                                                 : "")
            << '\n';
  std::optional<RecordedGyro> gyro = openGyro(options, *recording);
  std::optional<PreloadedPairs> preloaded;
  if (options.preload) preloaded.emplace(pairs);
  OdometryOutputs outputs(options.output, *recording, parameters);

  RotationSource rotation;
  if (gyro) {
    rotation = [&](std::int64_t from_ns, std::int64_t to_ns) {
      return gyro->rotation(from_ns, to_ns);
    };
  }
  VisualOdometry odometry(parameters.odometry);
  RecordingInspector inspector(parameters.odometry, pairs.rectifies());
  std::string cause;  // of pairs without a good motion
  ProgressBar progress("odometry", recording->size());
  StereoPair pair;
  StereoCamera camera;
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  std::int64_t last_time_ns = last_ns;
  while (preloaded ? preloaded->next(pair, camera) : pairs.next(pair, camera)) {
    if (pair.time_ns() <= last_time_ns) {  // as in the node
      const bool keep = parameters.node.pose_after_time_jump == "keep";
      std::cerr << "offline_odometry: time jumps back from " << stampText(last_ns) << " to "
                << stampText(pair.stamp_ns) << " s: restarting at "
                << (keep ? "the last pose" : "initial_pose") << " (pose_after_time_jump)\n";
      odometry.reset();
      inspector.inspector().reset();
      if (!keep) outputs.restart();
    }
    last_ns = pair.stamp_ns;
    last_time_ns = pair.time_ns();
    PairRecord record = process(odometry, pair, camera, rotation);
    const OdometryResult estimated = record.result;
    record.result = inspector.inspector().distrusted(estimated);  // as the node has it
    inspector.inspect(pair, camera, estimated);
    const std::string found = inspector.inspector().finish();
    if (!found.empty()) cause = found;
    if (gyro) gyro->observe(record.result);
    outputs.write(record, pair, camera, odometry);
    progress.advance();
  }
  progress.finish();
  outputs.printSummary(std::cout);
  if (cause.empty()) cause = inspector.faultOfSinglePairs();
  if (cause.empty() && inspector.inspector().isUnexplained()) {
    cause = "single pairs do not show it; `rosrun rotrocc check_rig INPUT` compares all of them";
  }
  if (!cause.empty()) std::cout << "likely cause of lost or degraded pairs: " << cause << '\n';
  if (gyro) gyro->printSummary(std::cout);
  if (preloaded) preloaded->printMemory();
  if (const std::string left_out = pairs.leftOut(); !left_out.empty()) {
    std::cout << "left out: " << left_out << "; pairs are within "
              << parameters.node.max_stamp_difference_s << " s (max_stamp_difference_s)"
              << (options.output.format == "kitti"
                      ? "; trajectory lines do not match image numbers: use --format tum\n"
                      : "\n");
  }
  outputs.requireMotion();
}

}  // namespace

int main(int argc, char** argv) {
  // Of what the node logs, only warnings: stdout is for the figures.
  if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Warn)) {
    ros::console::notifyLoggerLevelsChanged();
  }
  return runProgram("offline_odometry", argc, argv, parse, run);
}
