// The signed distance transform against brute force and against shapes whose distance is a formula.
#include "precompute/ssdf/ssdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <tuple>
#include <utility>

#include "precompute/simd.h"

namespace chiaro {
namespace {

struct Signal {
  Signal(const OctahedralGrid& grid, glm::vec3 normalDirection, bool isDoubleSided)
      : normal(glm::normalize(normalDirection)), doubleSided(isDoubleSided), cosine(grid.texelCount), visible(grid.tileCount, 0), ssdf(grid.texelCount) {
    texelsAbove(grid, normal, cosine, above);
  }
  glm::vec3 normal;
  bool doubleSided;
  AlignedFloats cosine;
  TexelBits above, visible;
  std::vector<float> ssdf;  // row-major
};

glm::vec3 fold(glm::vec3 w, glm::vec3 n) {
  const float cosine = glm::dot(w, n);
  return cosine < 0.0f ? w - 2.0f * cosine * n : w;
}

/// Bits from a predicate, below the horizon mirrored if one-sided; then the transform.
Signal signalOf(const OctahedralGrid& grid, glm::vec3 normal, bool doubleSided, const std::function<bool(glm::vec3)>& sees) {
  Signal signal(grid, normal, doubleSided);
  for (std::size_t t = 0; t < grid.texelCount; ++t)
    if (sees(grid.direction(t)))
      signal.visible[t / 16] = static_cast<std::uint16_t>(signal.visible[t / 16] | 1u << t % 16);
  if (!doubleSided) mirrorBelowHorizon(grid, signal.normal, signal.above, signal.visible);
  SsdfTransform transform(grid, grid);
  transform(signal.normal, doubleSided, signal.above, signal.visible, signal.above, signal.visible, signal.ssdf.data());
  return signal;
}

double bruteForce(const Signal& signal, const std::vector<glm::vec3>& points, glm::vec3 w) {
  const glm::dvec3 q(signal.doubleSided ? w : fold(w, signal.normal));
  double chord = 2.0;
  for (const auto& p : points) chord = std::min(chord, glm::distance(q, glm::dvec3(p)));
  return std::min(2.0 * std::asin(chord / 2.0), static_cast<double>(kMaxDistance));
}

void expectEqualsBruteForce(const OctahedralGrid& grid, const Signal& signal) {
  std::vector<glm::vec3> points;
  boundaryPoints(grid, signal.above, signal.visible, signal.doubleSided, points);
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    const double expected = bruteForce(signal, points, grid.direction(t)) * (texelBit(signal.visible.data(), t) ? 1.0 : -1.0);
    // Directions and points are floats (6e-8), and a square of texels is one plane for each point: up to 2e-6 where these cancel.
    ASSERT_LE(std::abs(static_cast<double>(signal.ssdf[grid.rowMajor[t]]) - expected), 3e-6) << "texel " << t << " of " << points.size() << " points";
  }
}

TEST(Ssdf, EqualsBruteForceForAnyPattern) {
  std::mt19937 random(5);
  std::normal_distribution<float> gaussian;
  const auto direction = [&] { return glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random))); };
  for (const int resolution : {16, 20, 32, 64}) {
    const OctahedralGrid grid(resolution);
    for (const bool doubleSided : {false, true}) {
      for (const int caps : {1, 3, 20, 200}) {
        std::vector<glm::vec4> all;
        for (int i = 0; i < caps; ++i) all.emplace_back(direction(), std::cos(0.6f / std::sqrt(static_cast<float>(caps))));
        const auto sees = [&](glm::vec3 w) {
          return std::none_of(all.begin(), all.end(), [&](const glm::vec4& cap) { return glm::dot(w, glm::vec3(cap)) > cap.w; });
        };
        expectEqualsBruteForce(grid, signalOf(grid, direction(), doubleSided, sees));
      }
      expectEqualsBruteForce(grid, signalOf(grid, direction(), doubleSided, [&](glm::vec3) { return random() % 2 == 0; }));
    }
  }
  // One lone hidden texel, anywhere: the cull starts from as little as four points.
  const OctahedralGrid grid(32);
  for (std::size_t hidden = 0; hidden < grid.texelCount; hidden += 37)
    expectEqualsBruteForce(grid, signalOf(grid, {0, 1, 0}, true, [&](glm::vec3 w) { return grid.texelAt(w) != hidden; }));
}

