#include "precompute/visibility/prefilter.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "precompute/simd.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr int kFinest = 64;             // a lobe of sharpness 128 is wider than this map's texels
constexpr float kFaintest = 1e-3f;      // of a lobe's peak: what is left out
constexpr float kLeastAbove = 1.0f / 30.0f;
constexpr float kTexelsPerLobe = 1.48f;  // a texel is at most this part of the lobe's standard deviation 1 / sqrt(sharpness)

// Bits of Scratch::wanted.
constexpr std::uint8_t kSeen = 1, kAll = 2;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Share of a normalised lobe that is above the horizon, tabulated: it is asked for at every texel of every vertex.
constexpr int kShares = 1024;

std::vector<float> sharesAbove(float sharpness) {
  std::vector<float> table(kShares + 2);
  for (int i = 0; i < kShares + 2; ++i)
    table[at(i)] = lobe32::sgHalfSpaceFraction(2.0f * static_cast<float>(i) / kShares - 1.0f, sharpness);
  return table;
}

float shareAt(const std::vector<float>& table, float sine) {
  const float x = 0.5f * (std::clamp(sine, -1.0f, 1.0f) + 1.0f) * kShares;
  const auto i = static_cast<std::size_t>(x);
  return table[i] + (x - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

}  // namespace

PrefilteredVisibility::PrefilteredVisibility(const OctahedralGrid& grid, const std::vector<VisibilityLevel>& levels) : source_(grid) {
  int resolution = grid.resolution;
  while (resolution > kFinest && resolution % 4 == 0) resolution /= 2;
  const int step = grid.resolution / resolution;
  share_ = 1.0f / static_cast<float>(step * step);
  finestOf_.resize(grid.texelCount);
  for (std::size_t t = 0; t < grid.texelCount; ++t) {
    const auto x = grid.rowMajor[t] % at(grid.resolution), y = grid.rowMajor[t] / at(grid.resolution);
    finestOf_[t] = static_cast<std::uint32_t>(y / at(step) * at(resolution) + x / at(step));
  }
  for (;; resolution /= 2) {
    auto& g = grids_.emplace_back();
    g.resolution = resolution;
    for (int t = 0; t < resolution * resolution; ++t) {
      g.direction.push_back(lobe32::octahedralTexelDirection({t % resolution, t / resolution}, resolution));
      g.solidAngle.push_back(static_cast<float>(lobe64::octahedralTexelSolidAngle({t % resolution, t / resolution}, resolution)));
    }
    if (resolution % 4 != 0 || resolution <= 8) break;
  }

  for (const auto& setting : levels) {
    auto& level = levels_.emplace_back();
    level.sharpness = setting.sharpness;
    level.resolution = setting.resolution;
    level.first = size_;
    level.shareAbove = sharesAbove(level.sharpness);
    size_ += at(setting.resolution) * at(setting.resolution);
    // A map of R x R texels has texels of about sqrt(4 pi) / R.
    level.grid = 0;
    while (level.grid + 1 < grids_.size() &&
           3.5449f / static_cast<float>(grids_[level.grid + 1].resolution) * kTexelsPerLobe <= 1.0f / std::sqrt(level.sharpness))
      ++level.grid;
    const auto& g = grids_[level.grid];
    for (int t = 0; t < level.resolution * level.resolution; ++t) {
      const auto axis = lobe32::octahedralTexelDirection({t % level.resolution, t / level.resolution}, level.resolution);
      level.axis.push_back(axis);
      level.firstTap.push_back(static_cast<std::uint32_t>(level.tapTexel.size()));
      double sum = 0.0;
      for (std::size_t s = 0; s < g.direction.size(); ++s) {
        const glm::vec3 d = g.direction[s] - axis;
        const float value = std::exp(-0.5f * level.sharpness * glm::dot(d, d));
        if (!(value > kFaintest)) continue;
        level.tapTexel.push_back(static_cast<std::uint32_t>(s));
        level.tapWeight.push_back(value);
        sum += static_cast<double>(value * g.solidAngle[s]);
      }
      for (auto i = at(static_cast<int>(level.firstTap.back())); i < level.tapWeight.size(); ++i)
        level.tapWeight[i] = static_cast<float>(static_cast<double>(level.tapWeight[i]) / sum);
    }
    level.firstTap.push_back(static_cast<std::uint32_t>(level.tapTexel.size()));
    // A texel's corners are less than 4 / R from its centre.
    const float reach = std::sqrt(-2.0f * std::log(kFaintest) / level.sharpness);
    const float angle = reach < 2.0f ? 2.0f * std::asin(0.5f * reach) + 4.0f / static_cast<float>(g.resolution) : 4.0f;
    if (angle < 1.5f) level.clearOfHorizon = std::sin(angle);
    for (int i = 0; i <= kShares && level.shareAbove[at(i)] <= kLeastAbove; ++i) level.leastAbove = 2.0f * static_cast<float>(i) / kShares - 1.0f;
  }

  // The same sums in the same order as those of a vertex whose horizon is far.
  auto all = scratch();
  for (std::size_t i = 0; i < grids_[0].direction.size(); ++i) std::fill_n(all.mass[0].data() + i * kBatch, kBatch, grids_[0].solidAngle[i]);
  sumCoarser(all);
  std::fill(all.wanted.begin(), all.wanted.end(), kAll);
  gather(all, kAll, all.all);
  for (std::size_t j = 0; j < size_; ++j) whole_.push_back(all.all[j * kBatch]);
}

PrefilteredVisibility::Scratch PrefilteredVisibility::scratch() const {
  Scratch s;
  for (const auto& g : grids_) s.mass.emplace_back(g.direction.size() * kBatch);
  s.seen = AlignedFloats(size_ * kBatch);
  s.all = AlignedFloats(size_ * kBatch);
  s.wanted.resize(size_);
  return s;
}

/// Solid angle on one side of the horizon, what is seen of it or all, per texel of each grid.
void PrefilteredVisibility::fillMass(std::size_t count, const Viewpoint* viewpoints, const TexelBits* above, const TexelBits* visible,
                                     bool back, Scratch& scratch) const {
  float* finest = scratch.mass[0].data();
  std::fill_n(finest, grids_[0].direction.size() * kBatch, 0.0f);
  for (std::size_t i = 0; i < count; ++i) {
    if (back && !viewpoints[i].doubleSided) continue;
    for (std::size_t tile = 0; tile < source_.tileCount; ++tile) {
      const unsigned side = back ? static_cast<std::uint16_t>(~above[i][tile]) : above[i][tile];
      unsigned bits = visible != nullptr ? visible[i][tile] & side : side;
      if (bits == 0xffff && share_ <= 1.0f / 16.0f) {  // the whole tile is within one texel
        finest[finestOf_[16 * tile] * kBatch + i] += 16.0f * share_;
        continue;
      }
      for (; bits != 0; bits &= bits - 1)
        finest[finestOf_[16 * tile + static_cast<std::size_t>(std::countr_zero(bits))] * kBatch + i] += share_;
    }
  }
  for (std::size_t t = 0; t < grids_[0].direction.size(); ++t)
    for (std::size_t i = 0; i < kBatch; ++i) finest[t * kBatch + i] *= grids_[0].solidAngle[t];
  sumCoarser(scratch);
}

void PrefilteredVisibility::sumCoarser(Scratch& scratch) const {
  for (std::size_t g = 1; g < grids_.size(); ++g) {
    const float* fine = scratch.mass[g - 1].data();
    float* coarse = scratch.mass[g].data();
    const auto side = at(grids_[g].resolution);
    for (std::size_t y = 0; y < side; ++y)
      for (std::size_t x = 0; x < side; ++x) {
        const float* from = fine + (2 * y * 2 * side + 2 * x) * kBatch;
        float* to = coarse + (y * side + x) * kBatch;
        for (std::size_t i = 0; i < kBatch; ++i)
          to[i] = (from[i] + from[kBatch + i]) + (from[2 * side * kBatch + i] + from[(2 * side + 1) * kBatch + i]);
      }
  }
}

/// Lobes that are below the horizon of every vertex are not asked for, and of those above it all is known.
void PrefilteredVisibility::markWanted(std::size_t count, const Viewpoint* viewpoints, bool back, Scratch& scratch) const {
  for (const auto& level : levels_)
    for (std::size_t p = 0; p < level.axis.size(); ++p) {
      std::uint8_t wanted = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (back && !viewpoints[i].doubleSided) continue;
        const float sine = glm::dot(back ? -viewpoints[i].normal : viewpoints[i].normal, level.axis[p]);
        if (sine > level.leastAbove) wanted = static_cast<std::uint8_t>(wanted | (sine > level.clearOfHorizon ? kSeen : kSeen | kAll));
      }
      scratch.wanted[level.first + p] = wanted;
    }
}

