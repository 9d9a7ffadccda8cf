#include "node/live_check.h"

#include <dlfcn.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include <ros/file_log.h>

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

constexpr int kToFix = 3;  // exit status of check_rig

/// Beside the library that this is in: lib/rotrocc/check_rig.
fs::path programPath() {
  Dl_info info = {};
  if (dladdr(reinterpret_cast<const void*>(&programPath), &info) == 0) return "check_rig";
  return fs::absolute(info.dli_fname).parent_path() / "rotrocc" / "check_rig";
}

/// Beside the logs of ROS, which a robot may write and clean up.
std::string newDirectory() {
  char name[64];
  const std::time_t now = std::time(nullptr);
  std::tm time = {};
  std::strftime(name, sizeof(name), "rotrocc_check_%Y-%m-%d_%H-%M-%S", localtime_r(&now, &time));
  return (fs::path(ros::file_log::getLogDirectory()) / name).string();
}

}  // namespace

LiveCheck::~LiveCheck() {
  if (process_ <= 0) return;
  kill(-process_, SIGKILL);  // and draw_report; its minute may not be over when the node ends
  waitpid(process_, nullptr, 0);
}

std::string LiveCheck::start(const std::vector<std::string>& arguments) {
  if (process_ > 0) throw std::runtime_error("a check is running: wait for " + directory_);
  directory_ = newDirectory();
  std::vector<std::string> words = {programPath().string(), "--live", "--report", directory_};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Not with Ctrl-C: the destructor ends it.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int error =
      posix_spawn(&process_, words[0].c_str(), nullptr, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    process_ = 0;
    throw std::runtime_error("cannot run " + words[0] + ": " + std::strerror(error));
  }
  return "the images of the next minute are checked; the report will be " + directory_ +
         "/index.html";
}

std::string LiveCheck::poll() {
  int status = 0;
  if (process_ <= 0 || waitpid(process_, &status, WNOHANG) != process_) return "";
  process_ = 0;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  const std::string page = directory_ + "/index.html";
  if (code == 0) return "the rig is good: " + page;
  if (code == kToFix) return "the rig has something to fix: " + page;
  return "check_rig failed: see its messages above";
}

}  // namespace rotrocc
