// Subscribes to all that the odometry publishes, to be stopped and continued from outside: while it
// is stopped, it does not read its sockets, as a computer behind a bad network.

#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include "rotrocc/OdometryStatus.h"

namespace {

template <class Message>
ros::Subscriber subscribe(ros::NodeHandle& nh, const std::string& topic) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> ignore =
      [](const boost::shared_ptr<const Message>&) {};
  return nh.subscribe<Message>(topic, 1, ignore);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "slow_subscriber", ros::init_options::AnonymousName);
  ros::NodeHandle nh;
  const ros::Subscriber subscribers[] = {subscribe<nav_msgs::Odometry>(nh, "odom"),
                                         subscribe<nav_msgs::Path>(nh, "path"),
                                         subscribe<rotrocc::OdometryStatus>(nh, "status"),
                                         subscribe<sensor_msgs::Image>(nh, "flow"),
                                         subscribe<sensor_msgs::PointCloud2>(nh, "inliers")};
  ros::spin();
}
