// Random numbers that are the same with every compiler: counter-based (philox) and in sequence
// (RandomStream).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Uniform in [0, 1), from the 53 highest of 64 random bits.
inline double unit_interval(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// [Salmon11] Philox-4x32-10: 128 random bits that depend on `counter` and `key` alone and are the
/// same on every machine. Checked against the authors' test vectors.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                           std::array<std::uint32_t, 2> key) {
  constexpr int kRounds = 10;
  constexpr std::uint64_t kMultiplier0 = 0xd2511f53, kMultiplier1 = 0xcd9e8d57;
  constexpr std::uint32_t kWeyl0 = 0x9e3779b9, kWeyl1 = 0xbb67ae85;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = kMultiplier0 * counter[0];
    const std::uint64_t product1 = kMultiplier1 * counter[2];
    const auto high0 = static_cast<std::uint32_t>(product0 >> 32);
    const auto high1 = static_cast<std::uint32_t>(product1 >> 32);
    counter = {high1 ^ counter[1] ^ key[0], static_cast<std::uint32_t>(product1),
               high0 ^ counter[3] ^ key[1], static_cast<std::uint32_t>(product0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

/// Purpose of a stream. Streams of one seed are independent: drawing from one does not shift
/// another.
enum class RandomPurpose : std::uint32_t {
  kTerrain = 1,          ///< rough ground, blocks
  kSensorBias = 2,       ///< of gyro and accelerometer
  kSensorNoise = 3,      ///< of all sensors
  kTorqueConstants = 4,  ///< of the motors
  kContactErrors = 5,    ///< wrong contact flags
  kPositionAid = 6,      ///< noise and drop-outs of the position aid
  kImuSpikes = 7,        ///< faults
  kLostCommands = 8,     ///< faults
  kFootForces = 9        ///< scales and noise of the feet's force sensors
};

/// Random numbers of one seed and purpose. It uses the generator and the seeding of the standard
/// library, which the standard defines, and none of its distributions, which differ between
/// compilers.
class RandomStream {
 public:
  /// At the beginning of the stream.
  RandomStream(std::uint64_t seed, RandomPurpose purpose) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(purpose)};
    generator_.seed(sequence);
  }

  /// Uniform in [0, 1).
  double uniform() { return unit_interval(generator_()); }

  /// Standard normal, by Box and Muller; the second of each pair is dropped, so that a draw keeps
  /// no state.
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
