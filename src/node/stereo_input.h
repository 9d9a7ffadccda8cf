#pragma once

#include <image_transport/subscriber.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "input/silence_watch.h"
#include "input/stereo_intake.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Subscribes to left/image_rect, left/camera_info, right/image_rect and right/camera_info for an
/// intake; with the parameter rectify to left/image_raw and right/image_raw. Its callbacks must not
/// run at the same time: take a handle of one queue and thread.
class StereoInput {
 public:
  StereoInput(ros::NodeHandle& nh,
              const NodeParameters& parameters,
              DropLog& drops,
              StereoIntake::PairHandler on_pair,
              const Log& log);

  /// Recent input. Logs missing pairs, see SilenceWatch: call about once a second, in the thread of
  /// the callbacks.
  InputReport report();

 private:
  /// Topics of one camera.
  struct Subscribers {
    image_transport::Subscriber image;
    ros::Subscriber info;
  };

  Subscribers subscribe(ros::NodeHandle& nh,
                        const NodeParameters& parameters,
                        StereoIntake::Side side);

  void logOnce(const InputReport& report);

  Log log_;
  bool logged_raw_infos_ = false;
  bool logged_clock_ = false;
  SilenceWatch silence_;
  StereoIntake intake_;
  Subscribers left_, right_;  // last, so that callbacks end before the other members are destroyed
};

}  // namespace rotrocc
