#include <cmath>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "bags/sequence_bag_writer.h"
#include "input/to_text.h"
#include "rotrocc/trajectory.h"
#include "simulation/drives/scenario.h"
#include "simulation/sequence_writer.h"
#include "simulation/simulator.h"
#include "tools/program.h"
#include "tools/progress_bar.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace rotrocc;

const char* const kUsage =
    "Renders a simulated stereo drive with exact poses.\n\n"
    "example: simulate_drive city drive --frames 100\n"
    "usage:   simulate_drive SCENARIO OUT [options]\n"
    "         simulate_drive --poses FILE OUT [options]\n\n"
    "SCENARIO  city (a town with a stop), motorway (25 m/s), slip_road (26 deg/s), parking\n"
    "          (0.8 m/s and a standstill while a car passes) or handheld (1.4 m/s, looking "
    "around)\n"
    "OUT       a new directory, a .bag, or a .csv for the gyroscope alone\n\n";

struct Options {
  std::vector<std::string> names;
  std::string poses;
  std::string times;
  std::string size = "1241x376";
  double focal_px = kittiCamera().fx;
  double baseline_m = kittiCamera().baseline_m;
  std::string layout = "kitti";
  std::string lens = "radtan";
  std::vector<double> right_rotation_deg;
  SequenceWriter::Extras extras;
  SimulationOptions simulation;
};

po::options_description describe(Options& options) {
  SimulationOptions& simulation = options.simulation;
  CameraFaults& faults = simulation.faults;
  const auto number = [](double& value) {
    return po::value(&value)->default_value(value, toText(value));
  };
  po::options_description what("Contents");
  auto add = what.add_options();
  add("help,h", "show this help");
  add("layout", withDefault(options.layout), "kitti, or asl: raw images as of EuRoC");
  add("poses", po::value(&options.poses), "a street along these poses (KITTI or TUM format)");
  add("times", po::value(&options.times), "times.txt of poses in KITTI format (default: 10 Hz)");
  add("frames", po::value(&simulation.frames), "largest number of pairs");
  add("rate", number(simulation.rate_hz), "[Hz] frame rate of a scenario");
  add("seed", withDefault(simulation.seed), "same seed, same bytes");
  add("noise-seed", po::value(&simulation.noise_seed), "of the image noise (default: seed)");
  add("moving-share", number(simulation.moving_share), "density of moving cars, 0 to 1");
  add("truth", po::bool_switch(&options.extras.depth), "also write the depth of each pixel");
  add("imu",
      po::bool_switch(&options.extras.imu),
      "also write a gyroscope of 200 Hz with noise and bias: imu.csv in axes of the left camera, "
      "or /imu/data in axes of base_link");
  po::options_description camera("Camera");
  add = camera.add_options();
  add("size", withDefault(options.size), "image size WxH [px]");
  add("focal", number(options.focal_px), "focal length [px]");
  add("baseline", number(options.baseline_m), "baseline [m]");
  add("lens", withDefault(options.lens), "of the layout asl: radtan or equidistant");
  po::options_description wrong("Faults, not in calib.txt");
  add = wrong.add_options();
  add("disparity-bias", number(faults.disparity_bias_px), "[px] added to all disparities");
  add("right-rotation",
      po::value(&options.right_rotation_deg)->multitoken(),
      "ROLL PITCH YAW [deg]: rotation of the right camera");
  add("right-focal", number(faults.right_focal_ratio), "right over nominal focal length");
  add("rows", number(faults.row_offset_px), "[px] by which the right image is lower");
  add("time-skew", number(faults.time_skew_s), "[s] delay of the right camera");
  add("noise", number(faults.noise_sigma), "[gray levels] standard deviation of the noise");
  add("motion-blur", number(faults.motion_blur_s), "[s] exposure time");
  po::options_description all;
  all.add(what).add(camera).add(wrong);
  return all;
}

