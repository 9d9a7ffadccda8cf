#include "simulation/simulation_options.h"

#include <cmath>
#include <stdexcept>

#include "common/to_seconds.h"
#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

void requireShare(const std::string& name, double value) {
  if (value >= 0.0 && value <= 1.0) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ": choose it from 0 to 1");
}

std::vector<std::int64_t> allStamps(const Scenario& scenario, double rate_hz) {
  if (!scenario.stamps_ns.empty()) return scenario.stamps_ns;
  std::vector<std::int64_t> stamps_ns;
  for (int i = 0; i <= scenario.drive->duration_s() * rate_hz; ++i) {
    stamps_ns.push_back(std::llround(1e9 * i / rate_hz));
  }
  return stamps_ns;
}

}  // namespace

void SimulationOptions::check() const {
  camera.check();
  faults.check();
  requireShare("share of moving cars", moving_share);
  requireShare("share of the lorry", lorry.share);
  requireShare("share of repeated texture", tiled_share);
  requireShare("share of dropped frames", drop_share);
  if (!(rate_hz > 0.0 && rate_hz <= 1000.0)) {
    throw std::invalid_argument("rate is " + std::to_string(rate_hz) +
                                " Hz: choose it above 0, up to 1000");
  }
}

std::vector<std::int64_t> frameStamps(const Scenario& scenario, const SimulationOptions& options) {
  const std::vector<std::int64_t> all = allStamps(scenario, options.rate_hz);
  std::vector<std::int64_t> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (options.frames > 0 && static_cast<int>(kept.size()) == options.frames) break;
    if (options.duration_s > 0.0 && toSeconds(all[i]) > options.duration_s) break;
    const bool dropped = i > 0 && randomUniform(options.seed, 0xD209, i) < options.drop_share;
    if (!dropped) kept.push_back(all[i]);
  }
  return kept;
}

}  // namespace rotrocc
