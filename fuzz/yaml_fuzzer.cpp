// Files of parameters.

#include <functional>
#include <stdexcept>

#include "input_file.h"
#include "require.h"
#include "rotrocc/parameters.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Built once: building a table takes longer than reading a file.
struct Settings {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
};

/// What was read can be written, and be read from what was written.
void requireRoundTrip(const ParameterTable& table, const InputFile& file) {
  static Settings again;
  again.parameters = {};
  const std::string text = toYaml(table);
  file.write(text);
  loadYaml(file.path(), again.table);
  require(toYaml(again.table) == text, "no value is lost");
}

}  // namespace
}  // namespace rotrocc

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  static const TemporaryDirectory directory;
  static const InputFile file(directory / "parameters.yaml");
  static Settings settings;
  const std::string_view text = asText(data, size);
  file.write(text);
  settings.parameters = {};
  try {
    loadYaml(file.path(), settings.table);
  } catch (const std::invalid_argument&) {
    return 0;
  }
  // A file with all parameters takes a hundred times as long to read as those that come in here.
  const bool is_one_of_many = std::hash<std::string_view>()(text) % 32 == 0;
  if (is_one_of_many) requireRoundTrip(settings.table, file);
  return 0;
}
