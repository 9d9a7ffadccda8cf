#include "node/base/pair_processor.h"

#include <cmath>
#include <utility>

#include "common/to_seconds.h"
#include "input/message_conversion.h"
#include "input/to_text.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Below these a base is at rest: wheels that do not turn still have noise in a simulator.
constexpr double kRest_mps = 0.05;
constexpr double kRest_rps = 0.05;

/// Robots seldom start on a steeper one.
constexpr double kSlope_deg = 10.0;

/// With so many digits that the stamps differ.
std::string describeJump(std::int64_t from_ns, std::int64_t to_ns) {
  const int digits = from_ns - to_ns < 10'000'000 ? 9 : 3;
  return "time jumped back from " + fixedText(toSeconds(from_ns), digits) + " to " +
         fixedText(toSeconds(to_ns), digits) + " s";
}

}  // namespace

PairProcessor::PairProcessor(const Parameters& parameters, Log log)
    : log_(std::move(log)),
      parameters_(parameters.node),
      systematic_error_(parameters.odometry.systematic_error),
      converter_(parameters.node.significant_bits, parameters.node.mask),
      odometry_(parameters.odometry),
      inspector_(parameters.odometry, parameters.node.rectify) {}

void PairProcessor::Requests::add(const Requests& later) {
  reset |= later.reset;
  restart |= later.restart;
  if (later.reset || later.T_odom_base) T_odom_base = later.T_odom_base;
  if (later.config) config = later.config;
}

void PairProcessor::request(const Requests& requests) {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  requests_.add(requests);
}

bool PairProcessor::takeRequests() {
  const std::lock_guard<std::mutex> lock(requests_mutex_);
  const Requests requests = std::exchange(requests_, {});
  taken_.add(requests);
  return requests.reset;
}

PairAnswer PairProcessor::process(const PairInput& in) {
  const Requests requests = std::exchange(taken_, {});
  if (const auto& config = requests.config) {
    odometry_.configure(*config);
    inspector_.configure(*config);
    systematic_error_ = config->systematic_error;
    if (base_odometry_) base_odometry_->setSystematicError(systematic_error_);
  }
  PairAnswer answer;
  answer.starts_trajectory = restartIfNeeded(requests, in);
  if (!base_odometry_) begin(in);
  if (requests.T_odom_base) {
    base_odometry_->setPose(*requests.T_odom_base);
    // Compared with a pair from before a loss, this one would be lost again.
    if (base_odometry_->lost_since_ns()) odometry_.reset();
  }
  // By stamps that are set back, the other odometry reports an earlier part of the path.
  const bool is_set_back = last_ && in.pair.clock_set_ns < last_->clock_set_ns;
  const std::optional<Eigen::Isometry3d> T_last_base = is_set_back ? std::nullopt : in.T_last_base;
  estimated_ = odometry_.process(in.pair,
                                 in.camera,
                                 base_odometry_->expectedMotion(in.T_base_camera, T_last_base),
                                 in.measured_rotation,
                                 [&] { return in.is_simulated && !moves(in); });
  answer.result = inspector_.distrusted(estimated_);
  answer.state = base_odometry_->add(answer.result, in.T_base_camera, T_last_base);
  if (estimated_.hasMotion() && !answer.result.hasMotion()) base_odometry_->startFromLast();
  answer.mount_problem = base_odometry_->planarProblem();
  if (!answer.mount_problem.empty() && !std::exchange(logged_mount_, true)) {
    log_.warn(answer.mount_problem);
  }
  last_arrival_ = in.arrival;
  last_ = StereoPair{in.pair.stamp_ns, {}, {}, {}, {}, in.pair.clock_set_ns};
  return answer;
}

std::string PairProcessor::inspect(const PairInput& in) {
  const GrayRange range = converter_.grayRange();
  const auto before = [&] {
    StereoPairConverter converter(range, parameters_.mask);  // the pixels of `in` stay
    std::vector<StereoPair> pairs;
    for (const auto& received : in.before) pairs.push_back(copyOf(converter.convert(*received)));
    return pairs;
  };
  const std::string fault = inspector_.inspect(in.pair, in.camera, estimated_, range, before);
  if (!fault.empty() || !inspector_.isUnexplained()) return fault;
  return "single pairs do not show the cause: record a minute, and run `rosrun rotrocc check_rig` "
         "on it";
}

