// The short form of fuzzing, without libFuzzer: a fuzzer on its seeds and on mutations of them, the
// same in each run. An input that fails is kept, as scripts/fuzz does.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>

#include "seeds.h"
#include "support/temporary_directory.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) int LLVMFuzzerInitialize(int* argc, char*** argv);

namespace rotrocc {
namespace {

/// What readers may stumble over: parts of YAML and numbers, in text and as in messages.
std::vector<std::string> tokens() {
  std::istringstream text(
      ": [ ] [] 0,0 { } &a *a - \" # nan -inf 1e999 -1 0 1e-320 18446744073709551616");
  std::vector<std::string> tokens(std::istream_iterator<std::string>(text), {});
  for (const int byte : {0x00, 0xff}) tokens.emplace_back(4, static_cast<char>(byte));
  const std::string exponents[] = {"\xff\xff\xff\x7f", "\xf0\x7f", "\xf8\xff"};
  for (const std::string& end : exponents)
    tokens.push_back(std::string(8 - end.size(), '\0') + end);
  tokens.insert(tokens.end(), {"", "\n", std::string("\1\0\0\0", 4)});
  return tokens;
}

class Mutator {
 public:
  explicit Mutator(std::vector<std::string> seeds) : seeds_(std::move(seeds)) {}

  /// A seed with one to four changes. Its first byte stays, which names the reader of a file.
  std::string next() {
    std::string input = pick(seeds_);
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(input);
    return input;
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }
  const std::string& pick(const std::vector<std::string>& from) { return from[below(from.size())]; }

  /// A place in an input, more often at its beginning: there, messages have what describes the
  /// data.
  std::size_t place(const std::string& input) {
    return std::min(input.size(), 1 + below(std::size_t{2} << below(14)) % input.size());
  }

  void change(std::string& input) {
    const std::size_t at = place(input);
    const std::size_t length = 1 + below(std::size_t{1} << below(8));
    switch (below(5)) {
      case 0:
        input.erase(at, length);
        break;
      case 1:
        input.insert(at, pick(tokens_));
        break;
      case 2:
        if (at < input.size()) input[at] ^= static_cast<char>(1 << below(8));
        break;
      case 3: {  // what follows stays where it is, as messages need it
        const std::string& token = pick(tokens_);
        input.replace(at, token.size(), token);
        break;
      }
      default: {
        const std::string& other = pick(seeds_);
        input.replace(at, length, other, place(other), length);
      }
    }
  }

  std::vector<std::string> seeds_, tokens_ = tokens();
  std::mt19937 random_;
};

/// Ends the program after so much time of the CPU, whatever else the machine does; 0: never.
void limitTime(int seconds) {
  const itimerval limit = {{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

TEST(Mutations, AreReadOrRejected) {
  if (LLVMFuzzerInitialize != nullptr) LLVMFuzzerInitialize(nullptr, nullptr);
  std::vector<std::string> inputs;
  for (const auto& [name, seed] : seedsOf(FUZZER)) inputs.push_back(seed);
  Mutator mutator(inputs);
  while (inputs.size() < RUNS) inputs.push_back(mutator.next());

  // In memory, if possible: some file systems wait for the disk when a file is replaced.
  if (std::filesystem::exists("/dev/shm")) setenv("TMPDIR", "/dev/shm", 0);
  const TemporaryDirectory directory;
  const std::string current = directory / "input";
  std::cout << "If this program ends early, its input is " << current << std::endl;
  int read = 0;
  for (const std::string& input : inputs) {
    directory.write("input", input);
    limitTime(20);  // an input takes milliseconds
    const auto* data = reinterpret_cast<const std::uint8_t*>(input.data());
    [&]() noexcept { read += LLVMFuzzerTestOneInput(data, input.size()) == 0; }();
  }
  limitTime(0);
  EXPECT_GT(read, RUNS / 5) << "too many inputs were rejected before they were read";
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 2'000'000) << "[kB]";
}

}  // namespace
}  // namespace rotrocc
