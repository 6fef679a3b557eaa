// Prefiltered visibility against direct integration of occluders whose shape is known.
#include "precompute/visibility/prefilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

const std::vector<VisibilityLevel> kLevels{{3.0f, 12}, {10.5f, 20}, {36.75f, 28}, {128.625f, 44}};
const int kResolutions[]{32, 64, 96, 128, 256};

using Sees = std::function<bool(glm::vec3)>;

Sees everything() {
  return [](glm::vec3) { return true; };
}
/// All but a cap.
Sees outsideCap(glm::vec3 axis, float angle) {
  return [axis = glm::normalize(axis), least = std::cos(angle)](glm::vec3 w) { return glm::dot(w, axis) < least; };
}
Sees halfPlane(glm::vec3 side) {
  return [side = glm::normalize(side)](glm::vec3 w) { return glm::dot(w, side) > 0.0f; };
}

class Filtered {
 public:
  Filtered(int resolution, const Viewpoint& viewpoint, const Sees& sees) : grid_(resolution), prefilter_(grid_, kLevels) {
    AlignedFloats cosine(grid_.texelCount);
    TexelBits above, visible(grid_.tileCount, 0);
    texelsAbove(grid_, viewpoint.normal, cosine, above);
    for (std::size_t t = 0; t < grid_.texelCount; ++t)
      if ((viewpoint.doubleSided || texelBit(above.data(), t)) && sees(grid_.direction(t)))
        visible[t / 16] = static_cast<std::uint16_t>(visible[t / 16] | 1u << t % 16);
    values.resize(prefilter_.size());
    auto scratch = prefilter_.scratch();
    float* out = values.data();
    prefilter_(1, &viewpoint, &above, &visible, &out, scratch);
  }
  std::vector<float> values;

 private:
  OctahedralGrid grid_;
  PrefilteredVisibility prefilter_;
};

/// Every texel of every level: its index, level and axis.
void forEachTexel(const std::function<void(std::size_t, const VisibilityLevel&, glm::vec3)>& use) {
  std::size_t index = 0;
  for (const auto& level : kLevels)
    for (int t = 0; t < level.resolution * level.resolution; ++t)
      use(index++, level, lobe32::octahedralTexelDirection({t % level.resolution, t / level.resolution}, level.resolution));
}

