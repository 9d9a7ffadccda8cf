// What rviz shows of the trajectory as a whole: rosrun rotrocc rviz_scene, in the namespace of the
// odometry. From odom, status and ground_truth/path it makes the markers `scene`, and the frame
// trajectory_view in tf, which rviz/*.rviz look from.

#include <chrono>

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "input/throttle.h"
#include "viewer/trajectory_scene.h"

namespace {

using namespace rotrocc;

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
  ros::init(argc, argv, "rviz_scene");
  ros::NodeHandle nh;
  const RvizScene scene(nh, ros::NodeHandle("~"));
  ros::spin();
  return 0;
}
