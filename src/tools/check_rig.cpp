#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <boost/program_options.hpp>

#include "check/calibration_correction.h"
#include "check/rig_check.h"
#include "files/report_directory.h"
#include "input/to_text.h"
#include "tools/draw_report.h"
#include "tools/input_options.h"
#include "tools/program.h"
#include "tools/progress_bar.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const std::string kUsage =
    std::string(
        "Checks stereo calibration, exposure, focus and timestamps from a minute of motion.\n\n"
        "example: check_rig drive.bag --report check\n"
        "usage:   check_rig RECORDING... [options]\n"
        "\n"
        "RECORDING ") +
    kRecordingHelp +
    "\n"
    "Exits with 0 if nothing needs fixing, with 3 otherwise.\n\n";

struct Options {
  InputOptions input;
  std::string imu;
  std::string report;
  std::string camera_info;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("report", po::value(&options.report), "folder for a page with pictures");
  add("write-camera-info",
      po::value(&options.camera_info),
      "folder for left.yaml and right.yaml of a corrected calibration, if one is better; the "
      "report "
      "has both");
  add("imu",
      po::value(&options.imu),
      "gyroscope to compare with: a topic of sensor_msgs/Imu in a bag, or a folder or CSV file of "
      "a "
      "sequence");
  visible.add(imageOptions(options.input)).add(parameterOptions(options.input));
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage.c_str(), visible, options.input.paths, variables))
    return false;
  if (options.input.paths.empty()) throw po::error("expected a recording");
  return true;
}

/// Adds the corrected calibration to the report, and writes it.
void addCorrection(const Options& options,
                   Recording& recording,
                   const RigCheckOptions& check,
                   CheckedRig& rig) {
  std::string why_not;
  const auto correction = findCorrection(recording, check, rig.measures, why_not);
  if (!correction) {
    std::cout << "no corrected calibration: " << why_not << "\n\n";
    return;
  }
  writeCalibration(correction->measures.calibration, options.camera_info);
  rig.report.corrected = correction->report.findings;
  for (ReportTable table : correction->report.tables) {
    if (table.name != "rows_map") continue;
    table.name += "_corrected";
    rig.report.tables.push_back(std::move(table));
  }
}

CheckedRig checkInput(const Options& options) {
  RigCheckOptions check;
  check.parameters = readParameters(options.input);
  check.rectify = options.input.rectify;
  const auto recording = openInput(options.input, check.parameters.node);
  if (!options.imu.empty()) check.gyroscope = recording->gyroscope(options.imu);
  ProgressBar progress("check", static_cast<std::size_t>(recording->size()));
  check.on_pair = [&] { progress.advance(); };
  CheckedRig rig = checkRig(*recording, check);
  progress.finish();
  if (!options.camera_info.empty()) addCorrection(options, *recording, check, rig);
  return rig;
}

void run(const Options& options) {
  if (!options.report.empty()) ReportDirectory::require(options.report);
  const CheckedRig rig = checkInput(options);
  std::cout << toText(rig.report);
  if (rig.report.corrected) {
    const StereoCamera& camera = rig.measures.calibration.rectified;
    std::cout << "\nwritten: " << options.camera_info << "/left.yaml and right.yaml, for images of "
              << sizeText(camera.width, camera.height) << ", without binning and roi\n";
  }
  std::cout.flush();
  constexpr int kToFix = 3;  // exit status
  if (!options.report.empty()) {
    writeReport(rig.report, options.report);
    drawReport(options.report);
  }
  if (rig.report.needsFix()) std::exit(kToFix);
}

}  // namespace

int main(int argc, char** argv) {
  if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Error)) {
    ros::console::notifyLoggerLevelsChanged();
  }
  return runProgram("check_rig", argc, argv, parse, run);
}
