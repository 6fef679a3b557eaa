#include "precompute/bake_clustered.h"

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numbers>
#include <numeric>
#include <random>

#include "precompute/clustered_error.h"
#include "precompute/compression/encode_clusters.h"
#include "precompute/compression/product.h"
#include "precompute/parallel.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/transfer_rows.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using Clock = std::chrono::steady_clock;
using RowMatrix = RowMajor<float>;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Sharpness 3, 10.5, 36.75, 128.6, and maps whose texels are about as wide as half a lobe.
const std::vector<VisibilityLevel> kLevels{{3.0f, 12}, {10.5f, 20}, {36.75f, 28}, {128.625f, 44}};
/// With levels, only lobes sharper than the last one read the SSDF: three of their standard deviations.
constexpr float kJointClamp = 0.265f;
/// What the share of a lobe weighs in the joint error beside a radian of distance: the sharpest level holds the most detail and, unweighted,
/// would be the worst kept.
float levelWeight(const VisibilityLevel& level) { return level == kLevels.back() ? 0.25f : 0.15f; }
constexpr float kFractionWeight = 0.3f;

constexpr std::size_t kMostSampled = 8192;     // rows the shared functions are made from
constexpr std::size_t kMostTraining = 65536;   // rows the clusters are made from
constexpr std::size_t kBlock = 128;            // vertices projected together: part of the result's bits

/// `wanted` of `count` in rising order, or all.
std::vector<std::uint32_t> chosen(std::size_t count, std::size_t wanted, std::uint32_t seed) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  if (wanted >= count) return all;
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < wanted; ++i) std::swap(all[i], all[i + random() % (count - i)]);
  all.resize(wanted);
  std::sort(all.begin(), all.end());
  return all;
}

/// The vertices' bytes of what is not part of the compressed row.
class FractionBytes {
 public:
  FractionBytes(const Scene& scene, Transfer& transfer) : directionCount_(static_cast<std::size_t>(transfer.directionCount)) {
    transfer.primitives.resize(scene.primitives.size());
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
      auto& bytes = transfer.primitives[p].visibility;
      bytes.resize(scene.primitives[p].positions.size() * directionCount_);
      for (std::size_t i = 0; i < scene.primitives[p].positions.size(); ++i) place_.push_back(bytes.data() + i * directionCount_);
    }
  }
  void set(std::size_t vertex, const float* fractions) {
    for (std::size_t j = 0; j < directionCount_; ++j) place_[vertex][j] = static_cast<std::uint8_t>(std::lrint(255.0f * fractions[j]));
  }

 private:
  std::size_t directionCount_;
  std::vector<std::uint8_t*> place_;
};

std::vector<float> columnWeights(const TransferRows& rows, bool joint) {
  std::vector<float> weight;
  const auto& grid = rows.storedGrid();
  weight.resize(grid.texelCount);
  for (std::size_t t = 0; t < grid.texelCount; ++t) weight[grid.rowMajor[t]] = grid.solidAngle[t];
  if (!joint) return weight;
  for (const auto& level : rows.layout().levels)
    for (int t = 0; t < level.resolution * level.resolution; ++t)
      weight.push_back(levelWeight(level) * levelWeight(level) *
                       static_cast<float>(lobe64::octahedralTexelSolidAngle({t % level.resolution, t / level.resolution}, level.resolution)));
  const auto directions = rows.layout().directions.size();
  weight.insert(weight.end(), directions, kFractionWeight * kFractionWeight * 4.0f * std::numbers::pi_v<float> / static_cast<float>(directions));
  return weight;
}

/// Coordinates of rows in pca's functions.
class Projection {
 public:
  Projection(const Pca& pca, const std::vector<float>& weight)
      : mean_(Eigen::Map<const Eigen::RowVectorXf>(pca.mean.data(), static_cast<Eigen::Index>(pca.mean.size()))),
        matrix_(static_cast<Eigen::Index>(pca.mean.size()), pca.terms) {
    for (Eigen::Index k = 0; k < matrix_.cols(); ++k)
      for (Eigen::Index j = 0; j < matrix_.rows(); ++j)
        matrix_(j, k) = pca.functions[static_cast<std::size_t>(k * matrix_.rows() + j)] * weight[static_cast<std::size_t>(j)];
  }
  /// rows: count by stride, of which the first columns matter.
  RowMatrix operator()(const float* rows, std::size_t count, std::size_t stride) const {
    const Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>> from(rows, static_cast<Eigen::Index>(count), matrix_.rows(),
                                                                    Eigen::OuterStride<>(static_cast<Eigen::Index>(stride)));
    return product(from.rowwise() - mean_, matrix_);
  }

 private:
  Eigen::RowVectorXf mean_;
  RowMatrix matrix_;
};

std::vector<float> coordinateScales(const Pca& pca, std::size_t sampled) {
  std::vector<float> scale(static_cast<std::size_t>(pca.terms), 1e-6f);
  for (std::size_t i = 0; i < sampled; ++i)
    for (std::size_t k = 0; k < scale.size(); ++k) scale[k] = std::max(scale[k], std::abs(pca.weights[i * scale.size() + k]));
  for (float& s : scale) s *= 1.25f;  // rows outside the sample may be larger
  return scale;
}

int automatic(int wanted, std::size_t vertices, std::size_t verticesEach, int least, int most) {
  if (wanted > 0) return wanted;
  return static_cast<int>(std::clamp(vertices / verticesEach, static_cast<std::size_t>(least), static_cast<std::size_t>(most)));
}

