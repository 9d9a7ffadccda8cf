#include <string>
#include <utility>
#include <vector>

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "common/print_help.h"
#include "viewer/trajectory_scene.h"

namespace {

using namespace rotrocc;

const char* const kHelp =
    "Publishes the rviz overview of a trajectory: its lines, state and speed in words.\n\n"
    "example: ROS_NAMESPACE=camera rosrun rotrocc rviz_scene\n"
    "usage:   rviz_scene [_least_size_m:=METERS] [TOPIC:=TOPIC...]\n\n"
    "From odom, status and ground_truth/path it publishes the markers `scene`, and in tf the "
    "frame\n"
    "trajectory_view/NAMESPACE, which moves back as the path grows. The launch files start it with "
    "rviz.\n\n"
    "Parameters:\n"
    "  least_size_m  what is seen around the start [m], default 4\n";

class RvizScene {
 public:
  RvizScene(ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
      : scene_(private_nh.param("least_size_m", 4.0),
               "trajectory_view" + (nh.getNamespace() == "/" ? "" : nh.getNamespace())),
        publisher_(nh.advertise<visualization_msgs::MarkerArray>(
            "scene", 100, [this](const ros::SingleSubscriberPublisher&) { forgetSent(); })),
        odometry_(nh.subscribe("odom", 10, &TrajectoryScene::add, &scene_)),
        status_(nh.subscribe("status", 10, &TrajectoryScene::setState, &scene_)),
        truth_(nh.subscribe("ground_truth/path", 1, &TrajectoryScene::setTruth, &scene_)),
        timer_(nh.createWallTimer(ros::WallDuration(0.1), &RvizScene::sendChanges, this)),
        // For a viewer that was reset, or has missed a message.
        refresh_(nh.createWallTimer(ros::WallDuration(5.0), &RvizScene::forgetSent, this)) {}

 private:
  void forgetSent(const ros::WallTimerEvent& = {}) { sent_.clear(); }

  void sendChanges(const ros::WallTimerEvent&) {
    if (scene_.empty()) return;
    const geometry_msgs::TransformStamped view = scene_.view();
    if (view.header.stamp != view_time_)
      broadcaster_.sendTransform(view);  // tf warns of repetitions
    view_time_ = view.header.stamp;

    std::vector<visualization_msgs::Marker> markers = scene_.markers().markers;
    visualization_msgs::MarkerArray changed;
    if (markers.size() < sent_.size()) {
      sent_.clear();
      changed.markers.emplace_back().action = visualization_msgs::Marker::DELETEALL;
    }
    for (std::size_t i = 0; i < markers.size(); ++i) {
      if (i >= sent_.size() || markers[i] != sent_[i]) changed.markers.push_back(markers[i]);
    }
    if (!changed.markers.empty()) publisher_.publish(changed);
    sent_ = std::move(markers);
  }

  TrajectoryScene scene_;
  std::vector<visualization_msgs::Marker> sent_;
  ros::Time view_time_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Publisher publisher_;
  ros::Subscriber odometry_;
  ros::Subscriber status_;
  ros::Subscriber truth_;
  ros::WallTimer timer_;
  ros::WallTimer refresh_;
};

}  // namespace

int main(int argc, char** argv) {
  if (printHelp(argc, argv, kHelp)) return 0;
  ros::init(argc, argv, "rviz_scene");
  ros::NodeHandle nh;
  const RvizScene scene(nh, ros::NodeHandle("~"));
  ros::spin();
  return 0;
}
