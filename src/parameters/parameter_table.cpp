#include "rotrocc/parameter_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/join.hpp>

namespace rotrocc {
namespace {

template <class T>
std::string toText(const T& value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::digits10);
  text << std::boolalpha << value;
  return text.str();
}

[[noreturn]] void reject(const std::string& text, const std::string& wanted) {
  throw std::invalid_argument("is \"" + text + "\", but must be " + wanted);
}

/// Parses values up to the end of `text`; throws if anything is left over.
template <class... T>
void parse(const std::string& text, const std::string& wanted, T&... values) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  if (!((stream >> std::boolalpha) >> ... >> values) || !(stream >> std::ws).eof()) {
    reject(text, wanted);
  }
}

}  // namespace

ParameterTable::Parameter& ParameterTable::append(const std::string& leaf) {
  Parameter& parameter = parameters_.emplace_back();
  parameter.name = prefix_ + leaf;
  return parameter;
}

template <class Number>
ParameterTable::Parameter& ParameterTable::add(const std::string& leaf,
                                               Number& value,
                                               const Range<Number>& range) {
  constexpr bool kIsInteger = std::is_integral_v<Number>;
  Parameter& p = append(leaf);
  p.type = kIsInteger ? Parameter::Type::kInt : Parameter::Type::kDouble;
  p.unit = range.unit;
  p.min = toText(range.min);
  p.max = toText(range.max);
  p.range = "[" + p.min + ", " + p.max + "]";
  p.set = [&value, range, in_range = "in " + p.range](const std::string& text) {
    Number parsed{};
    parse(text, (kIsInteger ? "an integer " : "a number ") + in_range, parsed);
    if (!(parsed >= range.min && parsed <= range.max)) {
      throw std::invalid_argument("is " + text + ", but must be " + in_range);
    }
    value = parsed;
  };
  p.get = [&value] { return toText(value); };
  return p;
}

template ParameterTable::Parameter& ParameterTable::add(const std::string&,
                                                        int&,
                                                        const Range<int>&);
template ParameterTable::Parameter& ParameterTable::add(const std::string&,
                                                        double&,
                                                        const Range<double>&);

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf, bool& value) {
  Parameter& p = append(leaf);
  p.type = Parameter::Type::kBool;
  p.min = "false";
  p.max = "true";
  p.range = "true or false";
  p.set = [&value, range = p.range](const std::string& text) {
    bool parsed = false;
    parse(text, range, parsed);
    value = parsed;
  };
  p.get = [&value] { return toText(value); };
  return p;
}

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf,
                                               std::string& value,
                                               const std::vector<std::string>& choices) {
  Parameter& parameter = append(leaf);
  parameter.choices = choices;
  parameter.range = choices.empty() ? "any text" : "one of " + boost::join(choices, ", ");
  parameter.set = [&value, choices, range = parameter.range](const std::string& text) {
    if (!choices.empty() && std::find(choices.begin(), choices.end(), text) == choices.end()) {
      reject(text, range);
    }
    value = text;
  };
  parameter.get = [&value] { return value; };
  return parameter;
}

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf,
                                               std::array<double, 6>& value,
                                               const char* unit) {
  Parameter& parameter = append(leaf);
  parameter.unit = unit;
  parameter.range = "6 numbers";
  parameter.is_list = true;
  parameter.set = [&value](const std::string& text) {
    std::string spaced = text;  // "1 2 3 4 5 6" or "[1, 2, 3, 4, 5, 6]"
    std::replace_if(spaced.begin(), spaced.end(), boost::is_any_of("[],"), ' ');
    std::array<double, 6> parsed{};
    std::apply([&](auto&... numbers) { parse(spaced, "6 numbers", numbers...); }, parsed);
    value = parsed;
  };
  parameter.get = [&value] {
    std::string text;
    for (const double number : value) text += (text.empty() ? "" : " ") + toText(number);
    return text;
  };
  return parameter;
}

ParameterTable::Parameter& ParameterTable::find(const std::string& name) {
  const auto found = std::find_if(
      parameters_.begin(), parameters_.end(), [&](const Parameter& p) { return p.name == name; });
  if (found == parameters_.end()) {
    throw std::invalid_argument("unknown parameter \"" + name + "\"; see config/default.yaml");
  }
  return *found;
}

void ParameterTable::setList(const std::string& name, const std::vector<std::string>& elements) {
  const Parameter& parameter = find(name);
  if (!parameter.is_list) {
    throw std::invalid_argument("parameter " + name + " is a list, but must be " + parameter.range);
  }
  set(name, boost::join(elements, " "));
}

void ParameterTable::set(const std::string& name, const std::string& text) {
  Parameter& parameter = find(name);
  try {
    parameter.set(text);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("parameter " + name + " " + error.what());
  }
}

void ParameterTable::setAssignment(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw std::invalid_argument("\"" + assignment + "\" is not an assignment: write name=value");
  }
  set(assignment.substr(0, equals), assignment.substr(equals + 1));
}

}  // namespace rotrocc
