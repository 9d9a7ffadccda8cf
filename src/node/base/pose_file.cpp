#include "node/base/pose_file.h"

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "evaluation/text_file.h"
#include "evaluation/trajectory_file.h"
#include "node/odometry_messages.h"

namespace rotrocc {
namespace {

/// That of a page, which the kernel writes as a whole.
constexpr std::size_t kSize = 4096;
constexpr const char* kComment =
    "# frame, stamp [ns], x y z [m], qx qy qz qw, covariance (6x6), twist [m/s, rad/s], end\n";
constexpr const char* kEnd = "end";
constexpr std::size_t kWords = 2 + 7 + 36 + 6 + 1;

std::array<double*, 7> numbersOf(geometry_msgs::Pose& pose) {
  geometry_msgs::Point& p = pose.position;
  geometry_msgs::Quaternion& q = pose.orientation;
  return {&p.x, &p.y, &p.z, &q.x, &q.y, &q.z, &q.w};
}

std::string textOf(const BaseState& state, const std::string& odom_frame) {
  nav_msgs::Odometry message = toOdometry(state, odom_frame, "");
  const geometry_msgs::Twist& twist = message.twist.twist;
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10) << kComment << odom_frame
       << ' ' << state.stamp_ns;
  for (const double* value : numbersOf(message.pose.pose)) text << ' ' << *value;
  for (const double value : message.pose.covariance) text << ' ' << value;
  for (const geometry_msgs::Vector3& part : {twist.linear, twist.angular}) {
    text << ' ' << part.x << ' ' << part.y << ' ' << part.z;
  }
  text << ' ' << kEnd << '\n';
  return text.str();
}

/// Throws std::exception with a sentence.
BaseState parse(const TextLine& line, const std::string& odom_frame) {
  if (line.words.size() != kWords || line.words.back() != kEnd) line.fail("is not a whole pose");
  std::size_t next = 1;
  BaseState state;
  state.stamp_ns = line.integer(next++);
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.frame_id = line.words.front();
  for (double* value : numbersOf(message.pose.pose)) *value = line.number(next++);
  for (double& value : message.pose.covariance) value = line.number(next++);
  for (int i = 0; i < 6; ++i) state.twist.twist[i] = line.number(next++);
  state.T_odom_base = toPose(message, odom_frame);
  return state;
}

/// Throws std::runtime_error if there is a file that is none of this class, not even a damaged one.
void requirePoseFile(const std::string& path) {
  requireFile(path);
  std::ifstream file(path, std::ios::binary);
  const int first = file.get();
  const std::string start = kComment;
  std::string text(start.size(), static_cast<char>(first));
  file.read(text.data() + 1, static_cast<std::streamsize>(text.size() - 1));
  if (!file.is_open() || first <= 0 || text == start) return;
  throw std::runtime_error(path + " is another file, not one of continue_from: name a new file");
}

}  // namespace

std::optional<BaseState> readPoseFile(const std::string& path,
                                      const std::string& odom_frame,
                                      const Log& log) {
  if (!std::filesystem::exists(path)) {
    log.warn("continue_from: there is no " + path + " yet: starting at initial_pose");
    return std::nullopt;
  }
  requirePoseFile(path);
  try {
    return parse(readTextLines(path).front(), odom_frame);
  } catch (const std::exception& error) {
    log.warn("continue_from: " + path + " is replaced, its pose is not used: " + error.what() +
             ": starting at initial_pose");
  }
  return std::nullopt;
}

PoseFile::PoseFile(const std::string& path, std::string odom_frame, Log log)
    : path_(std::filesystem::absolute(path).string()),
      odom_frame_(std::move(odom_frame)),
      log_(std::move(log)) {
  requireFile(path_);
  descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0 || ftruncate(descriptor_, kSize) != 0) {
    throw std::system_error(errno, std::generic_category(), "continue_from: cannot write " + path_);
  }
  thread_ = std::thread(&PoseFile::work, this);
}

PoseFile::~PoseFile() {
  mailbox_.close();
  thread_.join();
  if (last_) write(*last_);
  close(descriptor_);
}

void PoseFile::put(const BaseState& state) {
  last_ = state;
  mailbox_.put(state);
}

void PoseFile::work() {
  pthread_setname_np(pthread_self(), "odometry_pose");  // for `top -H` and debuggers
  while (!mailbox_.closed()) {
    if (const auto state = mailbox_.take(std::chrono::minutes(1))) write(*state);
  }
}

void PoseFile::write(const BaseState& state) {
  std::string text = textOf(state, odom_frame_);
  text.resize(kSize, '\n');
  if (pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(kSize)) return;
  if (warning_.pass()) {
    log_.error("continue_from: cannot write " + path_ + ": " +
               std::generic_category().message(errno));
  }
}

}  // namespace rotrocc