/// Whether initial_pose leaves roll and pitch to gravity.
bool PairProcessor::isLevelled() const {
  return !parameters_.planar && parameters_.initial_pose[3] == 0.0 &&
         parameters_.initial_pose[4] == 0.0;
}

/// At the initial pose.
void PairProcessor::begin(const PairInput& in) {
  std::optional<Eigen::Vector3d> up;
  if (in.up && isLevelled()) up = in.up();
  if (up) {
    up = in.T_base_camera.linear() * *up;
    constexpr double kDegree = M_PI / 180.0;
    const double roll_deg = std::atan2(up->y(), up->z()) / kDegree;
    const double pitch_deg = std::atan2(-up->x(), std::hypot(up->y(), up->z())) / kDegree;
    const std::string text = "by gravity, " + parameters_.base_frame + " has a roll of " +
                             fixedText(roll_deg, 1) + " deg and a pitch of " +
                             fixedText(pitch_deg, 1) + " deg at first";
    const bool is_of_camera =
        in.T_base_camera.linear().isIdentity();  // it may be held at any angle
    !is_of_camera&& std::hypot(roll_deg, pitch_deg) > kSlope_deg
        ? log_.warn(text + ": unless it is on a slope, the tf of the IMU or of the camera is wrong")
        : log_.info(text);
  }
  base_odometry_.emplace(parameters_, systematic_error_, up);
}

/// Returns whether a new trajectory starts.
bool PairProcessor::restartIfNeeded(const Requests& requests, const PairInput& in) {
  const StereoPair& pair = in.pair;
  bool starts_trajectory = requests.reset;
  if (requests.reset || requests.restart) {
    odometry_.reset();
    inspector_.reset();
  }
  if (requests.reset) base_odometry_.reset();
  if (last_ && pair.time_ns() < last_->time_ns()) {  // a looping bag, or a restarted simulation
    restart(describeJump(last_->stamp_ns, pair.stamp_ns),
            "pose_after_time_jump",
            parameters_.pose_after_time_jump);
    // The stamps do not say how long the base moved unseen.
    const std::chrono::duration<double> passed = in.arrival - last_arrival_;
    if (base_odometry_) base_odometry_->addTimeUnseen(passed.count());
    starts_trajectory = true;
  }
  const auto lost_since_ns = base_odometry_ ? base_odometry_->lost_since_ns() : std::nullopt;
  const double lost_s = lost_since_ns ? toSeconds(pair.time_ns() - *lost_since_ns) : 0.0;
  const double limit_s = parameters_.reset_after_lost_s;
  if (lost_since_ns && limit_s > 0.0 && lost_s >= limit_s) {
    const bool keep =
        restart("lost for " + hundredths(lost_s) + " s, reset_after_lost_s = " + toText(limit_s),
                "pose_after_lost",
                parameters_.pose_after_lost);
    starts_trajectory = starts_trajectory || !keep;
  }
  return starts_trajectory;
}

/// At the pose that `parameter`, of value `pose`, says. Returns whether it is kept.
bool PairProcessor::restart(const std::string& why,
                            const std::string& parameter,
                            const std::string& pose) {
  const bool keep = pose == "keep";
  log_.warn(why + ": restarting at " + (keep ? "the last pose" : "initial_pose") + " (" +
            parameter + ")");
  odometry_.reset();
  inspector_.reset();
  if (!keep) base_odometry_.reset();
  return keep;
}

/// Whether another sensor sees that the base has moved since the last pair.
bool PairProcessor::moves(const PairInput& in) const {
  const double passed_s = toSeconds(in.pair.time_ns() - last_->time_ns());
  const auto turns = [&](const Eigen::Matrix3d& R) {
    return logRotation(R).norm() > kRest_rps * passed_s;
  };
  if (const auto& T = in.T_last_base) {
    return T->translation().norm() > kRest_mps * passed_s || turns(T->linear());
  }
  const auto R =
      in.measured_rotation ? in.measured_rotation(last_->stamp_ns, in.pair.stamp_ns) : std::nullopt;
  return R && turns(*R);
}

}  // namespace rotrocc
