#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "evaluation/image_file.h"
#include "rotrocc/kitti.h"
#include "simulation/stress/image_stress.h"
#include "tools/program.h"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace rotrocc;

const char* const kUsage =
    "Makes the images of a sequence worse: fog, gains, noise, drops, JPEG.\n\n"
    "example: stress_sequence drive foggy_drive --contrast 0.3\n"
    "usage:   stress_sequence IN OUT [options]\n\n"
    "IN   a directory in KITTI odometry layout, best rendered with --noise 0\n"
    "OUT  a new one with the same times, poses and calibration\n\n";

struct Options {
  std::vector<std::string> names;
  ImageStress stress;
};

po::options_description describe(ImageStress& stress) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("plain",
      withDefault(stress.plain_share),
      "share of the image, from its left border on, that has no texture");
  add("drops",
      withDefault(stress.drop_share),
      "share of the image that drops on the lenses cover, others in left and right");
  add("gain-step",
      withDefault(stress.gain_step),
      "factor by which the gain of both cameras changes, up and down, every 5 pairs");
  add("contrast", withDefault(stress.contrast), "share of the contrast that is left, as in fog");
  add("right-gain",
      withDefault(stress.right_gain),
      "factor of all grey levels of the right images");
  add("right-offset",
      withDefault(stress.right_offset),
      "[grey levels] added to the right images after that");
  add("noise", withDefault(stress.noise_sigma), "[grey levels] standard deviation of the noise");
  add("jpeg", withDefault(stress.jpeg_quality), "quality of a JPEG compression, 1 to 100; 0: none");
  add("seed", withDefault(stress.seed), "same seed, same bytes");
  return visible;
}

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  const po::options_description visible = describe(options.stress);
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage, visible, options.names, variables)) return false;
  if (options.names.size() != 2) throw po::error("expected an input and an output");
  return true;
}

void run(const Options& options) {
  options.stress.check();
  const fs::path out(options.names[1]);
  if (fs::exists(out)) throw std::runtime_error(out.string() + " exists: choose a new directory");
  const KittiSequence sequence(options.names[0]);
  for (const char* folder : {"image_0", "image_1"}) fs::create_directories(out / folder);
  for (const char* file : {"calib.txt", "times.txt", "poses.txt"}) {
    const fs::path from = fs::path(options.names[0]) / file;
    if (fs::exists(from)) fs::copy_file(from, out / file);
  }
  for (int i = 0; i < sequence.size(); ++i) {
    const std::string name = cv::format("%06d.png", i);
    writeImage(out / "image_0" / name, stressed(sequence.readLeft(i), options.stress, i, false));
    writeImage(out / "image_1" / name, stressed(sequence.readRight(i), options.stress, i, true));
  }
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("stress_sequence", argc, argv, parse, run);
}
