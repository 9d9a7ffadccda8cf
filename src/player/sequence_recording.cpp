#include "player/sequence_recording.h"

#include <stdexcept>

#include <boost/make_shared.hpp>

namespace rotrocc {
namespace {

SequenceOptions sequenceOptions(const PlayerOptions& options) {
  SequenceOptions sequence;
  sequence.max_stamp_difference_s = options.max_stamp_difference_s;
  sequence.being_written = options.image_timeout_s > 0.0;
  return sequence;
}

/// Throws std::invalid_argument if the odometry would rectify images that already are.
const std::string& pathOf(const PlayerOptions& options) {
  if (!options.rectify) return options.bag;
  throw std::invalid_argument("the images of " + options.bag +
                              " are rectified as they are read: start without rectify:=true");
}

sensor_msgs::CameraInfo::ConstPtr stamped(sensor_msgs::CameraInfo info, const ros::Time& stamp) {
  info.header.stamp = stamp;
  return boost::make_shared<sensor_msgs::CameraInfo>(info);
}

}  // namespace

SequenceRecording::SequenceRecording(const PlayerOptions& options)
    : sequence_(openStereoSequence(pathOf(options), sequenceOptions(options))),
      messages_(*sequence_, {std::nullopt, true}),
      last_(end()) {}

sensor_msgs::CameraInfo::ConstPtr SequenceRecording::firstLeftInfo() const {
  return stamped(messages_.leftInfo(), begin());
}

sensor_msgs::CameraInfo::ConstPtr SequenceRecording::firstRightInfo() const {
  return stamped(messages_.rightInfo(), begin());
}

void SequenceRecording::select(const ros::Time& from, const ros::Time& to) {
  next_pair_ = 0;
  while (next_pair_ < sequence_->size() && messages_.stamp(next_pair_) < from) ++next_pair_;
  last_ = to;
  of_pair_.clear();
}

bool SequenceRecording::atEnd() const {
  return next_pair_ == sequence_->size() || messages_.stamp(next_pair_) > last_;
}

bool SequenceRecording::hasNext() const {
  return !of_pair_.empty() || atEnd() || sequence_->hasPair(next_pair_);
}

bool SequenceRecording::next(RecordedMessage& message) {
  if (of_pair_.empty()) {
    if (atEnd()) return false;
    readPair();
  }
  message = of_pair_.front();
  of_pair_.pop_front();
  return true;
}

void SequenceRecording::readPair() {
  const SequenceMessages::Pair pair = messages_.read(next_pair_);
  RecordedMessage left_info, left_image, right_info, right_image;
  left_info.left_info = pair.left.info;
  left_image.left_image = pair.left.image;
  right_info.right_info = pair.right.info;
  right_image.right_image = pair.right.image;
  of_pair_ = {left_info, left_image, right_info, right_image};
  for (RecordedMessage& message : of_pair_) message.time = messages_.stamp(next_pair_);
  ++next_pair_;
}

}  // namespace rotrocc
