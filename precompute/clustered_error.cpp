#include "precompute/clustered_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "assets/transfer/row_decoder.h"
#include "precompute/lobe_pattern.h"
#include "precompute/parallel.h"
#include "precompute/random_directions.h"
#include "precompute/traced_share.h"
#include "precompute/transfer_lookup.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr std::size_t kVertices = 256, kVerticesOfTarget = 768;  // a promise is kept elsewhere, too, where it is made of many
constexpr std::size_t kAxes = 16;
constexpr std::uint32_t kRays = 512;
constexpr std::size_t kBlock = 16;
constexpr auto& kSharpness = ClusteredTruth::kSharpness;

std::size_t blocks(std::size_t vertices) { return (vertices + kBlock - 1) / kBlock; }

struct Sums {
  double squared = 0.0, wrongSign = 0.0, solidAngle = 0.0;
  std::vector<double> levelSquared, levelCount;
  std::array<double, kSharpness.size()> stored{}, uncompressed{};
};

}  // namespace

ClusteredTruth::ClusteredTruth(const RayScene& rays, const std::vector<Viewpoint>& viewpoints, const TransferRows& rows,
                               const BakeSettings& settings, const std::function<void(double)>& progress)
    : viewpoints_(viewpoints), rows_(rows), threads_(settings.threads) {
  std::mt19937 random(settings.seed + 1);
  const auto count = std::min(settings.targetError > 0.0 ? kVerticesOfTarget : kVertices, viewpoints.size());
  for (std::size_t i = 0; i < count; ++i)
    vertices_.push_back(static_cast<std::uint32_t>(uniform(random) * static_cast<double>(viewpoints.size())));
  exact_.resize(count * rows.size());
  axes_.resize(count);
  std::vector<LobePattern> patterns;
  for (const auto sharpness : kSharpness) patterns.emplace_back(sharpness, kRays);
  StepCounter steps(count, progress);
  parallelBlocks(threads_, blocks(count), [&](std::size_t block) {
    const auto begin = block * kBlock, n = std::min(kBlock, count - begin);
    rows(std::span<const std::uint32_t>(vertices_).subspan(begin, n), exact_.data() + begin * rows.size(), rows.size());
    std::vector<glm::vec3> directions;
    for (std::size_t i = begin; i < begin + n; ++i) {
      const auto& viewpoint = viewpoints[vertices_[i]];
      std::mt19937 own(settings.seed ^ vertices_[i]);
      for (std::size_t a = 0; a < kAxes; ++a) {
        auto axis = uniformDirection(own);
        bool front = glm::dot(axis, glm::dvec3(viewpoint.normal)) >= 0.0;
        if (!front && !viewpoint.doubleSided) {
          axis = -axis;
          front = true;
        }
        const double turn = 2.0 * std::numbers::pi * uniform(own);
        const auto normal = front ? viewpoint.normal : -viewpoint.normal;
        auto& lobes = axes_[i].emplace_back(Axis{.axis = axis, .aboveHorizon = {}, .visible = {}});
        for (std::size_t s = 0; s < kSharpness.size(); ++s) {
          patterns[s].directions(axis, turn, directions);
          lobes.visible[s] = tracedShare(rays, front ? viewpoint.front : viewpoint.back, normal, directions);
          lobes.aboveHorizon[s] = lobe64::sgHalfSpaceFraction(glm::dot(axis, glm::dvec3(normal)), static_cast<double>(kSharpness[s]));
        }
      }
      steps.add();
    }
  });
}

std::vector<std::pair<std::string, double>> ClusteredTruth::errorOf(const Transfer& transfer) const {
  const RowDecoder decoder(transfer);
  const auto count = vertices_.size();
  const auto& levels = rows_.layout().levels;
  const auto& grid = rows_.storedGrid();
  const float softness = rows_.layout().softness, clamp = rows_.layout().clamp;
  std::vector<Sums> parts(count);
  parallelBlocks(threads_, blocks(count), [&](std::size_t block) {
    std::vector<float> stored(transfer.columns());
    for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
      std::fill(stored.begin(), stored.end(), 0.0f);
      decoder.add(vertices_[i], 1.0f, stored.data());
      auto& sum = parts[i];
      const auto& viewpoint = viewpoints_[vertices_[i]];
      const float *got = stored.data(), *want = exact_.data() + i * rows_.size();
      const auto isAbove = [&](glm::vec3 w) { return viewpoint.doubleSided || glm::dot(w, viewpoint.normal) > 0.0f; };
      for (std::size_t t = 0; t < grid.texelCount; ++t) {
        if (!isAbove(grid.direction(t))) continue;
        const auto distance = [&](const float* row) { return std::clamp(lobe32::ssdfExpanded(row[grid.rowMajor[t]], softness), -clamp, clamp); };
        const double error = static_cast<double>(distance(got) - distance(want)), w = static_cast<double>(grid.solidAngle[t]);
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
      for (const auto& lobes : axes_[i])
        for (std::size_t s = 0; s < kSharpness.size(); ++s) {
          const auto error = [&](const float* row) {
            return std::abs(lobes.aboveHorizon[s] * visibleShare(row, grid.resolution, levels, softness, glm::vec3(lobes.axis), kSharpness[s]) - lobes.visible[s]);
          };
          sum.stored[s] += error(got);
          sum.uncompressed[s] += error(want);
        }
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
