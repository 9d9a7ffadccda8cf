#include "bags/live_recording.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <ros/init.h>
#include <ros/names.h>

#include "bags/stereo_topics.h"
#include "input/image_subscription.h"

namespace rotrocc {
namespace {

/// Images of a camera that wait to be read; more are left out.
constexpr std::size_t kMostWaiting = 30;
/// Time in which camera_info, and the first image, must come.
constexpr std::chrono::seconds kPatience(10);
/// Period at which a shutdown is noticed.
constexpr std::chrono::milliseconds kPoll(50);
constexpr double kHighestRate_hz = 30.0;

bool isRemapped(const std::string& name) {
  return ros::names::resolve(name) != ros::names::resolve(name, false);
}

template <class Subscriber>
[[noreturn]] void refuseSilence(const Subscriber& subscriber) {
  const std::string topic = "no message of " + subscriber.getTopic();
  if (!ros::ok()) throw std::runtime_error(topic + " before the end");
  const std::uint32_t publishers = subscriber.getNumPublishers();
  throw std::runtime_error(
      topic + " in " + std::to_string(kPatience.count()) + " s: " +
      (publishers > 0 ? "somebody publishes it, but sends nothing" : "nobody publishes it"));
}

}  // namespace

LiveRecording::LiveRecording(const LiveOptions& options) : options_(options) {
  subscribe(
      "left", options.left_image, left_, &RecordedMessage::left_image, &RecordedMessage::left_info);
  subscribe("right",
            options.right_image,
            right_,
            &RecordedMessage::right_image,
            &RecordedMessage::right_info);
  callbacks_.start();
}

LiveRecording::~LiveRecording() {
  callbacks_.stop();
}

void LiveRecording::subscribe(const std::string& side,
                              const std::string& image_name,
                              Camera& camera,
                              sensor_msgs::Image::ConstPtr RecordedMessage::*image_of,
                              sensor_msgs::CameraInfo::ConstPtr RecordedMessage::*info_of) {
  const std::string own_info = side + "/camera_info";
  const std::string info_name =
      isRemapped(own_info) ? own_info : infoTopicOf(nh_.resolveName(image_name));
  camera.info_subscriber = nh_.subscribe<sensor_msgs::CameraInfo>(
      info_name,
      kMostWaiting,
      [this, &camera, info_of](const sensor_msgs::CameraInfo::ConstPtr& info) {
        RecordedMessage message;
        message.*info_of = info;
        addInfo(camera, std::move(message), info);
      });
  camera.image_subscriber =
      subscribeImages(nh_,
                      image_name,
                      options_.image_transport,
                      ros::NodeHandle(nh_, side),
                      kMostWaiting,
                      [this, &camera, image_of](const sensor_msgs::Image::ConstPtr& image) {
                        RecordedMessage message;
                        message.*image_of = image;
                        addImage(camera, std::move(message));
                      });
}

void LiveRecording::addInfo(Camera& camera,
                            RecordedMessage message,
                            const sensor_msgs::CameraInfo::ConstPtr& info) {
  message.time = ros::Time::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!camera.first_info) camera.first_info = info;
  if (isComplete() && !begin_) begin_ = message.time;
  // They hardly ever change: that of an image that is left out is not missed.
  if (!isComplete() || isOver(Clock::now()) || camera.waiting_infos == kMostWaiting) return;
  ++camera.waiting_infos;
  messages_.push_back(std::move(message));
  arrival_.notify_all();
}

void LiveRecording::addImage(Camera& camera, RecordedMessage message) {
  message.time = ros::Time::now();
  const Clock::time_point now = Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!isComplete() || isOver(now)) return;
  if (!first_image_) first_image_ = now;
  if (camera.waiting_images == kMostWaiting) {
    ++camera.left_out;
    return;
  }
  ++camera.waiting_images;
  messages_.push_back(std::move(message));
  arrival_.notify_all();
}

/// Whether nothing more is recorded.
bool LiveRecording::isOver(Clock::time_point now) const {
  if (ended_ || !ros::ok()) return true;
  return first_image_ && now - *first_image_ >= std::chrono::duration<double>(options_.duration_s);
}

std::string LiveRecording::description() const {
  return left_.image_subscriber.getTopic() + " and " + right_.image_subscriber.getTopic();
}

int LiveRecording::size() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ended_) return left_images_read_;
  return static_cast<int>(std::ceil(options_.duration_s * kHighestRate_hz));
}

bool LiveRecording::isRaw() const {
  if (isRectifiedByName(left_.image_subscriber.getTopic())) return false;
  const RecordedMessage infos = firstInfos();
  return describesRawImages(*infos.left_info, *infos.right_info, options_.baseline_m);
}

ros::Time LiveRecording::begin() const {
  return firstInfos().time;
}

ros::Time LiveRecording::end() const {
  firstInfos();  // not before the begin
  return ros::Time::now();
}

RecordedMessage LiveRecording::firstInfos() const {
  const Clock::time_point limit = Clock::now() + kPatience;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!isComplete() && ros::ok() && Clock::now() < limit) arrival_.wait_for(lock, kPoll);
  if (!left_.first_info) refuseSilence(left_.info_subscriber);
  if (!right_.first_info) refuseSilence(right_.info_subscriber);
  RecordedMessage infos;
  infos.time = *begin_;
  infos.left_info = left_.first_info;
  infos.right_info = right_.first_info;
  return infos;
}

GyroRecording LiveRecording::gyroscope(const std::string& name) const {
  throw std::runtime_error("the gyroscope " + name +
                           " needs a bag: record it with the images, and give the bag");
}

void LiveRecording::select(const ros::Time&, const ros::Time&, bool) {}

bool LiveRecording::next(RecordedMessage& message) {
  const Clock::time_point limit = Clock::now() + kPatience;
  std::unique_lock<std::mutex> lock(mutex_);
  while (messages_.empty() && !isOver(Clock::now())) {
    if (!first_image_ && Clock::now() > limit) {
      ended_ = true;
      refuseSilence(left_.image_subscriber);
    }
    arrival_.wait_for(lock, kPoll);
  }
  if (messages_.empty()) {
    ended_ = true;
    return false;
  }
  removeFirst(message);
  return true;
}

void LiveRecording::removeFirst(RecordedMessage& message) {
  message = std::move(messages_.front());
  messages_.pop_front();
  if (message.left_image) {
    --left_.waiting_images;
    ++left_images_read_;
  }
  if (message.right_image) --right_.waiting_images;
  if (message.left_info) --left_.waiting_infos;
  if (message.right_info) --right_.waiting_infos;
}

std::string LiveRecording::leftOut() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (left_.left_out + right_.left_out == 0) return "";
  return std::to_string(left_.left_out) + " left and " + std::to_string(right_.left_out) +
         " right images, because the check is slower than the camera";
}

}  // namespace rotrocc
