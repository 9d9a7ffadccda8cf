#include <string>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <boost/program_options.hpp>

#include "input/camera_calibration.h"
#include "sequences/calibration_file.h"
#include "tools/program.h"

namespace {

namespace po = boost::program_options;

const char* const kUsage =
    "Publishes a camera_info for each image, for drivers and bags without one.\n\n"
    "example: publish_camera_info left.yaml image:=/cam0/image_raw camera_info:=/cam0/camera_info\n"
    "usage:   publish_camera_info CALIBRATION.yaml [remappings]\n"
    "         publish_camera_info CALIBRATION... --side left|right [remappings]\n\n"
    "CALIBRATION.yaml is a file of camera_calibration, or camera_info as rostopic prints it. With "
    "--side,\nthe files are those of a stereo camera in any format that --calibration of "
    "offline_odometry reads.\nRemap the topics image and camera_info to those of the camera.\n\n";

struct Options {
  std::vector<std::string> files;
  std::string side;
};

bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("side", po::value(&options.side), "left or right camera of a stereo calibration");
  po::variables_map variables;
  if (!rotrocc::parseCommandLine(argc, argv, kUsage, visible, options.files, variables)) {
    return false;
  }
  if (!options.side.empty() && options.side != "left" && options.side != "right") {
    throw po::error("--side is '" + options.side + "', not left or right");
  }
  if (options.files.empty() || (options.side.empty() && options.files.size() != 1)) {
    throw po::error("expected a file of one camera, or files of a stereo camera and --side");
  }
  return true;
}

sensor_msgs::CameraInfo read(const Options& options) {
  if (options.side.empty()) return rotrocc::readCameraInfo(options.files[0]);
  const auto infos = rotrocc::toCameraInfos(rotrocc::readStereoCalibration(options.files));
  return options.side == "left" ? infos.first : infos.second;
}

void run(const Options& options) {
  sensor_msgs::CameraInfo info = read(options);
  ros::NodeHandle nh;
  const ros::Publisher publisher = nh.advertise<sensor_msgs::CameraInfo>("camera_info", 10);
  const auto onImage = [&](const sensor_msgs::Image::ConstPtr& image) {
    info.header = image->header;
    publisher.publish(info);
  };
  const ros::Subscriber subscriber = nh.subscribe<sensor_msgs::Image>(
      "image", 10, onImage, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "publish_camera_info", ros::init_options::AnonymousName);
  return rotrocc::runProgram("publish_camera_info", argc, argv, parse, run);
}
