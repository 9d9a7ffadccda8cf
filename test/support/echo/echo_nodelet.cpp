// A nodelet for tests: publishes each image of its topic image on answer, and takes camera_info.

#include <nodelet/nodelet.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <pluginlib/class_list_macros.hpp>

namespace rotrocc {

class EchoNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    ros::NodeHandle& nh = getNodeHandle();
    answer_ = nh.advertise<sensor_msgs::Image>("answer", 10);
    image_ = nh.subscribe("image", 10, &EchoNodelet::onImage, this);
    info_ = nh.subscribe("camera_info", 10, &EchoNodelet::onInfo, this);
  }

  void onImage(const sensor_msgs::Image::ConstPtr& image) { answer_.publish(image); }
  void onInfo(const sensor_msgs::CameraInfo::ConstPtr&) {}

  ros::Publisher answer_;
  ros::Subscriber image_, info_;
};

}  // namespace rotrocc

PLUGINLIB_EXPORT_CLASS(rotrocc::EchoNodelet, nodelet::Nodelet)
