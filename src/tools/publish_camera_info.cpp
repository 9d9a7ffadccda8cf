#include <string>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <boost/program_options.hpp>

#include "sequences/calibration_file.h"
#include "tools/program.h"

namespace {

namespace po = boost::program_options;

const char* const kUsage =
    "Publishes a camera_info for each image, for drivers and bags without one.\n\n"
    "example: publish_camera_info left.yaml image:=/cam0/image_raw camera_info:=/cam0/camera_info\n"
    "usage:   publish_camera_info CALIBRATION.yaml [remappings]\n\n"
    "CALIBRATION.yaml is a file of camera_calibration. Remap the topics image and camera_info to\n"
    "those of the camera.\n\n";

using Files = std::vector<std::string>;

bool parse(int argc, char** argv, Files& files) {
  po::options_description visible("Options");
  visible.add_options()("help,h", "show this help");
  po::variables_map variables;
  if (!rotrocc::parseCommandLine(argc, argv, kUsage, visible, files, variables)) return false;
  if (files.size() != 1) throw po::error("expected a file of camera_calibration");
  return true;
}

void run(const Files& files) {
  sensor_msgs::CameraInfo info = rotrocc::readCameraInfo(files[0]);
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
