// Files of parameters.

#include <stdexcept>

#include "input_file.h"
#include "require.h"
#include "rotrocc/parameters.h"

namespace rotrocc {
namespace {

/// Built once: building a table takes longer than reading a file.
struct Settings {
  Parameters parameters;
  ParameterTable table = makeParameterTable(parameters);
};

}  // namespace
}  // namespace rotrocc

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  static const InputFile file("parameters.yaml");
  static Settings read;
  static Settings read_again;
  file.write(data, size);
  read.parameters = {};
  try {
    loadYaml(file.path(), read.table);
  } catch (const std::invalid_argument&) {
    return 0;
  }
  // What was read can be written, and be read from what was written.
  const std::string text = toYaml(read.table);
  file.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  read_again.parameters = {};
  loadYaml(file.path(), read_again.table);
  require(toYaml(read_again.table) == text, "no value is lost");
  return 0;
}
