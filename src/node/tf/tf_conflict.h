#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "input/log.h"
#include "node/tf/tf_receiver.h"
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
/// each once when it appears. Thread-safe.
class TfConflict {
 public:
  TfConflict(PublishedTf own, const std::string& base_frame, Log log);
  ~TfConflict();

  /// An observer of a TfReceiver.
  void onTf(const TfReceiver::Event& event, bool is_static);

  /// The conflict with the first of the present rivals, as from describeConflict(); empty if there
  /// is none. Call it about once a second.
  std::string check();

 private:
  using Clock = std::chrono::steady_clock;

  void add(const PublishedTf& rival, bool is_static);

  PublishedTf own_;
  std::string base_frame_;
  Log log_;
  std::mutex mutex_;
  std::map<std::string, Clock::time_point> last_seen_;  // conflicts; the maximum if static
};

}  // namespace rotrocc
