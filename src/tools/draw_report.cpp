#include "tools/draw_report.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include <boost/algorithm/string/replace.hpp>

namespace rotrocc {
namespace {

/// For the shell.
std::string quoted(const std::string& text) {
  return "'" + boost::algorithm::replace_all_copy(text, "'", "'\\''") + "'";
}

}  // namespace

void drawReport(const std::string& directory, const std::string& title) {
  const std::string script =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("draw_report");
  const std::string option = title.empty() ? "" : " --title=" + quoted(title);
  const std::string command = quoted(script) + option + " -- " + quoted(directory);
  std::fflush(stdout);
  if (std::system(command.c_str()) != 0) throw std::runtime_error(script + " failed");
}

}  // namespace rotrocc