void PrefilteredVisibility::gather(const Scratch& scratch, std::uint8_t which, AlignedFloats& sums) const {
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    constexpr int kParts = static_cast<int>(kBatch) / kWidth<Vector>;
    float* out = sums.data();
    for (const auto& level : levels_) {
      const float* mass = scratch.mass[level.grid].data();
      const std::uint32_t *texel = level.tapTexel.data(), *first = level.firstTap.data();
      const float* weight = level.tapWeight.data();
      const std::size_t texels = level.axis.size(), base = level.first;
      for (std::size_t p = 0; p < texels; ++p) {
        if ((scratch.wanted[base + p] & which) == 0) continue;
        Vector sum[kParts] = {};
        for (std::uint32_t i = first[p]; i < first[p + 1]; ++i) {
          const float w = weight[i];
          const float* from = mass + std::size_t{texel[i]} * kBatch;
          for (int k = 0; k < kParts; ++k) sum[k] += w * loadVector<Vector>(from + k * kWidth<Vector>);
        }
        for (int k = 0; k < kParts; ++k) storeVector(out + (base + p) * kBatch + k * kWidth<Vector>, sum[k]);
      }
    }
  });
}

void PrefilteredVisibility::store(const Viewpoint& viewpoint, bool back, std::size_t lane, const Scratch& scratch, float* out) const {
  const glm::vec3 n = back ? -viewpoint.normal : viewpoint.normal;
  for (const auto& level : levels_)
    for (std::size_t p = 0; p < level.axis.size(); ++p) {
      const float sine = glm::dot(n, level.axis[p]);
      if (viewpoint.doubleSided && sine < 0.0f) continue;  // the other side's
      const std::size_t j = level.first + p;
      // Both are sums over the same texels, so that what the horizon's own texels get wrong cancels: an open vertex has exactly 1.
      const float all = sine > level.clearOfHorizon ? whole_[j] : scratch.all[j * kBatch + lane];
      out[j] = shareAt(level.shareAbove, sine) > kLeastAbove && all > 0.0f ? std::min(scratch.seen[j * kBatch + lane] / all, 1.0f) : -1.0f;
    }
}

