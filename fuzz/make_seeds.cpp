// Writes the seeds: `fuzz_seeds DIRECTORY` creates a subdirectory for each fuzzer.

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "seeds.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds DIRECTORY\n";
    return 2;
  }
  try {
    for (const char* fuzzer : {"files", "odometry"}) {
      const auto folder = std::filesystem::path(argv[1]) / fuzzer;
      std::filesystem::create_directories(folder);
      for (const auto& [name, seed] : rotrocc::seedsOf(fuzzer)) {
        if (!(std::ofstream(folder / name, std::ios::binary) << seed)) {
          throw std::runtime_error("cannot write " + (folder / name).string());
        }
      }
    }
  } catch (const std::exception& error) {
    std::cerr << "fuzz_seeds: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
