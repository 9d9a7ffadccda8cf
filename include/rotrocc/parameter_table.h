#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace rotrocc {

/// The list of all parameters: names, units, ranges, defaults and descriptions. The YAML files, the
/// parameter server and `--set` all use it. Names are `section/leaf` or just `leaf`; a section is
/// one level of the YAML file.
class ParameterTable {
 public:
  struct Parameter {
    enum class Type { kInt, kDouble, kBool, kText };

    std::string name;
    Type type = Type::kText;
    std::string unit;      ///< "px", "m", ...; empty for plain numbers and text
    std::string range;     ///< as text: "[1, 100]", "one of a, b"
    std::string min, max;  ///< limits of the range, in the format of get(); empty for text
    bool is_list = false;
    std::vector<std::string> choices;  ///< allowed values of a text; empty: any text
    std::string description;           ///< one line
    std::function<void(const std::string&)>
        set;                           ///< throws std::invalid_argument; the message lacks the name
    std::function<std::string()> get;  ///< the value in YAML syntax
  };

  /// Limits of a number, which are allowed, and its unit.
  template <class Number>
  struct Range {
    Number min, max;
    const char* unit = "";
  };

  /// What is added from now on belongs to this section.
  void beginSection(const std::string& name) { prefix_ = name + "/"; }

  /// `value` holds the default and is changed by set(); it must outlive the table. The result,
  /// whose description the caller sets, is valid until the next call.
  template <class Number>
  [[nodiscard]] Parameter& add(const std::string& leaf, Number& value, const Range<Number>& range);
  [[nodiscard]] Parameter& add(const std::string& leaf, bool& value);
  /// Text: one of `choices`, or any text if there are none.
  [[nodiscard]] Parameter& add(const std::string& leaf,
                               std::string& value,
                               const std::vector<std::string>& choices = {});
  /// Six finite numbers: a list, or text with spaces.
  [[nodiscard]] Parameter& add(const std::string& leaf,
                               std::array<double, 6>& value,
                               const char* unit);

  /// Throws std::invalid_argument with the name, the value and the range if there is no such
  /// parameter or `text` is not a valid value for it.
  void set(const std::string& name, const std::string& text);

  /// The same for a list of values.
  void setList(const std::string& name, const std::vector<std::string>& elements);

  /// Takes "name=value", as on a command line. Throws as set().
  void setAssignment(const std::string& assignment);

  const std::vector<Parameter>& parameters() const { return parameters_; }

 private:
  Parameter& append(const std::string& leaf);
  Parameter& find(const std::string& name);

  std::string prefix_;  // of the names of the current section
  std::vector<Parameter> parameters_;
};

}  // namespace rotrocc
