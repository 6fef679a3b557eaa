#include "precompute/clustered_error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "assets/transfer/row_decoder.h"
#include "precompute/lobe_samples.h"
#include "precompute/parallel.h"
#include "precompute/transfer_lookup.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr std::array kSharpness{3, 10, 30, 100, 300, 1000, 3000};
constexpr std::size_t kVertices = 256;
constexpr std::size_t kAxes = 16;
constexpr std::uint32_t kRays = 512;

/// Share of the lobe's rays that leave above the horizon and meet nothing.
double tracedFraction(const RayScene& rays, glm::vec3 origin, glm::vec3 n, glm::dvec3 axis, double sharpness, double turn) {
  static_assert(kRays % 16 == 0);
  int seen = 0;
  alignas(64) float x[16], y[16], z[16];
  for (std::uint32_t first = 0; first < kRays; first += 16) {
    unsigned asked = 0;
    for (std::uint32_t i = 0; i < 16; ++i) {
      const auto w = lobeDirection(axis, sharpness, first + i, kRays, turn);
      x[i] = w.x, y[i] = w.y, z[i] = w.z;
      if (glm::dot(w, n) > 0.0f) asked |= 1u << i;
    }
    if (asked == 0) continue;
    const unsigned hidden = rays.occluded16(origin, x, y, z, static_cast<std::uint16_t>(asked), 0.0f, std::numeric_limits<float>::infinity());
    seen += std::popcount(asked & ~hidden);
  }
  return static_cast<double>(seen) / kRays;
}

struct Sums {
  double squared = 0.0, wrongSign = 0.0, solidAngle = 0.0;
  std::vector<double> levelSquared, levelCount;
  std::array<double, kSharpness.size()> stored{}, uncompressed{};
};

}  // namespace

std::vector<std::pair<std::string, double>> measureClusteredError(const RayScene& rays, const std::vector<Viewpoint>& viewpoints,
                                                                  const TransferRows& rows, const Transfer& transfer,
                                                                  const BakeSettings& settings, const std::function<void(double)>& progress) {
  std::mt19937 random(settings.seed + 1);
  const auto count = std::min(kVertices, viewpoints.size());
  std::vector<std::uint32_t> vertices;
  for (std::size_t i = 0; i < count; ++i)
    vertices.push_back(static_cast<std::uint32_t>(uniform(random) * static_cast<double>(viewpoints.size())));

  const RowDecoder decoder(transfer);
  const auto columns = transfer.columns();
  std::vector<float> stored(count * columns, 0.0f);
  std::vector<float> exact(count * rows.size());
  constexpr std::size_t kBlock = 16;
  const auto& levels = rows.layout().levels;
  std::vector<Sums> parts(count);
  StepCounter steps(count, progress);
  parallelBlocks(settings.threads, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    const auto begin = block * kBlock, n = std::min(kBlock, count - begin);
    rows(std::span<const std::uint32_t>(vertices).subspan(begin, n), exact.data() + begin * rows.size(), rows.size());
    for (std::size_t i = begin; i < begin + n; ++i) {
      decoder.add(vertices[i], 1.0f, stored.data() + i * columns);
      auto& sum = parts[i];
      const auto& viewpoint = viewpoints[vertices[i]];
      const float *got = stored.data() + i * columns, *want = exact.data() + i * rows.size();
      const auto isAbove = [&](glm::vec3 w) { return viewpoint.doubleSided || glm::dot(w, viewpoint.normal) > 0.0f; };
      const auto& grid = rows.storedGrid();
      for (std::size_t t = 0; t < grid.texelCount; ++t) {
        if (!isAbove(grid.direction(t))) continue;
        const double error = static_cast<double>(got[grid.rowMajor[t]] - want[grid.rowMajor[t]]), w = static_cast<double>(grid.solidAngle[t]);
        sum.squared += w * error * error;
        sum.wrongSign += (got[grid.rowMajor[t]] < 0.0f) != (want[grid.rowMajor[t]] < 0.0f) ? w : 0.0;
        sum.solidAngle += w;
      }
      std::size_t at = grid.texelCount;
      for (const auto& level : levels) {
        double squared = 0.0, all = 0.0;
        for (int t = 0; t < level.resolution * level.resolution; ++t, ++at) {
          if (!isAbove(lobe32::octahedralTexelDirection({t % level.resolution, t / level.resolution}, level.resolution))) continue;
          const double error = static_cast<double>(got[at] - want[at]);
          squared += error * error;
          all += 1.0;
        }
        sum.levelSquared.push_back(squared);
        sum.levelCount.push_back(all);
      }
      std::mt19937 own(settings.seed ^ vertices[i]);
      for (std::size_t a = 0; a < kAxes; ++a) {
        auto axis = uniformDirection(own);
        bool front = glm::dot(axis, glm::dvec3(viewpoint.normal)) >= 0.0;
        if (!front && !viewpoint.doubleSided) {
          axis = -axis;
          front = true;
        }
        const double turn = 2.0 * std::numbers::pi * uniform(own);
        const auto n3 = front ? viewpoint.normal : -viewpoint.normal;
        for (std::size_t s = 0; s < kSharpness.size(); ++s) {
          const double truth = tracedFraction(rays, front ? viewpoint.front : viewpoint.back, n3, axis, kSharpness[s], turn);
          const double above = lobe64::sgHalfSpaceFraction(glm::dot(axis, glm::dvec3(n3)), static_cast<double>(kSharpness[s]));
          const auto error = [&](const float* row) {
            return std::abs(above * visibleShare(row, grid.resolution, levels, glm::vec3(axis), kSharpness[s]) - truth);
          };
          sum.stored[s] += error(got);
          sum.uncompressed[s] += error(want);
        }
      }
      steps.add();
    }
  });

  Sums sum;
  sum.levelSquared.resize(levels.size());
  sum.levelCount.resize(levels.size());
  for (const auto& part : parts) {
    sum.squared += part.squared;
    sum.wrongSign += part.wrongSign;
    sum.solidAngle += part.solidAngle;
    for (std::size_t l = 0; l < levels.size(); ++l) {
      sum.levelSquared[l] += part.levelSquared[l];
      sum.levelCount[l] += part.levelCount[l];
    }
    for (std::size_t s = 0; s < kSharpness.size(); ++s) {
      sum.stored[s] += part.stored[s] / static_cast<double>(count * kAxes);
      sum.uncompressed[s] += part.uncompressed[s] / static_cast<double>(count * kAxes);
    }
  }
  std::vector<std::pair<std::string, double>> result;
  result.emplace_back("ssdf_rms_radians", std::sqrt(sum.squared / sum.solidAngle));
  result.emplace_back("ssdf_sign_share", sum.wrongSign / sum.solidAngle);
  for (std::size_t l = 0; l < levels.size(); ++l)
    result.emplace_back("level_rms_" + std::to_string(std::lround(levels[l].sharpness)), std::sqrt(sum.levelSquared[l] / sum.levelCount[l]));
  for (std::size_t s = 0; s < kSharpness.size(); ++s)
    result.emplace_back("visible_fraction_mean_abs_" + std::to_string(kSharpness[s]), sum.stored[s]);
  for (std::size_t s = 0; s < kSharpness.size(); ++s)
    result.emplace_back("visible_fraction_uncompressed_mean_abs_" + std::to_string(kSharpness[s]), sum.uncompressed[s]);
  return result;
}

}  // namespace chiaro
