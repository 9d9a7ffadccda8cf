#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "common/print_help.h"
#include "viewer/trajectory_scene.h"

namespace {

using namespace rotrocc;

const char* const kHelp =
    "Makes what rviz shows of the trajectory as a whole: its lines, state and speed in words.\n\n"
    "example: ROS_NAMESPACE=camera rosrun rotrocc rviz_scene\n"
    "usage:   rviz_scene [_least_size_m:=METRES] [TOPIC:=TOPIC...]\n\n"
    "From odom, status and ground_truth/path it makes the markers `scene`, and the frame\n"
    "trajectory_view in tf, which moves back as the path grows. The launch files start it with "
    "rviz.\n\n"
    "Parameters:\n"
    "  least_size_m  what is seen around the start [m], default 4\n";

class RvizScene {
 public:
  RvizScene(ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
      : scene_(private_nh.param("least_size_m", 4.0)),
        publisher_(nh.advertise<visualization_msgs::MarkerArray>("scene", 1, true)),
        odometry_(nh.subscribe("odom", 10, &TrajectoryScene::add, &scene_)),
        status_(nh.subscribe("status", 10, &TrajectoryScene::setState, &scene_)),
        truth_(nh.subscribe("ground_truth/path", 1, &TrajectoryScene::setTruth, &scene_)),
        timer_(nh.createWallTimer(ros::WallDuration(kPeriod_s), &RvizScene::onTimer, this)) {}

 private:
  static constexpr double kPeriod_s = 0.1;

  void onTimer(const ros::WallTimerEvent&) {
    if (scene_.empty()) return;
    const geometry_msgs::TransformStamped view = scene_.view();
    if (view.header.stamp != sent_) broadcaster_.sendTransform(view);  // tf warns of repetitions
    sent_ = view.header.stamp;
    publisher_.publish(scene_.markers());
  }

  TrajectoryScene scene_;
  ros::Time sent_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Publisher publisher_;
  ros::Subscriber odometry_;
  ros::Subscriber status_;
  ros::Subscriber truth_;
  ros::WallTimer timer_;
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
