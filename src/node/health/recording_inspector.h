#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "node/health/pair_inspector.h"

namespace rotrocc {

/// Inspects the pairs of a recording. It waits for each search, so that the same input has the same
/// output.
class RecordingInspector {
 public:
  explicit RecordingInspector(const OdometryConfig& config, bool rectifies)
      : config_(config), inspector_(config, rectifies) {}

  /// See PairInspector::inspect().
  std::string inspect(const StereoPair& pair,
                      const StereoCamera& camera,
                      const OdometryResult& result);

  /// The fault of single pairs among good ones, and a remedy: images of both cameras in the wrong
  /// order, or doubtful pairs that match with other images; empty if none is known.
  std::string faultOfSinglePairs() const;

  PairInspector& inspector() { return inspector_; }
  /// Copies of the last kPairsBefore pairs, the earliest one first.
  const std::vector<StereoPair>& before() const { return before_; }

 private:
  /// How many doubtful pairs are tried with other images; each takes as long as a few pairs.
  static constexpr int kSinglePairs = 10;

  void trySinglePair(const StereoPair& pair, const StereoCamera& camera);
  void countReordered(const OdometryResult& result);

  OdometryConfig config_;
  PairInspector inspector_;
  std::vector<StereoPair> before_;
  std::optional<StereoPair> last_ok_;
  int tried_ = 0;                         // doubtful pairs
  std::map<std::string, int> explained_;  // of these, by what they match
  std::vector<Eigen::Vector3d> steps_m_;  // translations of the last pairs
  int pairs_ = 0, reordered_ = 0;
};

}  // namespace rotrocc
