#include "precompute/bake_error.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "precompute/compression/encode.h"
#include "precompute/lobe_pattern.h"
#include "precompute/parallel.h"
#include "precompute/random_directions.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr std::array kSharpness{10, 30, 100, 300, 1000, 3000};
constexpr std::size_t kSampledVertices = 256;
constexpr std::size_t kAxes = 16;
constexpr std::uint32_t kRays = 256;
constexpr std::size_t kStepsPerSample = 64;  // a sampled vertex takes about as long as that many others

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<std::size_t> sampleVertices(std::size_t vertexCount, std::size_t wanted, std::uint32_t seed) {
  std::vector<std::size_t> all(vertexCount);
  for (std::size_t i = 0; i < vertexCount; ++i) all[i] = i;
  std::mt19937 random(seed);
  const auto count = std::min(wanted, vertexCount);
  for (std::size_t i = 0; i < count; ++i)
    std::swap(all[i], all[i + static_cast<std::size_t>(uniform(random) * static_cast<double>(vertexCount - i))]);
  all.resize(count);
  return all;
}

struct SignalError {
  double squared = 0.0, solidAngle = 0.0;            ///< whole sphere
  double wrongSign = 0.0, signSolidAngle = 0.0;      ///< where it counts
};

SignalError signalError(const TracedSignal& traced, const Transfer& transfer, int threads, StepCounter& steps) {
  const auto& grid = *traced.grid;
  const auto& ssdf = *traced.ssdf;
  const auto terms = static_cast<Eigen::Index>(transfer.terms);
  const auto texels = static_cast<Eigen::Index>(grid.texelCount);
  const Eigen::Map<const RowMatrix> functions(transfer.eigenfunctions.data(), terms, texels);
  const Eigen::Map<const Eigen::RowVectorXf> mean(transfer.mean.data(), texels);

  std::vector<SignalError> parts(ssdf.blocks());
  parallelBlocks(threads, parts.size(), [&](std::size_t block) {
    const auto first = block * RowBlocks::kRows, count = ssdf.rowsOf(block);
    std::vector<std::byte> room;
    const auto* truths = ssdf.block(block, room);
    RowMatrix weights(static_cast<Eigen::Index>(count), terms);
    for (std::size_t i = 0; i < count; ++i) {
      const auto* stored = weightsOf(transfer, first + i);
      for (Eigen::Index k = 0; k < terms; ++k)
        weights(static_cast<Eigen::Index>(i), k) =
            transfer.weightScale[static_cast<std::size_t>(k)] * static_cast<float>(stored[k]) / 32767.0f;
    }
    RowMatrix stored = weights * functions;
    stored.rowwise() += mean;
    for (std::size_t i = 0; i < count; ++i) {
      const auto& viewpoint = (*traced.viewpoints)[first + i];
      const auto* truth = truths + i * grid.texelCount;
      for (std::size_t t = 0; t < grid.texelCount; ++t) {
        const double solidAngle = static_cast<double>(grid.solidAngle[t]);
        const auto texel = grid.rowMajor[t];
        const float value = stored(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(texel));
        const float expected = static_cast<float>(truth[texel]) * traced.step;
        parts[block].squared += solidAngle * static_cast<double>((value - expected) * (value - expected));
        parts[block].solidAngle += solidAngle;
        if (!viewpoint.doubleSided && !(glm::dot(grid.direction(t), viewpoint.normal) > 0.0f)) continue;
        parts[block].signSolidAngle += solidAngle;
        if ((value > 0.0f) != (expected > 0.0f)) parts[block].wrongSign += solidAngle;
      }
    }
    steps.add(count);
  });
  SignalError sum;
  for (const auto& part : parts) {
    sum.squared += part.squared;
    sum.solidAngle += part.solidAngle;
    sum.wrongSign += part.wrongSign;
    sum.signSolidAngle += part.signSolidAngle;
  }
  return sum;
}

double quantisationRms(const TracedSignal& traced, const Pca& pca, const Transfer& transfer, const BakeSettings& settings) {
  const auto terms = static_cast<std::size_t>(pca.terms);
  const auto& grid = *traced.grid;
  const auto vertices = sampleVertices(traced.viewpoints->size(), 1024, settings.seed);
  std::vector<double> squared(vertices.size(), 0.0);
  parallelBlocks(settings.threads, vertices.size(), [&](std::size_t i) {
    std::vector<float> difference(grid.texelCount, 0.0f);
    const auto* stored = weightsOf(transfer, vertices[i]);
    for (std::size_t k = 0; k < terms; ++k) {
      const float exact = pca.weights[vertices[i] * terms + k];
      const float rounded = transfer.weightScale[k] * static_cast<float>(stored[k]) / 32767.0f;
      for (std::size_t t = 0; t < grid.texelCount; ++t)
        difference[t] += exact * pca.functions[k * grid.texelCount + t] - rounded * transfer.eigenfunctions[k * grid.texelCount + t];
    }
    for (std::size_t t = 0; t < grid.texelCount; ++t)
      squared[i] += static_cast<double>(grid.solidAngle[t] * difference[grid.rowMajor[t]] * difference[grid.rowMajor[t]]);
  });
  double sum = 0.0;
  for (const double s : squared) sum += s;
  return std::sqrt(sum / (4.0 * std::numbers::pi * static_cast<double>(vertices.size())));
}

