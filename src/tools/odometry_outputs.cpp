#include "tools/odometry_outputs.h"

#include <cstdint>
#include <iostream>
#include <stdexcept>

#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "evaluation/image_file.h"
#include "evaluation/report_directory.h"
#include "input/message_conversion.h"
#include "node/base/base_odometry.h"
#include "node/odometry_messages.h"
#include "rotrocc/flow_picture.h"

namespace rotrocc {

class OdometryOutputs::OdometryBag {
 public:
  OdometryBag(const std::string& path, const Recording& recording, const Parameters& parameters)
      : parameters_(parameters.node),
        offset_ns_(recording.offset_ns()),
        T_base_camera_(recording.T_base_camera()),
        systematic_error_(parameters.odometry.systematic_error) {
    restart();
    if (const std::string note = recording.mountNote(); !note.empty()) {
      std::cerr << "offline_odometry: " << note << '\n';
    }
    try {
      bag_.open(path, rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error(path + " cannot be written: " + error.what());
    }
  }

  void restart() { odometry_.emplace(parameters_, systematic_error_); }

  void write(const OdometryResult& result) {
    BaseState state = odometry_->add(result, {T_base_camera_});
    state.stamp_ns += offset_ns_;
    const ros::Time stamp = toRosTime(state.stamp_ns);
    const std::string& odom = parameters_.odom_frame;
    const std::string& base = parameters_.base_frame;
    tf2_msgs::TFMessage tf;
    const Eigen::Isometry3d& T = state.T_odom_base.T;
    tf.transforms.push_back(parameters_.invert_tf
                                ? toTransform(T.inverse(), state.stamp_ns, base, odom)
                                : toTransform(T, state.stamp_ns, odom, base));
    bag_.write("/tf", stamp, tf);
    bag_.write("/stereo/odom", stamp, toOdometry(state, odom, base));
  }

 private:
  NodeParameters parameters_;
  std::int64_t offset_ns_;
  Eigen::Isometry3d T_base_camera_;
  SystematicErrorConfig systematic_error_;
  std::optional<BaseOdometry> odometry_;
  rosbag::Bag bag_;
};

class OdometryOutputs::FlowPictures {
 public:
  explicit FlowPictures(const std::string& folder) : folder_(folder) {}

  void write(const StereoPair& pair,
             const StereoCamera& camera,
             const VisualOdometry& odometry,
             const OdometryResult& result) {
    drawFlowPicture({pair,
                     camera,
                     odometry.correspondences(),
                     odometry.rotationInliers(),
                     odometry.translationInliers(),
                     result},
                    picture_);
    writeImage(folder_.path(cv::format("%06d.png", pairs_++)), picture_);
  }

 private:
  ReportDirectory folder_;
  int pairs_ = 0;
  cv::Mat picture_;
};

OdometryOutputs::OdometryOutputs(const OutputFiles& files,
                                 const Recording& recording,
                                 const Parameters& parameters)
    : trajectory_(files.trajectory, trajectoryFormat(files.format)) {
  if (!files.statistics.empty()) statistics_.emplace(files.statistics);
  if (!files.bag.empty()) bag_ = std::make_unique<OdometryBag>(files.bag, recording, parameters);
  if (!files.pictures.empty()) pictures_ = std::make_unique<FlowPictures>(files.pictures);
}

OdometryOutputs::~OdometryOutputs() = default;

void OdometryOutputs::restart() {
  accumulator_ = {};
  if (bag_) bag_->restart();
}

void OdometryOutputs::write(const PairRecord& record,
                            const StereoPair& pair,
                            const StereoCamera& camera,
                            const VisualOdometry& odometry) {
  trajectory_.write({pair.stamp_ns, accumulator_.add(record.result.T_prev_cur)});
  if (statistics_) statistics_->write(record);
  if (bag_) bag_->write(record.result);
  if (pictures_) pictures_->write(pair, camera, odometry, record.result);
}

}  // namespace rotrocc
