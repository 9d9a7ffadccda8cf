#pragma once

#include <exception>
#include <iostream>

#include <boost/program_options.hpp>

namespace rotrocc {

/// The main() of a program. `parse` returns false after printing the help, and throws po::error on
/// bad usage: exit status 2. Exceptions of `run` give exit status 1. Messages go to stderr,
/// prefixed by the program name.
template <class Options>
int runProgram(const char* name,
               int argc,
               char** argv,
               bool (*parse)(int, char**, Options&),
               void (*run)(const Options&)) {
  Options options;
  try {
    if (!parse(argc, argv, options)) return 0;
  } catch (const boost::program_options::error& error) {
    std::cerr << name << ": " << error.what() << "; --help shows the usage\n";
    return 2;
  }
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace rotrocc