TEST(Ssdf, IsTheSameInVectorsOfAnyWidth) {
  const int widest = widestVector();
  std::mt19937 random(11);
  std::normal_distribution<float> gaussian;
  std::vector<glm::vec4> caps;
  for (int i = 0; i < 40; ++i) caps.emplace_back(glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random))), 0.99f - 0.1f * static_cast<float>(i % 3));
  const auto sees = [&](glm::vec3 w) {
    return std::none_of(caps.begin(), caps.end(), [&](const glm::vec4& cap) { return glm::dot(w, glm::vec3(cap)) > cap.w; });
  };
  for (const int resolution : {20, 64, 128}) {
    const OctahedralGrid grid(resolution);
    for (const bool doubleSided : {false, true}) {
      std::vector<std::vector<float>> maps;
      for (int width = 4; width <= widest; width *= 2) {
        widestVector() = width;
        maps.push_back(signalOf(grid, {0.2f, -0.5f, 0.7f}, doubleSided, sees).ssdf);
      }
      widestVector() = widest;
      for (const auto& map : maps) EXPECT_EQ(map, maps.front()) << resolution;
    }
  }
}

TEST(Ssdf, AtAnyResolutionAndClamp) {
  std::mt19937 random(6);
  std::normal_distribution<float> gaussian;
  const auto direction = [&] { return glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random))); };
  for (const auto& [sampling, storage] : {std::pair{64, 64}, {128, 32}, {128, 48}, {64, 20}, {32, 128}, {256, 256}}) {
    const OctahedralGrid samplingGrid(sampling), storageGrid(storage);
    for (const bool doubleSided : {false, true}) {
      for (const float clamp : {kMaxDistance, 0.5f, 0.05f}) {
        const auto normal = direction();
        std::vector<glm::vec4> caps;
        for (int i = 0; i < 6; ++i) caps.emplace_back(direction(), 0.95f);
        const auto sees = [&](glm::vec3 w) {
          return std::none_of(caps.begin(), caps.end(), [&](const glm::vec4& cap) { return glm::dot(w, glm::vec3(cap)) > cap.w; });
        };
        const auto sampled = signalOf(samplingGrid, normal, doubleSided, sees);
        auto stored = Signal(storageGrid, normal, doubleSided);
        for (std::size_t t = 0; t < storageGrid.texelCount; ++t)
          if (texelBit(sampled.visible.data(), samplingGrid.texelAt(storageGrid.direction(t))))
            stored.visible[t / 16] = static_cast<std::uint16_t>(stored.visible[t / 16] | 1u << t % 16);
        if (!doubleSided) mirrorBelowHorizon(storageGrid, normal, stored.above, stored.visible);
        SsdfTransform transform(samplingGrid, storageGrid, clamp);
        transform(normal, doubleSided, sampled.above, sampled.visible, stored.above, stored.visible, stored.ssdf.data());
        std::vector<glm::vec3> points;
        boundaryPoints(samplingGrid, sampled.above, sampled.visible, doubleSided, points);
        ASSERT_FALSE(points.empty());
        for (std::size_t t = 0; t < storageGrid.texelCount; ++t) {
          const double distance = std::min(bruteForce(stored, points, storageGrid.direction(t)), static_cast<double>(clamp));
          const double expected = texelBit(stored.visible.data(), t) ? distance : -distance;
          ASSERT_LE(std::abs(static_cast<double>(stored.ssdf[storageGrid.rowMajor[t]]) - expected), 3e-6)
              << sampling << " to " << storage << " clamp " << clamp << " two sides " << doubleSided << " texel " << t;
        }
      }
    }
  }
}

