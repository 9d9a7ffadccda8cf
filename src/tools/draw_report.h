#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <boost/algorithm/string/replace.hpp>

namespace rotrocc {

/// Runs draw_report, which draws the tables in a directory and writes the page. Without a title the
/// page has that of its tables. Throws std::runtime_error if it fails.
inline void drawReport(const std::string& directory, const std::string& title = "") {
  const auto quoted = [](const std::string& text) {  // for the shell
    return "'" + boost::algorithm::replace_all_copy(text, "'", "'\\''") + "'";
  };
  const std::string script =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("draw_report");
  const std::string option = title.empty() ? "" : " --title=" + quoted(title);
  const std::string command = quoted(script) + option + " -- " + quoted(directory);
  std::fflush(stdout);
  if (std::system(command.c_str()) != 0) throw std::runtime_error(script + " failed");
}

}  // namespace rotrocc
