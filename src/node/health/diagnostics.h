#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include "inertial/gyro_predictor.h"
#include "node/health/odometry_health.h"

namespace rotrocc {

/// The entries of /diagnostics.
using StatusWrapper = diagnostic_updater::DiagnosticStatusWrapper;

void describeOdometry(const HealthReport& report, StatusWrapper& status);
void describeInput(const HealthReport& report, StatusWrapper& status);
void describeTiming(const HealthReport& report, StatusWrapper& status);
void describeTf(const HealthReport& report, StatusWrapper& status);
/// Warns if the number of drops exceeds `drops_before`.
void describeDrops(const HealthReport& report, std::uint64_t drops_before, StatusWrapper& status);
/// Warns if the gyroscope of `topic` was not used for the last pair.
void describeGyro(const GyroPredictor& gyro, const std::string& topic, StatusWrapper& status);

/// Publishes these entries, but for the gyroscope's, on request.
class Diagnostics {
 public:
  /// `name`: node or nodelet, with its namespace.
  Diagnostics(ros::NodeHandle& nh, ros::NodeHandle& private_nh, const std::string& name);

  /// Adds an entry, which `task` fills.
  void add(const std::string& name, const std::function<void(StatusWrapper&)>& task);

  /// Call once a second. Publishes each ~diagnostic_period, as diagnostic_updater does.
  void publish(const HealthReport& report);

 private:
  HealthReport report_;
  double period_s_ = 1.0;
  std::chrono::steady_clock::time_point published_;
  std::uint64_t drops_before_ = 0;
  diagnostic_updater::Updater updater_;
};

}  // namespace rotrocc
