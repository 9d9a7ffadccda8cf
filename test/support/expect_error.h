#pragma once

#include <exception>
#include <string>

#include <gtest/gtest.h>

namespace rotrocc {

/// Expects that `action` throws an `Error` whose message contains `part`.
template <typename Error = std::exception, typename Action>
void expectError(Action action, const std::string& part) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << "'" << error.what() << "' does not say '" << part << "'";
    return;
  }
  ADD_FAILURE() << "no error that says '" << part << "'";
}

}  // namespace rotrocc
