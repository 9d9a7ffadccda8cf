#pragma once

#include <exception>
#include <iostream>

#include <boost/program_options.hpp>

namespace rotrocc {

/// Arguments that are given without a name.
struct PositionalArguments {
  boost::program_options::options_description options;  ///< where their values go
  boost::program_options::positional_options_description order;
};

/// Stores the command line in `variables`, and in the variables of the options. Returns false after
/// printing `usage` and the options, if --help is given. Throws po::error on bad usage.
inline bool parseCommandLine(int argc,
                             char** argv,
                             const char* usage,
                             const boost::program_options::options_description& visible,
                             const PositionalArguments& positional,
                             boost::program_options::variables_map& variables) {
  namespace po = boost::program_options;
  po::options_description all;
  all.add(visible).add(positional.options);
  // Not by the beginning of their names: another option may get the same one.
  const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
  po::command_line_parser parser(argc, argv);
  po::store(parser.options(all).positional(positional.order).style(style).run(), variables);
  if (variables.count("help") > 0) {
    std::cout << usage << visible;
    return false;
  }
  po::notify(variables);
  return true;
}

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