/// Share of the lobe on the axis' side of the horizon that is seen, by rings about the axis.
double integrated(glm::vec3 axis, double sharpness, glm::vec3 normal, const Sees& sees) {
  constexpr int kRings = 96, kSpokes = 96;
  const auto helper = std::abs(axis.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const auto x = glm::normalize(glm::cross(helper, axis)), y = glm::cross(axis, x);
  double seen = 0.0, all = 0.0;
  for (int i = 0; i < kRings; ++i) {
    // Rings of equal share of the lobe.
    const double u = (i + 0.5) / kRings, t = -std::log1p(u * std::expm1(-2.0 * sharpness)) / sharpness;
    const auto cosine = static_cast<float>(1.0 - t), sine = static_cast<float>(std::sqrt(std::max(t * (2.0 - t), 0.0)));
    for (int k = 0; k < kSpokes; ++k) {
      const float phi = 2.0f * std::numbers::pi_v<float> * (static_cast<float>(k) + 0.618f * static_cast<float>(i)) / kSpokes;
      const auto w = cosine * axis + sine * (std::cos(phi) * x + std::sin(phi) * y);
      if (glm::dot(w, normal) <= 0.0f) continue;
      all += 1.0;
      seen += sees(w) ? 1.0 : 0.0;
    }
  }
  return seen / all;
}

/// An edge is known to half a texel at worst (a map of R x R has texels of up to 1.5 sqrt(4 pi) / R), and that far off it takes this part of a
/// lobe whose share above the horizon is `above`.
double edgeTolerance(int resolution, double sharpness, double above) {
  const double texel = 1.5 * std::sqrt(4.0 * std::numbers::pi) / resolution;
  return 0.5 * texel * std::sqrt(sharpness / (2.0 * std::numbers::pi)) / above;
}
/// Lobes are read at the centres of texels that are up to two thirds of their standard deviation wide.
constexpr double kPyramid = 0.005;
/// Below this share of itself above the horizon a lobe has no value of its own.
constexpr double kLeastAbove = 1.0 / 30.0;

double shareAbove(glm::vec3 axis, glm::vec3 normal, double sharpness) {
  return lobe64::sgHalfSpaceFraction(static_cast<double>(glm::dot(axis, normal)), sharpness);
}

glm::vec3 mirrored(glm::vec3 axis, glm::vec3 normal) { return axis - 2.0f * glm::dot(axis, normal) * normal; }

const glm::vec3 kNormals[]{{0, 1, 0}, {0.36f, 0.48f, -0.8f}, {-0.6f, 0.0f, 0.8f}};

TEST(Prefilter, AnOpenVertexSeesAllOfEveryLobe) {
  for (const int resolution : kResolutions)
    for (const auto normal : kNormals) {
      const Filtered filtered(resolution, {.normal = normal}, everything());
      forEachTexel([&](std::size_t i, const VisibilityLevel& level, glm::vec3 axis) {
        const auto sharpness = static_cast<double>(level.sharpness);
        const double above = std::max(shareAbove(axis, normal, sharpness), kLeastAbove);
        // The horizon is the only edge.
        EXPECT_GE(filtered.values[i], 1.0 - edgeTolerance(resolution, sharpness, above) - kPyramid) << resolution << " " << sharpness;
        EXPECT_LE(filtered.values[i], 1.0f);
        if (glm::dot(axis, normal) * std::sqrt(level.sharpness) > 4.0f) {
          EXPECT_LE(std::abs(filtered.values[i] - 1.0f), 1e-3f) << "four standard deviations above the horizon " << resolution << " " << sharpness;
        }
      });
    }
}

TEST(Prefilter, OccludersAreIntegrated) {
  for (const auto& sees : {outsideCap({0.5f, 0.6f, 0.2f}, 0.5f), halfPlane({0.8f, 0.3f, -0.5f})})
    for (const auto normal : kNormals) {
      std::vector<double> truth;
      forEachTexel([&](std::size_t, const VisibilityLevel& level, glm::vec3 axis) {
        truth.push_back(glm::dot(axis, normal) > 0.0f ? integrated(axis, static_cast<double>(level.sharpness), normal, sees) : -1.0);
      });
      for (const int resolution : kResolutions) {
        const Filtered filtered(resolution, {.normal = normal}, sees);
        std::map<float, double> sum, count;
        forEachTexel([&](std::size_t i, const VisibilityLevel& level, glm::vec3 axis) {
          if (truth[i] < 0.0) return;
          const auto sharpness = static_cast<double>(level.sharpness);
          const double error = std::abs(static_cast<double>(filtered.values[i]) - truth[i]);
          EXPECT_LE(error, edgeTolerance(resolution, sharpness, shareAbove(axis, normal, sharpness)) + kPyramid) << resolution << " " << sharpness;
          sum[level.sharpness] += error;
          count[level.sharpness] += 1.0;
        });
        // Not all lobes meet an edge, and few an edge that is half a texel off.
        for (const auto& level : kLevels)
          EXPECT_LE(sum[level.sharpness] / count[level.sharpness],
                    0.25 * edgeTolerance(resolution, static_cast<double>(level.sharpness), 1.0) + kPyramid)
              << resolution << " " << level.sharpness;
      }
    }
}

TEST(Prefilter, NothingSeenIsZero) {
  for (const int resolution : kResolutions)
    for (const bool doubleSided : {false, true})
      for (const float v : Filtered(resolution, {.normal = {0.6f, 0.8f, 0}, .doubleSided = doubleSided}, [](glm::vec3) { return false; }).values)
        ASSERT_EQ(v, 0.0f);
}

TEST(Prefilter, EachSideOfADoubleSidedVertexIsItsOwn) {
  for (const auto normal : kNormals) {
    const auto behind = outsideCap(-normal, 0.6f);
    const auto sees = [&](glm::vec3 w) { return glm::dot(w, normal) > 0.0f || behind(w); };
    const Filtered both(128, {.normal = normal, .doubleSided = true}, sees), front(128, {.normal = normal}, everything());
    forEachTexel([&](std::size_t i, const VisibilityLevel& level, glm::vec3 axis) {
      const float sine = glm::dot(axis, normal);
      const auto sharpness = static_cast<double>(level.sharpness);
      if (sine > 0.0f) {
        ASSERT_EQ(both.values[i], front.values[i]);
      }
      if (sine >= 0.0f) return;
      const double error = std::abs(static_cast<double>(both.values[i]) - integrated(axis, sharpness, -normal, sees));
      EXPECT_LE(error, edgeTolerance(128, sharpness, shareAbove(axis, -normal, sharpness)) + kPyramid) << sharpness;
    });
  }
}

TEST(Prefilter, BelowTheHorizonIsTheMirrorImage) {
  for (const auto normal : kNormals) {
    // A wall that stands on the horizon: its mirror image goes on with it.
    const auto along = glm::normalize(glm::cross(normal, glm::vec3(0.3f, 0.2f, 0.9f)));
    const auto sees = halfPlane(along);
    const Filtered filtered(256, {.normal = normal}, sees);
    int mirroredCount = 0;
    forEachTexel([&](std::size_t i, const VisibilityLevel& level, glm::vec3 axis) {
      const auto sharpness = static_cast<double>(level.sharpness);
      const double above = shareAbove(axis, normal, sharpness);
      EXPECT_TRUE(filtered.values[i] >= 0.0f && filtered.values[i] <= 1.0f);
      if (above > kLeastAbove) return;
      ++mirroredCount;
      const double truth = integrated(mirrored(axis, normal), sharpness, normal, sees);
      // Bilinear between texels up to 1.5 sqrt(4 pi) / R wide: an eighth of their square times the steepest curvature of the normal
      // distribution, .242 sharpness, both ways.
      const double width = 1.5 * std::sqrt(4.0 * std::numbers::pi) / level.resolution;
      EXPECT_LE(std::abs(static_cast<double>(filtered.values[i]) - truth),
                edgeTolerance(256, sharpness, 1.0 - above) + kPyramid + 0.25 * width * width * 0.242 * sharpness)
          << sharpness;
    });
    EXPECT_GT(mirroredCount, 500);
  }
}

TEST(Prefilter, NoSeamWhereMirroringBegins) {
  const glm::vec3 normal{0.36f, 0.48f, -0.8f};
  const auto along = glm::normalize(glm::cross(normal, glm::vec3(0.3f, 0.2f, 0.9f)));
  const Filtered filtered(256, {.normal = normal}, halfPlane(along));
  std::size_t first = 0;
  int seams = 0;
  for (const auto& level : kLevels) {
    const auto sharpness = static_cast<double>(level.sharpness);
    const auto axis = [&](int x, int y) { return lobe32::octahedralTexelDirection({x, y}, level.resolution); };
    const auto at = [&](int x, int y) { return static_cast<double>(filtered.values[first + static_cast<std::size_t>(y * level.resolution + x)]); };
    const auto expectNoSeam = [&](int x, int y, int x2, int y2) {
      const double a = shareAbove(axis(x, y), normal, sharpness), b = shareAbove(axis(x2, y2), normal, sharpness);
      if ((a > kLeastAbove) == (b > kLeastAbove)) return;
      ++seams;
      // No more than the wall's own profile across one texel at its steepest, and the horizon's texels.
      const auto step = static_cast<double>(glm::distance(axis(x, y), axis(x2, y2)));
      EXPECT_LE(std::abs(at(x, y) - at(x2, y2)),
                step * std::sqrt(sharpness / (2.0 * std::numbers::pi)) + edgeTolerance(256, sharpness, kLeastAbove) + kPyramid)
          << sharpness;
    };
    for (int y = 0; y + 1 < level.resolution; ++y)
      for (int x = 0; x + 1 < level.resolution; ++x) {
        expectNoSeam(x, y, x + 1, y);
        expectNoSeam(x, y, x, y + 1);
      }
    first += static_cast<std::size_t>(level.resolution) * static_cast<std::size_t>(level.resolution);
  }
  EXPECT_GT(seams, 50);
}

TEST(Prefilter, ABatchIsWhatEachVertexIsAlone) {
  const OctahedralGrid grid(64);
  const PrefilteredVisibility prefilter(grid, kLevels);
  auto scratch = prefilter.scratch();
  constexpr std::size_t kCount = 11;
  const std::size_t stride = prefilter.size() + 3;
  Viewpoint viewpoints[kCount];
  TexelBits above[kCount], visible[kCount];
  AlignedFloats cosine(grid.texelCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    viewpoints[i].normal = kNormals[i % 3];
    viewpoints[i].doubleSided = i % 4 == 1;
    texelsAbove(grid, viewpoints[i].normal, cosine, above[i]);
    visible[i].resize(grid.tileCount);
    for (std::size_t t = 0; t < grid.tileCount; ++t)
      visible[i][t] = static_cast<std::uint16_t>((t * 2654435761u >> i) & (viewpoints[i].doubleSided ? 0xffffu : above[i][t]));
  }
  std::vector<float> together(kCount * stride, -7.0f), alone(prefilter.size());
  float* rows[kCount];
  for (std::size_t i = 0; i < kCount; ++i) rows[i] = together.data() + i * stride;
  prefilter(kCount, viewpoints, above, visible, rows, scratch);
  for (std::size_t i = 0; i < kCount; ++i) {
    float* out = alone.data();
    prefilter(1, viewpoints + i, above + i, visible + i, &out, scratch);
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), together.begin() + static_cast<std::ptrdiff_t>(i * stride))) << i;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(together[i * stride + prefilter.size() + k], -7.0f);
  }
}

TEST(Prefilter, NoLevels) {
  const OctahedralGrid grid(16);
  EXPECT_EQ(PrefilteredVisibility(grid, {}).size(), 0u);
}

}  // namespace
}  // namespace chiaro