/// The paper's own: 48 weights of 16 bits, and its basis on some ten thousand vertices (Wang et al. 2009, section 6).
constexpr double kBytesPerVertex = 104.0;
constexpr double kLeastTermBytes = 40.0;  // where few vertices share the functions

ClusterEncoding encodingOf(const BakeSettings& settings) {
  const bool automatically = settings.bytesPerVertex == 0.0;
  return {.weightBits = settings.weightBits,
          .functionBits = settings.functionBits,
          .wideTerms = settings.wideTerms,
          .bytesPerVertex = automatically ? kBytesPerVertex : std::max(settings.bytesPerVertex, 0.0),
          .leastTermBytes = automatically ? kLeastTermBytes : 0.0,
          .threads = settings.threads};
}

}  // namespace

void bakeClustered(const RayScene& rays, const std::vector<Viewpoint>& viewpoints, const BakeSettings& settings, BakedScene& baked,
                   BakeReport& report, const std::function<std::function<void(double)>(const std::string&)>& stage) {
  auto& transfer = baked.transfer;
  const bool joint = settings.compression == Compression::joint;
  const TransferRows::Layout layout{.resolution = settings.resolution,
                              .samplingResolution = settings.samplingResolution,
                              .clamp = joint ? kJointClamp : kMaxDistance,
                              .leastOccluder = settings.leastOccluder,
                              .levels = joint ? kLevels : std::vector<VisibilityLevel>{},
                              .directions = transfer.directions,
                              .directionSharpness = transfer.directionSharpness};
  const TransferRows rows(rays, viewpoints, layout);
  transfer.clustered.levels = layout.levels;
  const auto count = viewpoints.size();
  const auto columns = joint ? rows.size() : rows.texels();
  FractionBytes fractionBytes(baked.scene, transfer);

  TraceTally tally;
  std::mutex mutex;
  double traceWall = 0.0;
  const auto progress = stage("visibility");
  StepCounter steps(count, progress);
  /// Traces `vertices` block by block and hands each block's rows on.
  const auto trace = [&](const std::vector<std::uint32_t>& vertices, const std::function<void(std::size_t, std::size_t, const float*)>& use) {
    const auto start = Clock::now();
    parallelBlocks(settings.threads, (vertices.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
      const auto first = block * kBlock, n = std::min(kBlock, vertices.size() - first);
      std::vector<float> buffer(n * rows.size());
      const auto part = rows(std::span(vertices).subspan(first, n), buffer.data(), rows.size());
      if (!joint)
        for (std::size_t i = 0; i < n; ++i) fractionBytes.set(vertices[first + i], buffer.data() + i * rows.size() + columns);
      use(first, n, buffer.data());
      const std::lock_guard lock(mutex);
      tally += part;
      steps.add(n);
    });
    traceWall += secondsSince(start);
  };

  const auto sample = chosen(count, kMostSampled, settings.seed);
  FixedPointMatrix sampled(sample.size(), columns, kMaxDistance);
  trace(sample, [&](std::size_t first, std::size_t n, const float* buffer) {
    for (std::size_t i = 0; i < n; ++i) sampled.setRow(first + i, buffer + i * rows.size());
  });

  auto compressionStart = Clock::now();
  const auto weight = columnWeights(rows, joint);
  const int functions = automatic(settings.functions, count, 160, 32, 320);
  const auto pca = computePca(sampled, weight, {.terms = functions, .iterations = 2, .seed = settings.seed, .threads = settings.threads},
                              stage("shared functions"));
  CoordinateStore coordinates(count, coordinateScales(pca, sample.size()));
  for (std::size_t i = 0; i < sample.size(); ++i) coordinates.set(sample[i], pca.weights.data() + i * static_cast<std::size_t>(pca.terms));
  sampled = {};
  report.seconds.compression = secondsSince(compressionStart);

  std::vector<std::uint32_t> rest;
  for (std::size_t v = 0, s = 0; v < count; ++v) {
    if (s < sample.size() && sample[s] == v) ++s;
    else rest.push_back(static_cast<std::uint32_t>(v));
  }
  const Projection projection(pca, weight);
  trace(rest, [&](std::size_t first, std::size_t n, const float* buffer) {
    const RowMatrix projected = projection(buffer, n, rows.size());
    for (std::size_t i = 0; i < n; ++i) coordinates.set(rest[first + i], projected.row(static_cast<Eigen::Index>(i)).data());
  });
  report.raysTraced = tally.rays;
  const double all = std::max(tally.visibilitySeconds + tally.ssdfSeconds + tally.filterSeconds, 1e-9);
  report.seconds.visibility = traceWall * (tally.visibilitySeconds + tally.filterSeconds) / all;
  report.seconds.ssdf = traceWall * tally.ssdfSeconds / all;

  compressionStart = Clock::now();
  std::vector<std::size_t> primitiveVertices;
  for (const auto& p : baked.scene.primitives) primitiveVertices.push_back(p.positions.size());
  const ClusterSettings clusterSettings{.clusters = automatic(settings.clusters, count, 80, 1, 1024),
                                        .terms = settings.terms,
                                        .seed = settings.seed,
                                        .threads = settings.threads};
  const auto clusters = clusterRows(coordinates.read(chosen(count, kMostTraining, settings.seed + 1)), clusterSettings, stage("clusters"));
  encodeClusters(pca, clusters, coordinates, primitiveVertices, encodingOf(settings), transfer);
  report.seconds.compression += secondsSince(compressionStart);
  if (joint) decodeFractions(transfer);

  report.terms = transfer.terms;
  report.bytesPerVertex = transfer.bytesPerVertex(count);
  report.error = measureClusteredError(rays, viewpoints, rows, transfer, settings, stage("error"));
}

}  // namespace chiaro
