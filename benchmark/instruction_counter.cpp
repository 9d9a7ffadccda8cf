// A plugin of qemu-user (7.2, Debian 12) that counts the executed instructions: a line "count size
// where code" for each basic block, with the function or the library that it is in. Declares what
// it uses of qemu-plugin.h, which Debian does not ship. See scripts/instruction_costs.

#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <string>

extern "C" {
struct qemu_plugin_tb;
struct qemu_plugin_insn;
using PluginId = std::uint64_t;
void qemu_plugin_register_vcpu_tb_trans_cb(PluginId id,
                                           void (*callback)(PluginId, qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_cb(qemu_plugin_tb* block,
                                          void (*callback)(unsigned, void*),
                                          int flags,
                                          void* data);
void qemu_plugin_register_atexit_cb(PluginId id, void (*callback)(PluginId, void*), void* data);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb* block);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb* block, std::size_t index);
const void* qemu_plugin_insn_data(const qemu_plugin_insn* instruction);
std::size_t qemu_plugin_insn_size(const qemu_plugin_insn* instruction);
void* qemu_plugin_insn_haddr(const qemu_plugin_insn* instruction);
const char* qemu_plugin_insn_symbol(const qemu_plugin_insn* instruction);
__attribute__((visibility("default"))) int qemu_plugin_version = 1;
}

namespace {

struct Block {
  std::uint64_t count;
  std::size_t size;  ///< number of instructions
  std::string where;
  std::string code;  ///< instructions in hexadecimal digits
};

/// Their addresses must not change: the emulator keeps them.
std::deque<Block> blocks;
const char* output = nullptr;

/// Name of the file that this address is mapped from.
std::string libraryAt(const void* address) {
  FILE* maps = std::fopen("/proc/self/maps", "r");
  if (maps == nullptr) return "unknown";
  char line[4096];
  std::string name = "unknown";
  while (std::fgets(line, sizeof(line), maps) != nullptr) {
    std::uintptr_t first = 0;
    std::uintptr_t end = 0;
    int path = 0;
    std::sscanf(line, "%" SCNxPTR "-%" SCNxPTR " %*s %*s %*s %*s %n", &first, &end, &path);
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    if (at < first || at >= end) continue;
    const char* slash = std::strrchr(line, '/');
    if (slash != nullptr) name.assign(slash + 1, std::strcspn(slash + 1, "\n"));
    break;
  }
  std::fclose(maps);
  return name;
}

std::string codeOf(const qemu_plugin_insn* instruction) {
  const auto* bytes = static_cast<const unsigned char*>(qemu_plugin_insn_data(instruction));
  std::string code;
  for (std::size_t i = 0; i < qemu_plugin_insn_size(instruction); ++i) {
    char digits[3];
    std::snprintf(digits, sizeof(digits), "%02x", static_cast<unsigned>(bytes[i]));
    code += digits;
  }
  return code;
}

void execute(unsigned, void* block) {
  ++static_cast<Block*>(block)->count;
}

void translate(PluginId, qemu_plugin_tb* translated) {
  const qemu_plugin_insn* first = qemu_plugin_tb_get_insn(translated, 0);
  const char* symbol = qemu_plugin_insn_symbol(first);
  Block block = {0, qemu_plugin_tb_n_insns(translated), "", ""};
  if (symbol != nullptr && *symbol != '\0') {
    block.where = symbol;
    for (std::size_t i = 0; i < block.size; ++i) {
      block.code += codeOf(qemu_plugin_tb_get_insn(translated, i));
    }
  } else {
    block.where = libraryAt(qemu_plugin_insn_haddr(first));
    block.code = "-";
  }
  blocks.push_back(block);
  qemu_plugin_register_vcpu_tb_exec_cb(translated, execute, 0, &blocks.back());
}

void print(PluginId, void*) {
  FILE* file = std::fopen(output, "w");
  if (file == nullptr) return;
  for (const Block& block : blocks) {
    std::fprintf(file,
                 "%" PRIu64 " %zu %s %s\n",
                 block.count,
                 block.size,
                 block.where.c_str(),
                 block.code.c_str());
  }
  std::fclose(file);
}

}  // namespace

/// The file to write is that of the environment variable INSTRUCTION_COUNTS.
extern "C" __attribute__((visibility("default"))) int qemu_plugin_install(PluginId id,
                                                                          const void*,
                                                                          int,
                                                                          char**) {
  output = std::getenv("INSTRUCTION_COUNTS");
  if (output == nullptr) return 1;
  qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
  qemu_plugin_register_atexit_cb(id, print, nullptr);
  return 0;
}
