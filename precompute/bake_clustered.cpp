#include "precompute/bake_clustered.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>

#include "precompute/clustered_error.h"
#include "precompute/compression/encode_clusters.h"
#include "precompute/compression/masked_pca.h"
#include "precompute/compression/masked_projection.h"
#include "precompute/compression/model_size.h"
#include "precompute/compression/product.h"
#include "precompute/compression/rate_control.h"
#include "precompute/compression/target_search.h"
#include "precompute/elapsed.h"
#include "precompute/horizon_masks.h"
#include "precompute/fraction_bytes.h"
#include "precompute/journal/pca_record.h"
#include "precompute/journal/row_store.h"
#include "precompute/parallel.h"
#include "precompute/row_layout.h"
#include "precompute/ssdf/ssdf.h"
#include "precompute/transfer_rows.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using RowMatrix = RowMajor<float>;

/// What a stored distance, and the share of a lobe, weigh in the joint error. The sharpest level holds the most detail and, unweighted, would be the worst
/// kept.
constexpr float kSsdfWeight = 1.4f;
constexpr float kLevelWeight = 0.09f, kSharpestLevelWeight = 0.37f;
constexpr float kFractionWeight = 0.2f;

constexpr std::size_t kMostSampled = 8192;     // rows the shared functions are made from,
constexpr std::size_t kLeastSampled = 2048;
constexpr std::size_t kSampledOfFunction = 20; // so many for each of them: with a twentieth of the error of all rows
constexpr int kMaskSide = 10;
constexpr std::size_t kMostMasks = kMaskSide * kMaskSide + 1;
constexpr std::size_t kMostTraining = 65536;   // rows the clusters are made from

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

std::vector<std::uint16_t> masksOf(const ColumnMasks& masks, std::span<const std::uint32_t> vertices) {
  std::vector<std::uint16_t> result;
  for (const auto v : vertices) result.push_back(masks.ofRow[v]);
  return result;
}

std::vector<float> columnWeights(const TransferRows& rows, bool joint) {
  auto weight = rows.storedGrid().rowMajorSolidAngle();
  if (!joint) return weight;
  for (float& w : weight) w *= kSsdfWeight * kSsdfWeight;
  const auto& levels = rows.layout().levels;
  for (const auto& level : levels) {
    const float own = level == levels.back() ? kSharpestLevelWeight : kLevelWeight;
    for (int t = 0; t < level.resolution * level.resolution; ++t)
      weight.push_back(own * own * static_cast<float>(lobe64::octahedralTexelSolidAngle({t % level.resolution, t / level.resolution}, level.resolution)));
  }
  const auto directions = rows.layout().directions.size();
  weight.insert(weight.end(), directions, kFractionWeight * kFractionWeight * 4.0f * std::numbers::pi_v<float> / static_cast<float>(directions));
  return weight;
}

/// Weights of sampled rows.
void projectSample(const RowBlocks& sampled, const std::vector<std::uint32_t>& sample, const ColumnMasks& masks, const MaskedProjection& projection, int threads,
                   Pca& pca) {
  pca.weights.resize(sampled.rows() * static_cast<std::size_t>(pca.terms));
  parallelBlocks(threads, sampled.blocks(), [&](std::size_t block) {
    const auto first = block * RowBlocks::kRows, n = sampled.rowsOf(block), columns = sampled.columns();
    std::vector<std::byte> room;
    const auto* packed = sampled.block(block, room);
    std::vector<float> rows(n * columns);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<float>(packed[i]) * (kMaxDistance / 32767.0f);
    const auto own = masksOf(masks, std::span(sample).subspan(first, n));
    const RowMatrix projected = projection(rows.data(), columns, own);
    std::copy_n(projected.data(), projected.size(), pca.weights.begin() + static_cast<std::ptrdiff_t>(first * static_cast<std::size_t>(pca.terms)));
  });
}

CoordinateScale coordinateScales(const Pca& pca, std::size_t sampled) {
  std::vector<float> scale(static_cast<std::size_t>(pca.terms), 1e-6f);
  for (std::size_t i = 0; i < sampled; ++i)
    for (std::size_t k = 0; k < scale.size(); ++k) scale[k] = std::max(scale[k], std::abs(pca.weights[i * scale.size() + k]));
  for (float& s : scale) s *= 1.25f;  // rows outside the sample may be larger
  return {scale};
}

/// One model of a bake: infinite bytes keep all terms.
double mostBytes(const BakeSettings& settings) {
  if (settings.targetError > 0.0) return std::numeric_limits<double>::infinity();
  return settings.bytesPerVertex > 0.0 ? settings.bytesPerVertex : kUsualBytes;
}

