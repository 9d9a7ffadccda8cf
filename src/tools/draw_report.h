#pragma once

#include <string>

namespace rotrocc {

/// Runs draw_report, which draws the tables in a directory and writes the page. Without a title the
/// page has that of its tables. Throws std::runtime_error if it fails.
void drawReport(const std::string& directory, const std::string& title = "");

}  // namespace rotrocc
