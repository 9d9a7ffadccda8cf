#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace rotrocc {

/// The one list of all parameters: names, units, ranges, defaults and what they mean. The YAML
/// files, the parameter server and `--set` all go through it. Names are `section/leaf` (or a plain
/// `leaf`), where a section is a level of the YAML file.
class ParameterTable {
 public:
  struct Parameter {
    enum class Type { kInt, kDouble, kBool, kText };

    std::string name;
    Type type = Type::kText;
    std::string unit;                  ///< "px", "m", ...; empty for plain numbers and words
    std::string range;                 ///< in words: "[1, 100]", "one of a, b"
    std::string min, max;              ///< of the range, as get() has them; words have none
    std::vector<std::string> choices;  ///< of a word; empty: any text
    std::string description;           ///< one line
    std::function<void(const std::string&)>
        set;                           ///< throws std::invalid_argument, without the name
    std::function<std::string()> get;  ///< the value as YAML has it
  };

  /// `value` holds the default, must outlive the table and is what set() changes. Ranges include
  /// their ends.
  void add(const std::string& name,
           int& value,
           int min,
           int max,
           const std::string& unit,
           const std::string& description);
  void add(const std::string& name,
           double& value,
           double min,
           double max,
           const std::string& unit,
           const std::string& description);
  void add(const std::string& name, bool& value, const std::string& description);
  /// A word out of `choices`; any text if there are none.
  void add(const std::string& name,
           std::string& value,
           const std::vector<std::string>& choices,
           const std::string& description);

  /// Throws std::invalid_argument with the name, the value and the range if there is no such
  /// parameter, or `text` is no such value.
  void set(const std::string& name, const std::string& text);

  /// "name=value", as on a command line.
  void setAssignment(const std::string& assignment);

  const std::vector<Parameter>& parameters() const { return parameters_; }

 private:
  std::vector<Parameter> parameters_;
};

}  // namespace rotrocc
