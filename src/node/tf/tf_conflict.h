#pragma once

#include <chrono>
#include <map>
#include <string>

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_msgs/TFMessage.h>

#include "input/log.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// A transform, and who publishes it.
struct PublishedTf {
  std::string node;  ///< node or nodelet
  std::string parent;
  std::string child;
};

/// The one that the odometry `node` publishes.
PublishedTf publishedTf(const std::string& node, const NodeParameters& parameters);

/// What a rival, which gives the child of `own` a parent as well, means for tf, and what to do: in
/// one sentence, with settings that the odometry accepts.
std::string describeConflict(const PublishedTf& own,
                             const PublishedTf& rival,
                             const std::string& base_frame);

/// Watches for rivals, in tf and in this process, where all have the same node name in tf. Warns of
/// each once when it appears.
class TfConflict {
 public:
  TfConflict(PublishedTf own, const std::string& base_frame, Log log);
  ~TfConflict();
  TfConflict(const TfConflict&) = delete;
  TfConflict& operator=(const TfConflict&) = delete;

  /// Looks at the tf since the last call: call it about once a second. Returns the conflict with
  /// the first rival, as from describeConflict(); empty if there is none.
  std::string check();

 private:
  using Event = ros::MessageEvent<tf2_msgs::TFMessage const>;
  using Clock = std::chrono::steady_clock;

  ros::Subscriber subscribe(const std::string& topic, bool is_static);
  void onTf(const Event& event, bool is_static);
  void add(const PublishedTf& rival, bool is_static);

  PublishedTf own_;
  std::string base_frame_;
  Log log_;
  std::map<std::string, Clock::time_point> last_seen_;  // conflicts; the maximum if static
  ros::CallbackQueue queue_;
  ros::Subscriber tf_subscriber_;
  ros::Subscriber static_tf_subscriber_;
};

}  // namespace rotrocc
