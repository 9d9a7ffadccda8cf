// In which order the odometry sends its messages: what it publishes is in the queue of the
// subscribers in this process when it publishes the next one.

#include <vector>

#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include "nodelet_drive.h"

namespace rotrocc {
namespace {

template <class Message>
ros::Time stampOf(const Message& message) {
  return message.header.stamp;
}

ros::Time stampOf(const tf2_msgs::TFMessage& message) {
  return message.transforms.front().header.stamp;
}

TEST(MessageOrderTest, TfAndOdometryComeBeforeStatusPathAndPictures) {
  ros::CallbackQueue queue;
  ros::NodeHandle nh;
  nh.setCallbackQueue(&queue);
  std::vector<ros::Subscriber> subscribers;
  std::map<ros::Time, std::vector<std::string>> arrivals;  // topics in their order, by stamp
  const auto listen = [&](const std::string& topic, const auto& type) {
    using Message = std::decay_t<decltype(type)>;
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [&arrivals, topic](const auto& message) { arrivals[stampOf(*message)].push_back(topic); };
    subscribers.push_back(nh.subscribe<Message>(topic, 100, callback));
  };
  listen("/tf", tf2_msgs::TFMessage());
  listen("odom", nav_msgs::Odometry());
  listen("status", OdometryStatus());
  listen("path", nav_msgs::Path());
  listen("inliers", sensor_msgs::PointCloud2());
  listen("flow", sensor_msgs::Image());

  NodeletDrive drive({{"path_rate_hz", 1000.0}});  // with each pair
  drive.setUp();
  int complete = 0;
  EXPECT_TRUE(waitUntil([&] {  // not all subscribers are connected at the first pairs
    drive.odometryOf(drive.robot.drive());
    queue.callAvailable();
    complete = 0;
    for (const auto& [stamp, topics] : arrivals) complete += topics.size() == subscribers.size();
    return complete >= 5;
  }));
  for (const auto& [stamp, topics] : arrivals) {
    if (topics.size() < subscribers.size()) continue;
    EXPECT_EQ(topics[0], "/tf");
    EXPECT_EQ(topics[1], "odom");
  }
}

}  // namespace
}  // namespace rotrocc
