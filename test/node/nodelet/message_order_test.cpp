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

/// Topics in the order in which the messages of a stamp arrive.
class Arrivals {
 public:
  Arrivals() {
    nh_.setCallbackQueue(&queue_);
    listen<tf2_msgs::TFMessage>("/tf");
    listen<nav_msgs::Odometry>("odom");
    listen<OdometryStatus>("status");
    listen<nav_msgs::Path>("path");
    listen<sensor_msgs::PointCloud2>("inliers");
    listen<sensor_msgs::Image>("flow");
    spinner_.start();
  }

  /// The topics of each pair that has sent all of them.
  std::vector<std::vector<std::string>> complete() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<std::vector<std::string>> found;
    for (const auto& [stamp, topics] : arrivals_) {
      if (topics.size() == subscribers_.size()) found.push_back(topics);
    }
    return found;
  }

 private:
  template <class Message>
  void listen(const std::string& topic) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [this, topic](const boost::shared_ptr<const Message>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          arrivals_[stampOf(*message)].push_back(topic);
        };
    subscribers_.push_back(nh_.subscribe<Message>(topic, 100, callback));
  }

  mutable std::mutex mutex_;
  std::map<ros::Time, std::vector<std::string>> arrivals_;
  ros::NodeHandle nh_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};  // one thread: keeps the order
  std::vector<ros::Subscriber> subscribers_;
};

TEST(MessageOrderTest, TfAndOdometryComeBeforeStatusPathAndPictures) {
  NodeletDrive drive({{"path_rate_hz", 1000.0}});  // with each pair
  Arrivals arrivals;
  drive.setUp();
  EXPECT_TRUE(waitUntil([&] {  // not all subscribers are connected at the first pairs
    drive.odometryOf(drive.robot.drive());
    return arrivals.complete().size() >= 5;
  }));
  for (const auto& topics : arrivals.complete()) {
    EXPECT_EQ(topics[0], "/tf");
    EXPECT_EQ(topics[1], "odom");
  }
}

}  // namespace
}  // namespace rotrocc
