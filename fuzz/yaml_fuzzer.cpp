// Parameter files.

#include <functional>
#include <stdexcept>

#include "input_file.h"
#include "require.h"
#include "rotrocc/parameters.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Built only once, because that takes longer than reading a file.
struct Settings {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
};

/// Parameters that were read can be written, and read again.
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
  // Reading a file with all parameters takes a hundred times as long as reading a typical input.
  const bool is_one_of_many = std::hash<std::string_view>()(text) % 32 == 0;
  if (is_one_of_many) requireRoundTrip(settings.table, file);
  return 0;
}