ModelSize sizeOf(const BakeSettings& settings, double bytes, std::size_t vertices) {
  auto automatic = modelSize(std::min(bytes, *std::rbegin(kByteRungs)), vertices, settings.samplingResolution / settings.resolution);
  if (std::isinf(bytes)) automatic.functions = std::max(automatic.functions, kMostNeeded);
  return {.functions = settings.functions > 0 ? settings.functions : automatic.functions,
          .clusters = settings.clusters > 0 ? settings.clusters : automatic.clusters};
}

RateTarget rateOf(const BakeSettings& settings, double bytes) {
  // Where nothing was asked for, no byte goes into what drowns in other errors, and small scenes, in which few vertices share much, take more of them.
  if (settings.bytesPerVertex == 0.0 && settings.targetError == 0.0) return {.bytesPerVertex = bytes, .finest = 0.004, .mostRounding = 1e-3};
  return {.bytesPerVertex = settings.bytesPerVertex < 0.0 ? std::numeric_limits<double>::infinity() : bytes};
}

double worstFraction(const std::vector<std::pair<std::string, double>>& error) {
  double worst = 0.0;
  for (const auto& [name, value] : error) {
    if (!name.starts_with("visible_fraction_mean_abs_")) continue;
    if (std::isnan(value)) return value;
    worst = std::max(worst, value);
  }
  return worst;
}

/// What a bake needs beside what is there when tracing starts, stage by stage, with or without the large parts in memory.
struct Needs {
  std::size_t vertices = 0, rowColumns = 0, columns = 0, functions = 0, sampled = 0, clusters = 0, terms = 0, fractionBytes = 0;
  PcaSettings pca;
  int samplingResolution = 0, threads = 0;

  std::size_t bytes(bool coordinatesInMemory, bool sampleInMemory) const {
    const auto coordinates = coordinatesInMemory ? 2 * functions * vertices : 0;
    const auto sample = sampleInMemory ? 2 * columns * sampled : 0;
    const auto texels = static_cast<std::size_t>(samplingResolution) * static_cast<std::size_t>(samplingResolution);
    // A block as floats, as 16 bits and as a record; boards, distances and sums of the maps that are traced.
    const auto tracing = static_cast<std::size_t>(threadCount(threads)) * (8 * RowBlocks::kRows * rowColumns + 96 * texels);
    const auto always = vertices * (6 + fractionBytes) + (fractionBytes > 0 ? 8 * vertices : 0) + 4 * kMostMasks * columns;
    const auto basis = 4 * functions * columns;
    const auto model = 4 * clusters * (terms + 1) * functions;
    const auto training = std::min(vertices, kMostTraining) * functions * 4;
    const auto measured = 2 * 256 * rowColumns * 4;
    const auto projection = MaskedProjection::memory(functions, columns, kMostMasks);
    const auto threadsAsked = static_cast<std::size_t>(threadCount(threads));
    const auto normalEquations = threadsAsked * (basis + 16 * functions * functions);
    // Lists as they are, as they are packed, coded twice; and what xz works in.
    const auto lists = 2 * functions * columns + clusters * (terms + 2) * functions + vertices * (terms + 2);
    const auto coding = 3 * lists + threadsAsked * 12 * std::min<std::size_t>(lists, std::size_t{8} << 20);
    return always + std::max({sample + std::max(tracing, pcaMemory(sampled, columns, pca) + 5 * basis),
                              sample + basis + projection + normalEquations,
                              coordinates + basis + projection + tracing,
                              coordinates + basis + 2 * training + model,
                              coordinates + basis + 3 * model + 9 * vertices * terms + coding,
                              2 * basis + model + 3 * vertices * terms + 8 * vertices + measured + tracing + lists});
  }
};

}  // namespace

