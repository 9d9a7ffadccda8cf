// Writes the seeds: `fuzz_seeds DIRECTORY` creates a subdirectory for each fuzzer.

#include <filesystem>
#include <fstream>

#include "seeds.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  for (const char* fuzzer : {"files", "odometry"}) {
    const auto folder = std::filesystem::path(argv[1]) / fuzzer;
    std::filesystem::create_directories(folder);
    for (const auto& [name, seed] : rotrocc::seedsOf(fuzzer)) {
      if (!(std::ofstream(folder / name, std::ios::binary) << seed)) return 1;
    }
  }
  return 0;
}
