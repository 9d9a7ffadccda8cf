#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace rotrocc {

/// Runs the program check_rig on the topics of the node, in a process of its own: the images of a
/// minute, a gigabyte, are not kept, and nothing that happens there reaches the node.
class LiveCheck {
 public:
  LiveCheck() = default;
  /// Ends the process.
  ~LiveCheck();
  LiveCheck(const LiveCheck&) = delete;
  LiveCheck& operator=(const LiveCheck&) = delete;

  /// Starts it; it watches the images of the next minute. `arguments` of check_rig: remappings, as
  /// left:=/camera/left/image_rect, and options. Returns where the report will be. Throws
  /// std::runtime_error if one is running, or if the program cannot be started.
  std::string start(const std::vector<std::string>& arguments);

  /// What became of it, in one sentence, once it has ended; otherwise empty. To be called from time
  /// to time.
  std::string poll();

 private:
  std::string directory_;  // of the report
  pid_t process_ = 0;
};

}  // namespace rotrocc
