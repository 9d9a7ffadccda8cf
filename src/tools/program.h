#pragma once

#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

namespace rotrocc {

/// An option whose default is the present value of its variable.
template <class Value>
auto withDefault(Value& value) {
  return boost::program_options::value(&value)->default_value(value);
}

/// Stores the command line in `variables` and in the variables of the options, and what is given
/// without the name of an option in `arguments`. Returns false after printing `usage` and the
/// options, if --help is given. Throws po::error on bad usage.
inline bool parseCommandLine(int argc,
                             char** argv,
                             const char* usage,
                             const boost::program_options::options_description& visible,
                             std::vector<std::string>& arguments,
                             boost::program_options::variables_map& variables) {
  namespace po = boost::program_options;
  const char* const kArguments = "arguments";
  po::options_description all;
  all.add(visible).add_options()(kArguments, po::value(&arguments));
  po::positional_options_description order;
  order.add(kArguments, -1);
  // Not by the beginning of their names: another option may get the same one.
  const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
  po::command_line_parser parser(argc, argv);
  po::store(parser.options(all).positional(order).style(style).run(), variables);
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
