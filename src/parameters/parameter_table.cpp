#include "rotrocc/parameter_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace rotrocc {
namespace {

template <class T>
std::string toText(const T& value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::digits10);
  text << value;
  return text.str();
}

/// Parses the whole of `text`; throws if anything is left over.
template <class T>
T parseNumber(const std::string& text, const std::string& wanted) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  T value{};
  if (!(stream >> value) || !(stream >> std::ws).eof()) {
    throw std::invalid_argument("is \"" + text + "\", but must be " + wanted);
  }
  return value;
}

template <class T>
ParameterTable::Parameter makeNumber(T& value,
                                     const ParameterTable::Range<T>& range,
                                     const char* kind) {
  ParameterTable::Parameter parameter;
  parameter.type = std::is_integral<T>::value ? ParameterTable::Parameter::Type::kInt
                                              : ParameterTable::Parameter::Type::kDouble;
  parameter.unit = range.unit;
  parameter.min = toText(range.min);
  parameter.max = toText(range.max);
  parameter.range = "[" + parameter.min + ", " + parameter.max + "]";
  const std::string in_range = "in " + parameter.range;
  const std::string wanted = std::string(kind) + " " + in_range;
  parameter.set =
      [&value, min = range.min, max = range.max, in_range, wanted](const std::string& text) {
        const T parsed = parseNumber<T>(text, wanted);
        if (!(parsed >= min && parsed <= max)) {
          throw std::invalid_argument("is " + text + ", but must be " + in_range);
        }
        value = parsed;
      };
  parameter.get = [&value] { return toText(value); };
  return parameter;
}

/// As "1 2 3 4 5 6" or "[1, 2, 3, 4, 5, 6]".
std::array<double, 6> parseSix(const std::string& text) {
  std::string spaced = text;
  std::replace_if(
      spaced.begin(), spaced.end(), [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
  std::istringstream words(spaced);
  std::array<double, 6> numbers{};
  std::size_t count = 0;
  for (std::string word; words >> word; ++count) {
    const double number = parseNumber<double>(word, "6 numbers");
    if (count < numbers.size()) numbers[count] = number;
  }
  if (count != numbers.size()) {
    throw std::invalid_argument("is \"" + text + "\", but must be 6 numbers");
  }
  return numbers;
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

ParameterTable::Parameter& ParameterTable::append(const std::string& leaf, Parameter parameter) {
  parameter.name = prefix_ + leaf;
  parameters_.push_back(std::move(parameter));
  return parameters_.back();
}

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf,
                                               int& value,
                                               const Range<int>& range) {
  return append(leaf, makeNumber(value, range, "an integer"));
}

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf,
                                               double& value,
                                               const Range<double>& range) {
  return append(leaf, makeNumber(value, range, "a number"));
}

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf, bool& value) {
  Parameter parameter;
  parameter.type = Parameter::Type::kBool;
  parameter.min = "false";
  parameter.max = "true";
  parameter.range = "true or false";
  parameter.set = [&value](const std::string& text) {
    if (text != "true" && text != "false") {
      throw std::invalid_argument("is \"" + text + "\", but must be true or false");
    }
    value = text == "true";
  };
  parameter.get = [&value] { return std::string(value ? "true" : "false"); };
  return append(leaf, std::move(parameter));
}

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf,
                                               std::string& value,
                                               const std::vector<std::string>& choices) {
  Parameter parameter;
  parameter.choices = choices;
  parameter.range = choices.empty() ? "any text" : "one of " + join(choices);
  parameter.set = [&value, choices, range = parameter.range](const std::string& text) {
    if (!choices.empty() && std::find(choices.begin(), choices.end(), text) == choices.end()) {
      throw std::invalid_argument("is \"" + text + "\", but must be " + range);
    }
    value = text;
  };
  parameter.get = [&value] { return value; };
  return append(leaf, std::move(parameter));
}

ParameterTable::Parameter& ParameterTable::add(const std::string& leaf,
                                               std::array<double, 6>& value,
                                               const char* unit) {
  Parameter parameter;
  parameter.unit = unit;
  parameter.range = "6 numbers";
  parameter.is_list = true;
  parameter.set = [&value](const std::string& text) { value = parseSix(text); };
  parameter.get = [&value] {
    std::string text;
    for (const double number : value) text += (text.empty() ? "" : " ") + toText(number);
    return text;
  };
  return append(leaf, std::move(parameter));
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
  std::string text;
  for (const std::string& element : elements) text += (text.empty() ? "" : " ") + element;
  set(name, text);
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
