#pragma once
/// Random numbers that belong to a place in the picture and not to a thread: Owen-scrambled Sobol' points by hashing
/// (Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020; hash constants of Vegdahl's refinement).

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace chiaro::reference {

/// A well-mixed word from two (PCG output permutation over a linear congruential step).
inline std::uint32_t hashWords(std::uint32_t a, std::uint32_t b) {
  std::uint32_t state = (a ^ (b * 0x9e3779b9u + 0x7f4a7c15u)) * 747796405u + 2891336453u;
  state = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  state ^= state >> 22u;
  state = (state + b) * 0x2c1b3c6du;
  state ^= state >> 15u;
  return state * 0x297a2d39u ^ (state >> 13u);
}

inline std::uint32_t reverseBits(std::uint32_t x) {
  x = ((x >> 1u) & 0x55555555u) | ((x & 0x55555555u) << 1u);
  x = ((x >> 2u) & 0x33333333u) | ((x & 0x33333333u) << 2u);
  x = ((x >> 4u) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4u);
  x = ((x >> 8u) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8u);
  return (x >> 16u) | (x << 16u);
}

/// Flips each bit depending on the bits above it and the seed only: an Owen scramble.
inline std::uint32_t owenScramble(std::uint32_t x, std::uint32_t seed) {
  x = reverseBits(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverseBits(x);
}

/// One randomised point set of a few dimensions; sets of different seeds are independent.
class PointSet {
 public:
  static constexpr std::uint32_t kSequences = 3;

  explicit PointSet(std::uint32_t seed) {
    for (std::uint32_t i = 0; i < kSequences; ++i) {
      const std::uint32_t sequenceSeed = hashWords(seed, i);
      seeds_[i] = {hashWords(sequenceSeed, 0u), hashWords(sequenceSeed, 1u), hashWords(sequenceSeed, 2u)};
    }
  }

  /// Point `index` of the two-dimensional (0,2)-sequence number `sequence`, in (0,1)^2. Each sequence is shuffled by itself, so that
  /// they can be used side by side as further dimensions.
  glm::dvec2 pair(std::uint32_t index, std::uint32_t sequence) const {
    const std::uint32_t shuffled = shuffle(index, sequence);
    return {fraction(owenScramble(reverseBits(shuffled), seeds_[sequence].first)),
            fraction(owenScramble(secondSobol(shuffled), seeds_[sequence].second))};
  }
  /// Its first coordinate.
  double single(std::uint32_t index, std::uint32_t sequence) const {
    return fraction(owenScramble(reverseBits(shuffle(index, sequence)), seeds_[sequence].first));
  }

 private:
  static std::uint32_t secondSobol(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 1u << 31u; index != 0u; index >>= 1u, direction ^= direction >> 1u) {
      if ((index & 1u) != 0u) result ^= direction;
    }
    return result;
  }
  static double fraction(std::uint32_t bits) { return (static_cast<double>(bits) + 0.5) * 0x1p-32; }

  std::uint32_t shuffle(std::uint32_t index, std::uint32_t sequence) const {
    return owenScramble(index, seeds_[sequence].order);  // keeps every aligned block of 2^k indices together, so nets stay nets
  }

  struct Seeds {
    std::uint32_t order, first, second;
  };
  std::array<Seeds, kSequences> seeds_;
};

}  // namespace chiaro::reference
