#pragma once

#include <cstdint>

namespace rotrocc {

/// A random number of its arguments alone (a chain of SplitMix64's finalizer, Steele et al. 2014).
inline std::uint64_t randomBits(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0) {
  const auto mix = [](std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31);
  };
  return mix(mix(mix(a) ^ b) ^ c);
}

/// In [0, 1).
inline double randomUniform(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0) {
  return static_cast<double>(randomBits(a, b, c) >> 11) * 0x1.0p-53;
}

/// The sum of four parts of a random number, nearly Gaussian with a standard deviation of 1.
inline double gaussian(std::uint64_t bits) {
  int sum = 0;
  for (int i = 0; i < 4; ++i) sum += static_cast<int>((bits >> (16 * i)) & 0xFFFF);
  constexpr double kMean = 4.0 * 32767.5;
  constexpr double kSigma = 37837.2;  // 65536 * sqrt(4 / 12)
  return (sum - kMean) / kSigma;
}

/// A sequence of random numbers, for a fixed order of calls.
class RandomStream {
 public:
  /// Streams with different numbers are independent.
  RandomStream(std::uint64_t seed, std::uint64_t stream) : key_(randomBits(seed, stream)) {}

  /// In [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * randomUniform(key_, counter_++);
  }

  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

  /// One of 0 ... count - 1.
  int index(int count) { return static_cast<int>(uniform(0.0, count)); }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace rotrocc
