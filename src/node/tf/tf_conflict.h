#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

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

/// The rivals of the last seconds.
class TfRivals {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Returns whether it is new, or was gone. Static transforms stay in the receivers, so the rival
  /// stays here.
  bool add(const PublishedTf& rival, bool is_static, Time now);

  /// Those that are not gone, in an order that does not change.
  std::vector<PublishedTf> present(Time now) const;

 private:
  using Key = std::pair<std::string, std::string>;  // node, parent
  std::map<Key, std::pair<PublishedTf, Time>> last_seen_;
};

/// Watches for rivals, in tf and in this process, where all have the same node name in tf. Warns of
/// each once when it appears.
class TfConflict {
 public:
  TfConflict(PublishedTf own, const std::string& base_frame, Log log);
  ~TfConflict();
  TfConflict(const TfConflict&) = delete;
  TfConflict& operator=(const TfConflict&) = delete;

  /// The conflict with the first rival, as from describeConflict(); empty if there is none.
  std::string description();

 private:
  using Event = ros::MessageEvent<tf2_msgs::TFMessage const>;
  void watch();
  void onTf(const Event& event, bool is_static);
  void add(const PublishedTf& rival, bool is_static);

  PublishedTf own_;
  std::string base_frame_;
  Log log_;
  std::mutex mutex_;
  TfRivals rivals_;

  // tf may have a thousand messages a second, which must not delay the images. They are taken from
  // the queue several times a second: to wake for each would cost more than to look at it.
  ros::CallbackQueue queue_;
  ros::Subscriber tf_subscriber_;
  ros::Subscriber static_tf_subscriber_;
  std::mutex end_mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace rotrocc
