#include "rotrocc/parameters.h"

#include "parameters/sections.h"
#include "rotrocc/flow_picture.h"

namespace rotrocc {
namespace {

void addNode(NodeParameters& n, ParameterTable& table) {
  table.add("odom_frame", n.odom_frame).description = "frame of the published pose";
  table.add("base_frame", n.base_frame).description =
      "robot frame whose pose and twist are published";
  table.add("camera_frame", n.camera_frame).description =
      "frame of the left camera; if empty, frame_id of the left images";
  table.add("publish_tf", n.publish_tf).description = "broadcast odom_frame -> base_frame";
  table.add("invert_tf", n.invert_tf).description = "broadcast base_frame -> odom_frame instead";
  table.add("planar", n.planar).description = "restrict the motion of base_frame to x, y and yaw";
  table.add("initial_pose", n.initial_pose, "m, rad").description =
      "x y z roll pitch yaw of base_frame in odom_frame at the first pair, also after a reset";
  table.add("mount_timeout_s", n.mount_timeout_s, {0.0, 10.0, "s"}).description =
      "how long a pair waits for the transform of a camera that moves on the robot";
  table.add("guess_frame", n.guess_frame).description =
      "odom frame of another odometry in tf, used as motion prediction; odom_frame -> guess_frame "
      "is then broadcast; none if empty";
  table.add("guess_timeout_s", n.guess_timeout_s, {0.0, 1.0, "s"}).description =
      "how long a pair waits for the transform from guess_frame";
  table.add("use_imu", n.use_imu).description =
      "predict rotations by the gyroscope of the topic imu; its frame must be in tf";
  table.add("imu_timeout_s", n.imu_timeout_s, {0.0, 1.0, "s"}).description =
      "how long a pair waits for the samples of the gyroscope";
  table.add("rectify", n.rectify).description =
      "subscribe to left/image_raw and right/image_raw instead of image_rect, and rectify by K, "
      "D, R and P of camera_info";
  table.add("image_transport", n.image_transport).description =
      "transport of both images: raw, compressed, ...";
  table.add("max_stamp_difference_s", n.max_stamp_difference_s, {0.0, 1.0, "s"}).description =
      "largest stamp difference between the left and the right image of a pair";
  table.add("queue_size", n.queue_size, {1, 100}).description = "unmatched images kept per side";
  table.add("max_image_pixels", n.max_image_pixels, {256, 1000000000, "px"}).description =
      "largest number of pixels of an image; larger images are dropped";
  table.add("max_future_s", n.max_future_s, {0.0, 1e9, "s"}).description =
      "images with stamps further ahead of the clock are dropped";
  table.add("baseline_m", n.baseline_m, {0.0, 100.0, "m"}).description =
      "baseline, if camera_info has none in P[3]; 0: use P[3]";
  table.add("pose_after_time_jump", n.pose_after_time_jump, {"keep", "zero"}).description =
      "pose after time jumps back, e.g. with a looping bag; zero is initial_pose";
  table.add("silence_s", n.silence_s, {0.5, 3600.0, "s"}).description =
      "time without a stereo pair until the log reports the received input and a remedy";
  table.add("flow_view", n.flow_view, flowViewNames()).description = "contents of the flow topic";
  table.add("path_length", n.path_length, {0, 1000000}).description =
      "number of poses in the path topic";
  table.add("path_rate_hz", n.path_rate_hz, {0.01, 1000.0, "Hz"}).description =
      "rate of the path topic, at most, in real time";
  table.add("lost_speed_sigma_mps", n.lost_speed_sigma_mps, {0.0, 1000.0, "m/s"}).description =
      "assumed standard deviation of the speed while lost";
  table.add("lost_turn_rate_sigma_rps", n.lost_turn_rate_sigma_rps, {0.0, 100.0, "rad/s"})
      .description = "assumed standard deviation of the turn rate while lost";
  table.add("guess_error_share", n.guess_error_share, {0.0, 10.0}).description =
      "standard deviation of the motion in guess_frame that moves the pose while lost, as a share "
      "of way and angle";
  table.add("reset_after_lost_s", n.reset_after_lost_s, {0.0, 1e6, "s"}).description =
      "the estimator restarts with the next pair after it was lost for this time; 0: it only goes "
      "on trying";
  table.add("pose_after_lost", n.pose_after_lost, {"keep", "zero"}).description =
      "pose after reset_after_lost_s; zero is initial_pose";
  table.add("trajectory_length", n.trajectory_length, {1, 10000000}).description =
      "number of poses kept for the service save_trajectory";
  table.add("trajectory_file", n.trajectory_file).description =
      "file for the poses of the left camera, none if empty; it is never replaced: a later "
      "trajectory goes to NAME_2, NAME_3, ...";
  table.add("trajectory_format", n.trajectory_format, {"tum", "kitti"}).description =
      "format of trajectory_file";
}

}  // namespace

ParameterTable makeParameterTable(Parameters& parameters) {
  ParameterTable table;
  addNode(parameters.node, table);
  addOdometry(parameters.odometry, table);
  return table;
}

}  // namespace rotrocc
