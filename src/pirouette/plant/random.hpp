// Random numbers that are the same with every compiler: the standard fixes its generators and seed
// sequences, but not its distributions.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "pirouette/base/math.hpp"

namespace pirouette {

/// What a stream is for. Streams of one seed are independent, so drawing from one never shifts
/// another.
enum class RandomPurpose : std::uint32_t {
  kTerrain = 1,
  kSensorBias = 2,
  kSensorNoise = 3,
  kTorqueConstants = 4,
  kContactErrors = 5,
  kPositionAid = 6,
  kImuSpikes = 7,
  kLostCommands = 8
};

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(purpose)};
    generator_.seed(sequence);
  }

  /// Uniform in [0, 1), from the 53 highest bits.
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

  /// Standard normal, by Box and Muller; one of the pair is dropped so that a draw has no memory.
  double gaussian() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * kPi * uniform());
  }

  /// Three normal draws of standard deviation `sigma`.
  Vec3 gaussian3(double sigma) {
    Vec3 v;
    for (double& x : v) x = sigma * gaussian();
    return v;
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace pirouette