void PrefilteredVisibility::mirrorHidden(const Viewpoint& viewpoint, float* out) const {
  const glm::vec3 n = viewpoint.normal;
  for (const auto& level : levels_) {
    float* map = out + level.first;
    for (std::size_t p = 0; p < level.axis.size(); ++p) {
      if (map[p] >= 0.0f) continue;
      const glm::vec3 mirrored = level.axis[p] - 2.0f * glm::dot(level.axis[p], n) * n;
      // Its four neighbours are above the horizon or just below it, where they have values of their own.
      map[p] = -2.0f - std::clamp(sampleOctahedral(map, level.resolution, mirrored), 0.0f, 1.0f);
    }
    for (std::size_t p = 0; p < level.axis.size(); ++p)
      if (map[p] <= -2.0f) map[p] = -2.0f - map[p];
  }
}

void PrefilteredVisibility::operator()(std::size_t count, const Viewpoint* viewpoints, const TexelBits* above, const TexelBits* visible,
                                       float* const* out, Scratch& scratch) const {
  const bool anyBack = std::any_of(viewpoints, viewpoints + count, [](const Viewpoint& v) { return v.doubleSided; });
  for (const bool back : {false, true}) {
    if (back && !anyBack) break;
    markWanted(count, viewpoints, back, scratch);
    fillMass(count, viewpoints, above, visible, back, scratch);
    gather(scratch, kSeen, scratch.seen);
    fillMass(count, viewpoints, above, nullptr, back, scratch);
    gather(scratch, kAll, scratch.all);
    for (std::size_t i = 0; i < count; ++i)
      if (!back || viewpoints[i].doubleSided) store(viewpoints[i], back, i, scratch, out[i]);
  }
  for (std::size_t i = 0; i < count; ++i)
    if (!viewpoints[i].doubleSided) mirrorHidden(viewpoints[i], out[i]);
}

}  // namespace chiaro