void setCamera(Options& options) {
  StereoCamera& camera = options.simulation.camera;
  const StereoCamera kitti = camera;
  char by = 0;
  std::istringstream size(options.size);
  if (!(size >> camera.width >> by >> camera.height) || by != 'x' || !size.eof()) {
    throw po::error("--size is '" + options.size + "', not WxH");
  }
  camera.fx = camera.fy = options.focal_px;
  camera.baseline_m = options.baseline_m;
  // The principal point keeps its relative position in the image.
  camera.cx = camera.cx_right = (kitti.cx + 0.5) * camera.width / kitti.width - 0.5;
  camera.cy = (kitti.cy + 0.5) * camera.height / kitti.height - 0.5;
}

void setLayout(const po::variables_map& variables, Options& options) {
  if (options.layout != "kitti" && options.layout != "asl") {
    throw po::error("--layout is '" + options.layout + "', not kitti or asl");
  }
  if (options.layout == "asl") {
    options.simulation.lens = options.lens;
    if (options.extras.depth) throw po::error("--truth is for the layout kitti");
  } else if (!variables["lens"].defaulted()) {
    throw po::error("--lens is for the layout asl: rectified images have none");
  }
}

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  const po::options_description visible = describe(options);
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage, visible, options.names, variables)) return false;
  if (variables.count("noise-seed") == 0) options.simulation.noise_seed = options.simulation.seed;
  const std::size_t expected = options.poses.empty() ? 2 : 1;
  if (options.names.size() != expected) {
    throw po::error(expected == 2 ? "expected a scenario and an output" : "expected one output");
  }
  if (!options.right_rotation_deg.empty()) {
    if (options.right_rotation_deg.size() != 3) throw po::error("--right-rotation takes 3 numbers");
    options.simulation.faults.right_rotation_rad =
        Eigen::Vector3d(options.right_rotation_deg.data()) * M_PI / 180.0;
  }
  setCamera(options);
  setLayout(variables, options);
  return true;
}

Trajectory readPoses(const Options& options) {
  Trajectory poses = readTrajectory(options.poses);
  if (options.times.empty()) return poses;
  const std::vector<std::int64_t> stamps_ns = readTimes(options.times);
  if (stamps_ns.size() < poses.size()) {
    throw std::runtime_error(options.times + " has fewer times than " + options.poses +
                             " has poses");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].stamp_ns = stamps_ns[i];
  return poses;
}

Scenario chosenScenario(const Options& options) {
  const std::uint64_t seed = options.simulation.seed;
  if (options.poses.empty()) return scenario(options.names.front(), seed);
  return scenarioAlong(readPoses(options), seed);
}

void renderSequence(const Simulator& simulator,
                    const std::string& directory,
                    const Options& options) {
  SequenceWriter writer(directory, simulator, options.extras);
  ProgressBar progress("simulate_drive", static_cast<std::size_t>(simulator.size()));
  for (int index = 0; index < simulator.size(); ++index) {
    writer.write(simulator.render(index));
    progress.advance();
  }
  progress.finish();
}

void renderBag(const Simulator& simulator, const std::string& bag, const Options& options) {
  if (options.extras.depth) {
    throw std::invalid_argument("--truth needs a directory as output: a bag has no depth");
  }
  const struct Scratch {
    ~Scratch() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
    std::string path;
  } frames{bag + ".frames"};
  fs::remove_all(frames.path);
  renderSequence(simulator, frames.path, options);
  writeSequenceBag(bag, frames.path);
}

void run(const Options& options) {
  const std::string& out = options.names.back();
  const std::string extension = fs::path(out).extension();
  const Simulator simulator(chosenScenario(options), options.simulation);
  if (extension == ".csv") {
    writeGyroscope(out, simulator.gyroscope());
  } else if (extension == ".bag") {
    renderBag(simulator, out, options);
  } else {
    renderSequence(simulator, out, options);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("simulate_drive", argc, argv, parse, run);
}