/// On the axis' side of the surface; beyond the horizon the truth is the mirror image of what is before it.
double tracedFraction(const RayScene& rays, const Viewpoint& viewpoint, glm::dvec3 axis, const LobePattern& lobe, double turn) {
  const bool front = glm::dot(glm::vec3(axis), viewpoint.normal) > 0.0f;
  const auto n = front ? viewpoint.normal : -viewpoint.normal;
  const auto origin = front ? viewpoint.front : viewpoint.back;
  std::uint32_t seen = 0;
  std::vector<glm::vec3> directions;
  lobe.directions(axis, turn, directions);
  for (auto w : directions) {
    const float cosine = glm::dot(w, n);
    if (cosine < 0.0f) w -= 2.0f * cosine * n;
    if (!rays.occluded(origin, w, 0.0f, std::numeric_limits<float>::infinity())) ++seen;
  }
  return static_cast<double>(seen) / kRays;
}

struct FractionError {
  std::array<double, kSharpness.size()> stored{}, uncompressed{};
};

FractionError fractionError(const TracedSignal& traced, const Transfer& transfer, const BakeSettings& settings, StepCounter& steps) {
  const auto& grid = *traced.grid;
  const auto vertices = sampleVertices(traced.viewpoints->size(), kSampledVertices, settings.seed + 1);
  std::vector<LobePattern> lobes;
  for (const auto sharpness : kSharpness) lobes.emplace_back(sharpness, kRays);
  std::vector<FractionError> parts(vertices.size());
  parallelBlocks(settings.threads, vertices.size(), [&](std::size_t i) {
    const auto& viewpoint = (*traced.viewpoints)[vertices[i]];
    std::vector<float> exact(grid.texelCount), stored(grid.texelCount);
    {
      std::vector<std::byte> room;
      const auto* row = traced.ssdf->block(vertices[i] / RowBlocks::kRows, room) + vertices[i] % RowBlocks::kRows * grid.texelCount;
      for (std::size_t t = 0; t < grid.texelCount; ++t) exact[t] = static_cast<float>(row[t]) * traced.step;
    }
    decodeSsdf(transfer, weightsOf(transfer, vertices[i]), stored.data());
    std::mt19937 random(settings.seed ^ static_cast<std::uint32_t>(vertices[i]));
    for (std::size_t a = 0; a < kAxes; ++a) {
      auto axis = uniformDirection(random);
      if (!viewpoint.doubleSided && glm::dot(axis, glm::dvec3(viewpoint.normal)) < 0.0) axis = -axis;
      const double turn = 2.0 * std::numbers::pi * uniform(random);
      const auto distanceIn = [&](const std::vector<float>& map) {
        return static_cast<double>(sampleOctahedral(map.data(), grid.resolution, glm::vec3(axis)));
      };
      const double storedDistance = distanceIn(stored), exactDistance = distanceIn(exact);
      for (std::size_t s = 0; s < kSharpness.size(); ++s) {
        const double truth = tracedFraction(*traced.rays, viewpoint, axis, lobes[s], turn);
        parts[i].stored[s] += std::abs(lobe64::ssdfVisibleFraction(storedDistance, kSharpness[s]) - truth);
        parts[i].uncompressed[s] += std::abs(lobe64::ssdfVisibleFraction(exactDistance, kSharpness[s]) - truth);
      }
    }
    steps.add(kStepsPerSample);
  });
  FractionError mean;
  const double count = static_cast<double>(vertices.size() * kAxes);
  for (const auto& part : parts) {
    for (std::size_t s = 0; s < kSharpness.size(); ++s) {
      mean.stored[s] += part.stored[s] / count;
      mean.uncompressed[s] += part.uncompressed[s] / count;
    }
  }
  return mean;
}

}  // namespace

std::vector<std::pair<std::string, double>> measureBakeError(const TracedSignal& traced, const Pca& pca, const Transfer& transfer,
                                                             const BakeSettings& settings, const std::function<void(double)>& progress) {
  const auto vertexCount = traced.viewpoints->size();
  StepCounter steps(vertexCount + kStepsPerSample * std::min(kSampledVertices, vertexCount), progress);
  std::vector<std::pair<std::string, double>> result;
  const auto signal = signalError(traced, transfer, settings.threads, steps);
  result.emplace_back("ssdf_rms_radians", std::sqrt(signal.squared / signal.solidAngle));
  double kept = 0.0;
  for (const double e : pca.energy) kept += e;
  result.emplace_back("ssdf_discarded_rms_radians", std::sqrt(std::max(pca.totalEnergy - kept, 0.0) / signal.solidAngle));
  result.emplace_back("ssdf_sign_share", signal.wrongSign / signal.signSolidAngle);
  result.emplace_back("ssdf_quantisation_rms_radians", quantisationRms(traced, pca, transfer, settings));
  const auto fractions = fractionError(traced, transfer, settings, steps);
  for (std::size_t s = 0; s < kSharpness.size(); ++s)
    result.emplace_back("visible_fraction_mean_abs_" + std::to_string(kSharpness[s]), fractions.stored[s]);
  for (std::size_t s = 0; s < kSharpness.size(); ++s)
    result.emplace_back("visible_fraction_uncompressed_mean_abs_" + std::to_string(kSharpness[s]), fractions.uncompressed[s]);
  return result;
}

}  // namespace chiaro