TEST(Ssdf, BoundaryPointsAreAllPairsThatDiffer) {
  std::mt19937 random(8);
  for (const int resolution : {16, 20, 32}) {
    const OctahedralGrid grid(resolution);
    for (const bool doubleSided : {false, true}) {
      const Signal signal = signalOf(grid, {0.3f, 0.9f, 0.2f}, doubleSided, [&](glm::vec3) { return random() % 2 == 0; });
      std::vector<glm::vec3> points, expected;
      boundaryPoints(grid, signal.above, signal.visible, doubleSided, points);
      for (const auto& [a, b] : grid.neighbours) {
        if (texelBit(signal.visible.data(), a) == texelBit(signal.visible.data(), b)) continue;
        if (!doubleSided && !(texelBit(signal.above.data(), a) && texelBit(signal.above.data(), b))) continue;
        expected.push_back(glm::normalize(grid.direction(a) + grid.direction(b)));
      }
      const auto less = [](glm::vec3 a, glm::vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
      std::sort(points.begin(), points.end(), less);
      std::sort(expected.begin(), expected.end(), less);
      EXPECT_TRUE(points == expected) << resolution;
    }
  }
}

TEST(Ssdf, WithoutAnEdgeItIsHalfPi) {
  const OctahedralGrid grid(16);
  for (const bool sees : {false, true})
    for (const float s : signalOf(grid, {1, 2, 3}, false, [&](glm::vec3) { return sees; }).ssdf) EXPECT_EQ(s, sees ? kMaxDistance : -kMaxDistance);
  // What is hidden lies wholly below the horizon of a one-sided vertex: not an edge.
  const glm::vec3 n = glm::normalize(glm::vec3(1, 2, 3));
  Signal signal(grid, n, false);
  signal.visible = signal.above;
  SsdfTransform transform(grid, grid);
  transform(n, false, signal.above, signal.visible, signal.above, signal.visible, signal.ssdf.data());
  for (const float s : signal.ssdf) EXPECT_EQ(std::abs(s), kMaxDistance);
}

TEST(Ssdf, OfACapIsTheAngleToItsRim) {
  // Points in the middle of texel edges are a staircase about the rim. The nearest of them is .2 texels off where the rim is near; far
  // from a wide rim whichever step is nearest wins, up to half a texel. A texel is sqrt(4 pi) / resolution.
  for (const int resolution : {32, 64, 128}) {
    const OctahedralGrid grid(resolution);
    for (const float radius : {0.2f, 0.7f, 1.3f}) {
      const auto axis = glm::normalize(glm::vec3(0.3f, -0.8f, -0.4f));
      const auto signal = signalOf(grid, {0, 0, 1}, true, [&](glm::vec3 w) { return glm::dot(w, axis) < std::cos(radius); });
      double squared = 0.0, worst = 0.0;
      for (std::size_t t = 0; t < grid.texelCount; ++t) {
        const float angle = 2.0f * std::asin(std::min(0.5f * glm::distance(grid.direction(t), axis), 1.0f));
        const float exact = std::clamp(angle - radius, -kMaxDistance, kMaxDistance);
        const double error = static_cast<double>(signal.ssdf[grid.rowMajor[t]] - exact);
        squared += static_cast<double>(grid.solidAngle[t]) * error * error;
        worst = std::max(worst, std::abs(error));
      }
      const double texel = std::sqrt(4.0 * std::numbers::pi) / resolution, rms = std::sqrt(squared / (4.0 * std::numbers::pi));
      EXPECT_LE(rms, 0.4 * texel) << resolution << " " << radius;
      EXPECT_LE(worst, 1.5 * texel) << resolution << " " << radius;
    }
  }
}

TEST(Ssdf, OfAWallIsTheAngleToItsPlane) {
  // A vertex at the foot of an endless wall: hidden where x < 0. The edge is the great circle x = 0; its own horizon is none.
  const OctahedralGrid grid(64);
  const auto signal = signalOf(grid, {0, 1, 0}, false, [](glm::vec3 w) { return w.x > 0.0f; });
  const double texel = std::sqrt(4.0 * std::numbers::pi) / 64.0;
  for (std::size_t t = 0; t < grid.texelCount; ++t)
    EXPECT_LE(std::abs(static_cast<double>(signal.ssdf[grid.rowMajor[t]] - std::asin(grid.direction(t).x))), texel);
}

TEST(Ssdf, ChangesNoFasterThanTheDirection) {
  std::mt19937 random(9);
  std::normal_distribution<float> gaussian;
  const OctahedralGrid grid(64);
  for (const bool doubleSided : {false, true}) {
    std::vector<glm::vec3> axes;
    for (int i = 0; i < 12; ++i) axes.push_back(glm::normalize(glm::vec3(gaussian(random), gaussian(random), gaussian(random))));
    const auto signal = signalOf(grid, axes[0], doubleSided, [&](glm::vec3 w) {
      return std::none_of(axes.begin(), axes.end(), [&](glm::vec3 axis) { return glm::dot(axis, w) > 0.95f; });
    });
    for (const auto& [a, b] : grid.neighbours) {
      const float angle = 2.0f * std::asin(0.5f * glm::distance(grid.direction(a), grid.direction(b)));
      // A mirror image falls between texels and has the sign of the nearest: half of the longest texel (4.9 / 64) away, a whole one next to
      // the horizon.
      const bool mirrored = !doubleSided && !(texelBit(signal.above.data(), a) && texelBit(signal.above.data(), b));
      EXPECT_LE(std::abs(signal.ssdf[grid.rowMajor[a]] - signal.ssdf[grid.rowMajor[b]]), angle + (mirrored ? 1.5f * 4.9f / 64.0f : 1e-6f));
    }
  }
}

TEST(Ssdf, BelowTheHorizonMirrorsWhatIsAbove) {
  const OctahedralGrid grid(64);
  const glm::vec3 n(0, 0, 1);  // the map's own symmetry: texels mirror onto texels
  const auto signal = signalOf(grid, n, false, [](glm::vec3 w) { return glm::dot(w, glm::normalize(glm::vec3(1, 0.5f, 0.4f))) < 0.8f; });
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    const auto w = grid.direction(t);
    const auto mirrored = grid.rowMajor[grid.texelAt({w.x, w.y, std::abs(w.z) + 1e-6f})];
    EXPECT_LE(std::abs(signal.ssdf[grid.rowMajor[t]] - signal.ssdf[mirrored]), 1e-6f);
  }
}

}  // namespace
}  // namespace chiaro
