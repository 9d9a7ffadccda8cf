#include "tools/draw_report.h"

#include <spawn.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace rotrocc {

void drawReport(const std::string& directory, const std::string& title) {
  std::string script =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("draw_report");
  std::string path = directory;
  std::string option = "--title=" + title;
  std::string end = "--";
  std::vector<char*> arguments = {script.data()};
  if (!title.empty()) arguments.push_back(option.data());
  arguments.insert(arguments.end(), {end.data(), path.data(), nullptr});
  std::fflush(stdout);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, script.c_str(), nullptr, nullptr, arguments.data(), environ);
  if (error != 0) throw std::runtime_error("cannot run " + script + ": " + std::strerror(error));
  int status = 0;
  waitpid(process, &status, 0);
  if (status != 0) throw std::runtime_error(script + " failed");
}

}  // namespace rotrocc
