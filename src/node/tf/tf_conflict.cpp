#include "node/tf/tf_conflict.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <ros/this_node.h>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr std::chrono::seconds kGone(5);

std::string edge(const PublishedTf& tf) {
  return tf.parent + " -> " + tf.child;
}

// The odometries of this process that publish tf.
std::mutex neighbors_mutex;
std::vector<PublishedTf> neighbors;

/// Those that publish a parent of a frame.
std::vector<PublishedTf> neighborsWithChild(const std::string& child) {
  const std::lock_guard<std::mutex> lock(neighbors_mutex);
  std::vector<PublishedTf> found;
  for (const PublishedTf& tf : neighbors) {
    if (tf.child == child) found.push_back(tf);
  }
  return found;
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
  if (own.parent == base_frame) return conflict + ": set publish_tf to false in one of them";
  if (own.child != base_frame) {
    return conflict + ": if that is a localization, set its odom frame to " + own.parent +
           " (odom_frame_id of amcl); otherwise set publish_tf to false in one of them";
  }
  return conflict + ": set publish_tf to false if that is a filter that uses this odometry, or " +
         (same ? "odom_frame to visual_" + own.parent + " and " : "") + "guess_frame to " +
         rival.parent + " if it is another odometry";
}

TfConflict::TfConflict(PublishedTf own, const std::string& base_frame, Log log)
    : own_(std::move(own)), base_frame_(base_frame), log_(std::move(log)) {
  const std::lock_guard<std::mutex> lock(neighbors_mutex);
  neighbors.push_back(own_);
}

TfConflict::~TfConflict() {
  const std::lock_guard<std::mutex> lock(neighbors_mutex);
  const auto is_own = [this](const PublishedTf& other) { return other.node == own_.node; };
  neighbors.erase(std::remove_if(neighbors.begin(), neighbors.end(), is_own), neighbors.end());
}

std::string TfConflict::check() {
  for (const PublishedTf& neighbor : neighborsWithChild(own_.child)) {
    if (neighbor.node != own_.node) add(neighbor, false);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = Clock::now();
  for (const auto& [conflict, last] : last_seen_) {
    if (now - last <= kGone) return conflict;
  }
  return "";
}

void TfConflict::onTf(const TfReceiver::Event& event, bool is_static) {
  for (const auto& transform : event.getConstMessage()->transforms) {
    if (withoutSlash(transform.child_frame_id) != own_.child) continue;
    const std::string parent = withoutSlash(transform.header.frame_id);
    std::string node = event.getPublisherName();
    if (node == ros::this_node::getName()) {
      const auto is_its = [&](const PublishedTf& neighbor) { return neighbor.parent == parent; };
      const auto published = neighborsWithChild(own_.child);
      if (std::any_of(published.begin(), published.end(), is_its)) continue;
      node = "another nodelet in " + node;
    }
    add({node, parent, own_.child}, is_static);
  }
}

/// Static transforms stay in the receivers, so their conflicts stay here.
void TfConflict::add(const PublishedTf& rival, bool is_static) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = Clock::now();
  const std::string conflict = describeConflict(own_, rival, base_frame_);
  const auto [found, is_new] = last_seen_.try_emplace(conflict, now);
  const bool was_gone = now - found->second > kGone;
  found->second = is_static ? Clock::time_point::max() : std::max(found->second, now);
  if (is_new || was_gone) log_.warn(conflict);
}

}  // namespace rotrocc
