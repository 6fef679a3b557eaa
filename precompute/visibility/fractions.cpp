#include "precompute/visibility/fractions.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "precompute/simd.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

/// At most 64 directions (BakeSettings).
struct Sums {
  alignas(64) float value[64] = {};
  float operator[](std::size_t j) const { return value[j]; }
};

/// all += sum |cosine| lobe, seen += the same over visible texels, over the texels of `which`. Sixteen lobes at a time stay in registers.
void accumulate(const float* allLobes, std::size_t stride, const AlignedFloats& cosines, const TexelBits& which, const TexelBits& visible,
                Sums& all, Sums& seen) {
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    constexpr int kParts = 16 / kWidth<Vector>;
    const std::size_t tileCount = which.size(), step = stride;
    const std::uint16_t *wanted = which.data(), *visibleBits = visible.data();
    const float* cosine = cosines.data();
    for (std::size_t first = 0; first < step; first += 16) {
      const float* lobes = allLobes + first;
      Vector sum[kParts] = {}, seenSum[kParts] = {};
      for (std::size_t tile = 0; tile < tileCount; ++tile) {
        for (unsigned left = wanted[tile]; left != 0; left &= left - 1) {
          const auto lane = static_cast<unsigned>(std::countr_zero(left));
          const std::size_t texel = 16 * tile + lane;
          const float weight = std::abs(cosine[texel]);
          const float seenWeight = static_cast<float>(visibleBits[tile] >> lane & 1) * weight;
          for (int k = 0; k < kParts; ++k) {
            const Vector lobe = loadVector<Vector>(lobes + texel * step + static_cast<std::size_t>(k * kWidth<Vector>));
            sum[k] += weight * lobe;
            seenSum[k] += seenWeight * lobe;
          }
        }
      }
      for (int k = 0; k < kParts; ++k) {
        storeVector(all.value + first + k * kWidth<Vector>, sum[k]);
        storeVector(seen.value + first + k * kWidth<Vector>, seenSum[k]);
      }
    }
  });
}

}  // namespace

std::vector<glm::vec3> fibonacciDirections(int count) {
  std::vector<glm::vec3> result;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count, phi = i * 2.39996323, r = std::sqrt(1.0 - z * z);
    result.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  return result;
}

VisibleFractions::VisibleFractions(const OctahedralGrid& grid, const std::vector<glm::vec3>& directions, float sharpness)
    : grid_(grid),
      directions_(directions),
      sharpness_(sharpness),
      stride_((directions.size() + 15) / 16 * 16),
      lobes_(grid.texelCount * stride_) {
  for (std::size_t t = 0; t < grid.texelCount; ++t)
    for (std::size_t j = 0; j < directions.size(); ++j)
      lobes_[t * stride_ + j] =
          grid.solidAngle[t] * lobe32::sgEvaluate(lobe32::sphericalGaussian(directions[j], sharpness, 1.0f), grid.direction(t));
}

void VisibleFractions::operator()(const Viewpoint& viewpoint, const AlignedFloats& cosine, const TexelBits& above,
                                  const TexelBits& visible, float* fractions) const {
  const auto n = viewpoint.normal;
  Sums all, seen;
  accumulate(lobes_.data(), stride_, cosine, above, visible, all, seen);
  if (viewpoint.doubleSided) {
    auto below = above;
    for (auto& bits : below) bits = static_cast<std::uint16_t>(~bits);
    Sums allBelow, seenBelow;
    accumulate(lobes_.data(), stride_, cosine, below, visible, allBelow, seenBelow);
    for (std::size_t j = 0; j < directions_.size(); ++j) {
      const bool front = glm::dot(n, directions_[j]) > 0.0f;
      fractions[j] = std::clamp((front ? seen[j] : seenBelow[j]) / (front ? all[j] : allBelow[j]), 0.0f, 1.0f);
    }
    return;
  }

  // A lobe about the normal gathers about 2 pi / sharpness; a thousandth of that is noise of the texels on the horizon.
  const float least = 1e-3f * 2.0f * std::numbers::pi_v<float> / sharpness_;
  for (std::size_t j = 0; j < directions_.size(); ++j)
    if (all[j] > least) fractions[j] = std::clamp(seen[j] / all[j], 0.0f, 1.0f);
  for (std::size_t j = 0; j < directions_.size(); ++j) {
    if (all[j] > least) continue;
    const auto mirrored = directions_[j] - 2.0f * glm::dot(directions_[j], n) * n;
    float weights = 0.0f, sum = 0.0f;
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      if (!(all[k] > least)) continue;
      const float weight = all[k] * std::exp(0.5f * sharpness_ * (glm::dot(directions_[k], mirrored) - 1.0f));
      weights += weight;
      sum += weight * fractions[k];
    }
    fractions[j] = weights > 0.0f ? sum / weights : 1.0f;
  }
}

}  // namespace chiaro
