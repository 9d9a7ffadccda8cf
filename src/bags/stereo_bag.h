#pragma once

#include <cstdint>
#include <string>

#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>

#include "bags/stereo_topics.h"
#include "input/camera_calibration.h"
#include "input/stereo_pair_converter.h"
#include "input/stereo_synchronizer.h"
#include "rectification/stereo_rectifier.h"
#include "rotrocc/parameters.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Reads the stereo pairs of a bag, in the order in which they are complete.
class StereoBag {
 public:
  enum class Rectify {
    kIfRaw,  ///< if they are raw, see hasRawImages()
    kAlways,
    kNever,
  };

  struct Options {
    std::string left_image;  ///< topics; empty: findStereoTopics()
    std::string right_image;
    double max_stamp_difference_s = 0.01;  ///< largest difference within a pair
    int queue_size = 4;                    ///< unmatched images kept per side
    std::int64_t max_image_pixels = StereoPairConverter::kMaxPixels;  ///< larger ones are refused
    double baseline_m = 0.0;                                          ///< 0: that of camera_info
    Rectify rectify = Rectify::kIfRaw;  ///< by K, D, R and P of camera_info
  };

  /// `bag` must outlive this. Throws std::runtime_error if its topics cannot be used.
  StereoBag(const rosbag::Bag& bag, const Options& options);
  StereoBag(const StereoBag&) = delete;
  StereoBag& operator=(const StereoBag&) = delete;

  const StereoTopics& topics() const { return topics_; }

  /// Number of left images: an upper bound of the number of pairs.
  int size() const { return size_; }

  /// Whether it rectifies the images.
  bool rectifies() const { return rectifies_; }

  /// Reads the next pair and its camera. The images are valid until the next call. Returns false
  /// and leaves the arguments unchanged at the end. Throws std::runtime_error, with its stamp, on a
  /// pair that cannot be converted.
  bool next(StereoPair& pair, StereoCamera& camera);

 private:
  bool read(const rosbag::MessageInstance& message);
  void convert(StereoPair& pair, StereoCamera& camera);

  StereoTopics topics_;
  int size_;
  rosbag::View view_;
  rosbag::View::iterator next_;
  StereoSynchronizer synchronizer_;
  StereoPairConverter converter_;
  double baseline_m_;
  sensor_msgs::CameraInfo::ConstPtr left_info_;
  sensor_msgs::CameraInfo::ConstPtr right_info_;
  StereoImages images_;
  bool rectifies_;
  CurrentCalibration calibration_;
  StereoRectifier rectifier_;
};

/// Whether a topic is not one of rectified images, and the first camera_info describes raw ones.
bool hasRawImages(const rosbag::Bag& bag, const StereoTopics& topics);

/// The value of an option: auto, yes or no. Throws std::invalid_argument on any other text.
StereoBag::Rectify rectifyOption(const std::string& text);

/// Those with which a bag gives the pairs that the node makes of its topics.
StereoBag::Options bagOptions(const NodeParameters& node);

}  // namespace rotrocc