void bakeClustered(const BakeTask& task, BakedScene& baked, BakeReport& report) {
  const auto& settings = task.settings;
  const auto& viewpoints = task.viewpoints;
  auto& transfer = baked.transfer;
  const bool joint = settings.compression == Compression::joint;
  const auto layout = rowLayout(settings, transfer.directions, transfer.directionSharpness);
  const TransferRows rows(task.rays, viewpoints, layout);
  transfer.clustered.levels = layout.levels;
  transfer.clustered.ssdfSoftness = layout.softness;
  const auto count = viewpoints.size();
  const auto columns = joint ? rows.size() : rows.texels();
  // With levels the fractions are part of a row, else bytes beside it.
  const auto directions = layout.directions.size(), sideBytes = joint ? 0 : directions;
  const auto mostSize = sizeOf(settings, mostBytes(settings), count);
  const PcaSettings pcaSettings{.terms = mostSize.functions, .iterations = 2, .seed = settings.seed, .threads = settings.threads};
  const auto sampleSize = std::min(count, std::clamp(kSampledOfFunction * static_cast<std::size_t>(mostSize.functions), kLeastSampled, kMostSampled));
  const Needs needs{.vertices = count,
                    .rowColumns = rows.size(),
                    .columns = columns,
                    .functions = static_cast<std::size_t>(pcaSettings.terms),
                    .sampled = sampleSize,
                    .clusters = static_cast<std::size_t>(mostSize.clusters),
                    .terms = static_cast<std::size_t>(settings.terms),
                    .fractionBytes = directions,
                    .pca = pcaSettings,
                    .samplingResolution = settings.samplingResolution,
                    .threads = settings.threads};
  const bool onDisk = task.journal != nullptr;
  const bool coordinatesInMemory = !onDisk || task.memory.fits(needs.bytes(true, true));
  const bool sampleInMemory = !onDisk || task.memory.fits(needs.bytes(coordinatesInMemory, true));
  task.memory.require(needs.bytes(coordinatesInMemory, sampleInMemory));
  const auto place = [&](BakeRecord kind, bool inMemory) {
    return RowStore::Place{.journal = task.journal, .kind = static_cast<std::uint32_t>(kind), .inMemory = inMemory};
  };

  std::optional<FractionBytes> fractionBytes;
  if (!joint) fractionBytes.emplace(baked.scene, transfer);
  TraceTally tally;
  std::mutex mutex;
  double traceWall = 0.0;
  const auto progress = task.stage("visibility");
  StepCounter steps(count, progress);
  /// Traces those blocks of `vertices` that an earlier bake has not left in the journal. pack: one row into the store's numbers, a block at a time.
  const auto trace = [&](const std::vector<std::uint32_t>& vertices, RowStore& store,
                         const std::function<void(const float*, std::span<const std::uint32_t>, std::int16_t*)>& pack) {
    const auto start = Clock::now();
    const auto keepFractions = [&](std::size_t first, std::size_t n, const std::uint8_t* side) {
      if (!fractionBytes) return;
      for (std::size_t i = 0; i < n; ++i) fractionBytes->set(vertices[first + i], side + i * sideBytes);
    };
    std::size_t resumed = 0;
    const auto missing = store.restore([&](std::size_t block, std::uint64_t blockRays, const std::uint8_t* side) {
      keepFractions(block * RowBlocks::kRows, store.rowsOf(block), side);
      tally.rays += blockRays;
      resumed += store.rowsOf(block);
    });
    report.verticesResumed += resumed;
    if (resumed > 0) steps.add(resumed);
    parallelBlocks(settings.threads, missing.size(), [&](std::size_t i) {
      const auto block = missing[i], first = block * RowBlocks::kRows, n = store.rowsOf(block);
      std::vector<float> buffer(n * rows.size());
      std::vector<std::int16_t> packed(n * store.columns());
      std::vector<std::uint8_t> side(n * sideBytes);
      const auto part = rows(std::span(vertices).subspan(first, n), buffer.data(), rows.size());
      if (!joint)
        for (std::size_t v = 0; v < n; ++v) toFractionBytes(buffer.data() + v * rows.size() + columns, directions, side.data() + v * sideBytes);
      keepFractions(first, n, side.data());
      pack(buffer.data(), std::span(vertices).subspan(first, n), packed.data());
      store.put(block, part.rays, packed.data(), side.data());
      const std::lock_guard lock(mutex);
      tally += part;
      steps.add(n);
    });
    traceWall += secondsSince(start);
  };

  const auto masks = horizonMasks(viewpoints, layout, columns, kMaskSide);
  const auto sample = chosen(count, sampleSize, settings.seed);
  std::optional<RowStore> sampled(std::in_place, sample.size(), columns, sideBytes, place(BakeRecord::sampledRows, sampleInMemory));
  trace(sample, *sampled, [&](const float* buffer, std::span<const std::uint32_t> own, std::int16_t* packed) {
    for (std::size_t i = 0; i < own.size(); ++i) toFixedPoint(buffer + i * rows.size(), columns, kMaxDistance, packed + i * columns);
  });

  auto compressionStart = Clock::now();
  const auto weight = columnWeights(rows, joint);
  Pca pca;
  std::optional<MaskedProjection> projection;
  {
    constexpr auto kKind = static_cast<std::uint32_t>(BakeRecord::sharedFunctions);
    std::vector<std::byte> record;
    if (task.journal == nullptr || !task.journal->read(kKind, 0, record) || !unpackPca(record, sample.size(), columns, pca)) {
      pca = computeMaskedPca(*sampled, kMaxDistance, weight, {.masks = masks.masks, .ofRow = masksOf(masks, sample)}, pcaSettings, task.stage("shared functions"));
      projection.emplace(pca, weight, masks, settings.threads);
      projectSample(*sampled, sample, masks, *projection, settings.threads, pca);
      if (task.journal != nullptr) task.journal->append(kKind, 0, packPca(pca));
    }
  }
  sampled.reset();
  const auto terms = static_cast<std::size_t>(pca.terms);
  const auto scale = coordinateScales(pca, sample.size());
  report.seconds.compression = secondsSince(compressionStart);

  std::vector<std::uint32_t> rest;
  rest.reserve(count - sample.size());
  for (std::size_t v = 0, s = 0; v < count; ++v) {
    if (s < sample.size() && sample[s] == v) ++s;
    else rest.push_back(static_cast<std::uint32_t>(v));
  }
  std::optional<RowStore> restCoordinates(std::in_place, rest.size(), terms, sideBytes, place(BakeRecord::coordinates, coordinatesInMemory));
  CoordinateStore coordinates(sample, *restCoordinates, scale);
  for (std::size_t i = 0; i < sample.size(); ++i) coordinates.set(sample[i], pca.weights.data() + i * terms);
  pca.weights = {};
  {
    if (!projection) projection.emplace(pca, weight, masks, settings.threads);
    trace(rest, *restCoordinates, [&](const float* buffer, std::span<const std::uint32_t> own, std::int16_t* packed) {
      const RowMatrix projected = (*projection)(buffer, rows.size(), masksOf(masks, own));
      for (std::size_t i = 0; i < own.size(); ++i) scale.pack(projected.row(static_cast<Eigen::Index>(i)).data(), packed + i * terms);
    });
  }
  report.raysTraced = tally.rays;
  const double all = std::max(tally.visibilitySeconds + tally.ssdfSeconds + tally.filterSeconds, 1e-9);
  report.seconds.visibility = traceWall * (tally.visibilitySeconds + tally.filterSeconds) / all;
  report.seconds.ssdf = traceWall * tally.ssdfSeconds / all;

  compressionStart = Clock::now();
  std::vector<std::size_t> primitiveVertices;
  for (const auto& p : baked.scene.primitives) primitiveVertices.push_back(p.positions.size());
  const auto training = chosen(count, kMostTraining, settings.seed + 1);
  const Transfer plain = transfer;
  std::optional<ClusteredTruth> truth;  // not before it is needed: its rows take memory
  const auto compress = [&](double bytes) {
    const auto start = Clock::now();
    const auto size = sizeOf(settings, bytes, count);
    const Pca leading = leadingTerms(pca, size.functions);
    coordinates.useColumns(static_cast<std::size_t>(leading.terms));
    const auto clusters = clusterRows(coordinates.read(training),
                                      {.clusters = size.clusters, .terms = settings.terms, .iterations = 3, .seed = settings.seed, .threads = settings.threads}, task.stage("clusters"));
    transfer = plain;
    const ClusterEncoder encoder(leading, clusters, coordinates, primitiveVertices, weight,
                                 {.weightBits = settings.weightBits, .functionBits = settings.functionBits, .functionRows = sample.size(), .ssdfTexels = rows.texels(), .threads = settings.threads});
    baked.coded = encodeWithin(encoder, rateOf(settings, bytes), count, settings.threads, transfer);
    report.seconds.compression += secondsSince(start);
    if (!truth) truth.emplace(task.rays, viewpoints, rows, settings, task.stage("error"));
    report.error = truth->errorOf(transfer);
  };
  report.seconds.compression += secondsSince(compressionStart);
  if (settings.targetError > 0.0) {
    std::vector<double> rungs(std::begin(kByteRungs), std::end(kByteRungs));
    rungs.push_back(mostBytes(settings));
    const auto found = fewestBytes(rungs, settings.targetError, [&](double bytes) {
      compress(bytes);
      return worstFraction(report.error);
    });
    if (!found.isLast) compress(found.bytes);
    report.missedTarget = !(found.error <= settings.targetError);
  } else {
    compress(mostBytes(settings));
  }
  coordinates = {};
  restCoordinates.reset();
  if (joint) decodeFractions(transfer);

  report.terms = transfer.terms;
  report.bytesPerVertex = transfer.bytesPerVertex(count, &*baked.coded);
}

}  // namespace chiaro
