#include "bags/recorded_trajectory.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>
#include <boost/algorithm/string/predicate.hpp>

#include "bags/bag_reading.h"
#include "bags/stereo_topics.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

const char* const kBag = ".bag";
const char* const kTypes[] = {"nav_msgs/Odometry",
                              "nav_msgs/Path",
                              "geometry_msgs/PoseStamped",
                              "geometry_msgs/PoseWithCovarianceStamped",
                              "geometry_msgs/TransformStamped"};

class Poses {
 public:
  void add(const std_msgs::Header& header, const geometry_msgs::Pose& pose) {
    Eigen::Isometry3d T;
    tf2::fromMsg(pose, T);
    poses_.push_back({toNanoseconds(header.stamp), T});
  }
  void add(const geometry_msgs::TransformStamped& transform) {
    poses_.push_back({toNanoseconds(transform.header.stamp), tf2::transformToEigen(transform)});
  }
  void clear() { poses_.clear(); }

  /// Without those of the same time.
  Trajectory sorted() {
    std::stable_sort(poses_.begin(), poses_.end(), [](const auto& a, const auto& b) {
      return a.stamp_ns < b.stamp_ns;
    });
    const auto end = std::unique(poses_.begin(), poses_.end(), [](const auto& a, const auto& b) {
      return a.stamp_ns == b.stamp_ns;
    });
    poses_.erase(end, poses_.end());
    return poses_;
  }

 private:
  Trajectory poses_;
};

void add(const rosbag::MessageInstance& instance, Poses& poses) {
  const std::string& type = instance.getDataType();
  if (type == kTypes[0]) {
    const auto message = readMessage<nav_msgs::Odometry>(instance);
    poses.add(message->header, message->pose.pose);
  } else if (type == kTypes[1]) {
    poses.clear();
    const auto path = readMessage<nav_msgs::Path>(instance);
    for (const auto& pose : path->poses) poses.add(pose.header, pose.pose);
  } else if (type == kTypes[2]) {
    const auto message = readMessage<geometry_msgs::PoseStamped>(instance);
    poses.add(message->header, message->pose);
  } else if (type == kTypes[3]) {
    const auto message = readMessage<geometry_msgs::PoseWithCovarianceStamped>(instance);
    poses.add(message->header, message->pose.pose);
  } else {
    poses.add(*readMessage<geometry_msgs::TransformStamped>(instance));
  }
}

void addTf(const Bags& bags, const std::string& parent, const std::string& child, Poses& poses) {
  for (const rosbag::MessageInstance& instance : BagView(bags, {"/tf", "tf"})) {
    const auto message = readMessage<tf2_msgs::TFMessage>(instance);
    for (const auto& transform : message->transforms) {
      const auto is = [](const std::string& frame, const std::string& name) {
        return frame == name || frame == "/" + name;
      };
      if (is(transform.header.frame_id, parent) && is(transform.child_frame_id, child)) {
        poses.add(transform);
      }
    }
  }
}

/// Of a topic, or of the only odometry.
std::string topicOf(const TopicTypes& types, const std::string& topic, const std::string& bag) {
  std::vector<std::string> odometry;
  std::string list;
  for (const auto& [name, type] : types) {
    if (std::find(std::begin(kTypes), std::end(kTypes), type) == std::end(kTypes)) continue;
    if (name == topic || name == "/" + topic) return name;
    if (type == kTypes[0]) odometry.push_back(name);
    list += "\n  " + bag + ":" + name;
  }
  if (topic.empty() && odometry.size() == 1) return odometry.front();
  throw std::runtime_error((topic.empty() ? "more than one or no odometry in " + bag
                                          : "no poses of " + topic + " in " + bag) +
                           ": name one of" + (list.empty() ? " (none)" : list) + "\nor " + bag +
                           ":PARENT:CHILD for tf");
}

}  // namespace

bool isInBag(const std::string& name) {
  return name.find(std::string(kBag) + ":") != std::string::npos ||
         boost::algorithm::ends_with(name, kBag);
}

Trajectory readRecordedTrajectory(const std::string& name) {
  const std::size_t end = name.rfind(kBag) + std::string(kBag).size();
  const std::string bag = name.substr(0, end);
  const std::string what = name.substr(std::min(end + 1, name.size()));
  const Bags bags = openBags({bag});
  Poses poses;
  if (const std::size_t colon = what.find(':'); colon != std::string::npos) {
    addTf(bags, what.substr(0, colon), what.substr(colon + 1), poses);
  } else {
    for (const auto& instance : BagView(bags, {topicOf(topicTypes(bags), what, bag)})) {
      add(instance, poses);
    }
  }
  Trajectory trajectory = poses.sorted();
  if (trajectory.empty()) throw std::runtime_error(bag + " has no poses of " + what);
  return trajectory;
}

}  // namespace rotrocc
