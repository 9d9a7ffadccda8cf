#include "node/tf/tf_conflict.h"

#include <pthread.h>

#include <algorithm>
#include <list>

#include <ros/this_node.h>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr std::chrono::milliseconds kPeriod(100);
constexpr std::uint32_t kTfQueueSize = 1000;  // of a period
constexpr std::chrono::seconds kGone(5);

using SteadyClock = std::chrono::steady_clock;

std::string edge(const PublishedTf& tf) {
  return tf.parent + " -> " + tf.child;
}

/// The odometries of this process that publish tf.
class Neighbours {
 public:
  static Neighbours& instance() {
    static Neighbours neighbours;
    return neighbours;
  }

  void add(const PublishedTf& tf) {
    const std::lock_guard<std::mutex> lock(mutex_);
    published_.push_back(tf);
  }

  void remove(const PublishedTf& tf) {
    const std::lock_guard<std::mutex> lock(mutex_);
    published_.remove_if([&](const PublishedTf& other) { return other.node == tf.node; });
  }

  /// All that publish a parent of a frame.
  std::vector<PublishedTf> ofChild(const std::string& child) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<PublishedTf> found;
    for (const PublishedTf& tf : published_) {
      if (tf.child == child) found.push_back(tf);
    }
    return found;
  }

 private:
  std::mutex mutex_;
  std::list<PublishedTf> published_;
};

/// Whether a transform with the name of this process is from an odometry in it.
bool isOfNeighbour(const PublishedTf& tf) {
  const auto neighbours = Neighbours::instance().ofChild(tf.child);
  return std::any_of(neighbours.begin(), neighbours.end(), [&](const PublishedTf& neighbour) {
    return neighbour.parent == tf.parent;
  });
}

}  // namespace

PublishedTf publishedTf(const std::string& node, const NodeParameters& parameters) {
  if (!parameters.guess_frame.empty()) {
    return {node, parameters.odom_frame, parameters.guess_frame};
  }
  if (parameters.invert_tf) return {node, parameters.base_frame, parameters.odom_frame};
  return {node, parameters.odom_frame, parameters.base_frame};
}

std::string describeConflict(const PublishedTf& own,
                             const PublishedTf& rival,
                             const std::string& base_frame) {
  const bool same = rival.parent == own.parent;
  const std::string conflict = same ? rival.node + " publishes tf " + edge(own) + " as well"
                                    : rival.node + " publishes tf " + edge(rival) + ", and " +
                                          own.node + " publishes " + edge(own) +
                                          ", but a frame has only one parent";
  if (own.child != base_frame) return conflict + ": set publish_tf to false in one of them";
  return conflict + ": set publish_tf to false if that is a filter that uses this odometry, or " +
         (same ? "odom_frame to visual_" + own.parent + " and " : "") + "guess_frame to " +
         rival.parent + " if it is another odometry";
}

bool TfRivals::add(const PublishedTf& rival, bool is_static, Time now) {
  const auto [found, is_new] = last_seen_.try_emplace({rival.node, rival.parent}, rival, now);
  Time& last = found->second.second;
  const bool was_gone = now - last > kGone;
  last = is_static ? Time::max() : std::max(last, now);
  return is_new || was_gone;
}

std::vector<PublishedTf> TfRivals::present(Time now) const {
  std::vector<PublishedTf> rivals;
  for (const auto& [key, seen] : last_seen_) {
    if (now - seen.second <= kGone) rivals.push_back(seen.first);
  }
  return rivals;
}

TfConflict::TfConflict(PublishedTf own, const std::string& base_frame, Log log)
    : own_(std::move(own)), base_frame_(base_frame), log_(std::move(log)) {
  ros::NodeHandle nh;  // like that of the broadcaster: tf is not remapped for a nodelet
  nh.setCallbackQueue(&queue_);
  tf_subscriber_ = nh.subscribe<tf2_msgs::TFMessage const, const Event&>(
      "/tf", kTfQueueSize, [this](const Event& event) { onTf(event, false); });
  static_tf_subscriber_ = nh.subscribe<tf2_msgs::TFMessage const, const Event&>(
      "/tf_static", kTfQueueSize, [this](const Event& event) { onTf(event, true); });
  Neighbours::instance().add(own_);
  thread_ = std::thread(&TfConflict::watch, this);
}

TfConflict::~TfConflict() {
  {
    const std::lock_guard<std::mutex> lock(end_mutex_);
    ended_ = true;
  }
  end_.notify_all();
  thread_.join();
  Neighbours::instance().remove(own_);
}

std::string TfConflict::description() {
  for (const PublishedTf& neighbour : Neighbours::instance().ofChild(own_.child)) {
    if (neighbour.node != own_.node) add(neighbour, false);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::vector<PublishedTf> rivals = rivals_.present(SteadyClock::now());
  return rivals.empty() ? "" : describeConflict(own_, rivals.front(), base_frame_);
}

void TfConflict::watch() {
  pthread_setname_np(pthread_self(), "odometry_tf");  // for `top -H` and debuggers
  std::unique_lock<std::mutex> lock(end_mutex_);
  while (!end_.wait_for(lock, kPeriod, [this] { return ended_; })) queue_.callAvailable();
}

void TfConflict::onTf(const Event& event, bool is_static) {
  for (const auto& transform : event.getConstMessage()->transforms) {
    if (withoutSlash(transform.child_frame_id) != own_.child) continue;
    PublishedTf tf = {
        event.getPublisherName(), withoutSlash(transform.header.frame_id), own_.child};
    if (tf.node == ros::this_node::getName()) {
      if (isOfNeighbour(tf)) continue;
      tf.node = "another nodelet in " + tf.node;
    }
    add(tf, is_static);
  }
}

void TfConflict::add(const PublishedTf& rival, bool is_static) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (rivals_.add(rival, is_static, SteadyClock::now())) {
    log_.warn(describeConflict(own_, rival, base_frame_));
  }
}

}  // namespace rotrocc
