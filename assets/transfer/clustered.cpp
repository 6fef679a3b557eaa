#include "assets/transfer/clustered.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace chiaro {
namespace {

constexpr std::size_t kBlock = 16;
constexpr float kSmallestScale = 1e-30f;

float largest(const float* values, std::size_t count) {
  float most = 0.0f;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, std::abs(values[i]));
  return most;
}

std::size_t blocks(std::size_t columns) { return (columns + kBlock - 1) / kBlock; }

int nibble(int bits) { return bits >= 8 ? bits - 16 : bits; }

double columnScaleOf(const std::vector<float>& scales, std::size_t column) { return scales.empty() ? 1.0 : static_cast<double>(scales[column]); }

/// Of kind 12.
int stepsOf(const std::uint8_t* low, std::size_t columns) { return static_cast<std::int8_t>(low[0]) + 256 * static_cast<std::int8_t>(low[columns]); }

}  // namespace

bool isGeometric(const std::vector<VisibilityLevel>& levels) {
  for (std::size_t l = 2; l < levels.size(); ++l) {
    const float ratio = levels[l].sharpness / levels[l - 1].sharpness * levels[0].sharpness / levels[1].sharpness;
    if (!(std::abs(ratio - 1.0f) <= 1e-3f)) return false;
  }
  return true;
}

std::size_t PackedFunctions::bytesOf(int bits, std::size_t columns) {
  if (bits == 16 || bits == 12) return 2 * columns;
  return bits == 8 ? columns : blocks(columns) * (1 + kBlock / 2);
}

void PackedFunctions::append(const float* values, std::size_t columns, int bitsPerValue) {
  if (bitsPerValue == 12) {
    double most = static_cast<double>(kSmallestScale);
    for (std::size_t i = 0; i < columns; ++i) most = std::max(most, std::abs(static_cast<double>(values[i])) / columnScaleOf(columnScale, i));
    appendSteps(values, columns, static_cast<float>(most));
    return;
  }
  bits.push_back(static_cast<std::uint8_t>(bitsPerValue));
  const auto first = data.size();
  data.resize(first + bytesOf(bitsPerValue, columns));
  auto* to = data.data() + first;
  if (bitsPerValue == 16) {
    scale.push_back(1.0f);
    for (std::size_t i = 0; i < columns; ++i) {
      const auto half = Imath::half(values[i]).bits();
      std::memcpy(to + 2 * i, &half, 2);
    }
    return;
  }
  const float most = std::max(largest(values, columns), kSmallestScale);
  scale.push_back(most);
  if (bitsPerValue == 8) {
    for (std::size_t i = 0; i < columns; ++i) to[i] = static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lrint(values[i] / most * 127.0f)));
    return;
  }
  for (std::size_t b = 0; b < blocks(columns); ++b, to += 1 + kBlock / 2) {
    const auto begin = b * kBlock, count = std::min(kBlock, columns - begin);
    // Rounded up, so that no value leaves the range.
    const auto share = static_cast<std::uint8_t>(std::clamp(std::ceil(largest(values + begin, count) / most * 255.0f), 0.0f, 255.0f));
    to[0] = share;
    const float unit = most * static_cast<float>(share) / (255.0f * 7.0f);
    for (std::size_t i = 0; i < count; ++i) {
      const long q = share == 0 ? 0 : std::clamp(std::lrint(values[begin + i] / unit), -7L, 7L);
      to[1 + i / 2] = static_cast<std::uint8_t>(to[1 + i / 2] | (static_cast<unsigned>(q) & 15u) << (i % 2 == 0 ? 0 : 4));
    }
  }
}

void PackedFunctions::appendSteps(const float* values, std::size_t columns, float ofFunction) {
  bits.push_back(12);
  scale.push_back(ofFunction);
  const auto first = data.size();
  data.resize(first + bytesOf(12, columns));
  auto *low = data.data() + first, *high = low + columns;
  for (std::size_t i = 0; i < columns; ++i) {
    const double steps = static_cast<double>(values[i]) / (static_cast<double>(ofFunction) * columnScaleOf(columnScale, i)) * kMostSteps;
    const auto q = static_cast<int>(std::nearbyint(std::clamp<double>(steps, -kMostSteps, kMostSteps)));
    low[i] = static_cast<std::uint8_t>(q & 255);
    high[i] = static_cast<std::uint8_t>((q + 128) >> 8 & 255);
  }
}

bool PackedFunctions::inRange(std::size_t columns) const {
  const auto* from = data.data();
  bool ok = true;
  for (const int kind : bits) {
    if (kind == 12)
      for (std::size_t i = 0; i < columns; ++i) ok = ok && std::abs(stepsOf(from + i, columns)) <= kMostSteps;
    if (kind == 8) ok = ok && std::find(from, from + columns, 128) == from + columns;
    if (kind == 4)
      for (std::size_t i = 0; i < columns; ++i) {
        const auto byte = from[i / kBlock * (1 + kBlock / 2) + 1 + i % kBlock / 2];
        ok = ok && nibble(byte >> (i % 2 == 0 ? 0 : 4) & 15) >= -7;
      }
    from += bytesOf(kind, columns);
  }
  return ok;
}

std::vector<float> PackedFunctions::unpack(std::size_t columns) const {
  std::vector<float> values(count() * columns);
  const auto* from = data.data();
  for (std::size_t f = 0; f < count(); ++f) {
    float* to = values.data() + f * columns;
    if (bits[f] == 16) {
      for (std::size_t i = 0; i < columns; ++i) {
        std::uint16_t raw = 0;
        std::memcpy(&raw, from + 2 * i, 2);
        Imath::half half;
        half.setBits(raw);
        to[i] = half;
      }
    } else if (bits[f] == 12) {
      for (std::size_t i = 0; i < columns; ++i)
        to[i] = scale[f] * (columnScale.empty() ? 1.0f : columnScale[i]) * static_cast<float>(stepsOf(from + i, columns)) / static_cast<float>(kMostSteps);
    } else if (bits[f] == 8) {
      for (std::size_t i = 0; i < columns; ++i) to[i] = scale[f] * static_cast<float>(static_cast<std::int8_t>(from[i])) / 127.0f;
    } else {
      const auto* block = from;
      for (std::size_t b = 0; b < blocks(columns); ++b, block += 1 + kBlock / 2) {
        const float unit = scale[f] * static_cast<float>(block[0]) / (255.0f * 7.0f);
        for (std::size_t i = 0; i < std::min(kBlock, columns - b * kBlock); ++i)
          to[b * kBlock + i] = unit * static_cast<float>(nibble(block[1 + i / 2] >> (i % 2 == 0 ? 0 : 4) & 15));
      }
    }
    from += bytesOf(bits[f], columns);
  }
  return values;
}

std::vector<std::size_t> ClusteredVertices::firstWeights(const std::vector<TransferCluster>& clusters) const {
  std::vector<std::size_t> first(cluster.size() + 1, 0);
  for (std::size_t i = 0; i < cluster.size(); ++i) first[i + 1] = first[i] + static_cast<std::size_t>(clusters[cluster[i]].terms);
  return first;
}

std::vector<float> clusterMaps(const std::vector<TransferCluster>& clusters, const std::vector<float>& functions, const std::vector<float>& mean,
                               std::size_t begin, std::size_t end) {
  const auto columns = mean.size(), width = end - begin;
  std::size_t rows = 0;
  for (const auto& cluster : clusters) rows += 1 + static_cast<std::size_t>(cluster.terms);
  std::vector<float> maps(rows * width, 0.0f);
  // A strip of all functions at a time stays in the cache while every cluster reads it.
  constexpr std::size_t kStrip = 128;
  std::vector<float> factors;
  for (std::size_t strip = begin; strip < end; strip += kStrip) {
    const auto n = std::min(kStrip, end - strip);
    float* map = maps.data() + (strip - begin);
    for (const auto& cluster : clusters) {
      const auto count = cluster.mean.size();
      factors.resize(count);
      for (int k = -1; k < cluster.terms; ++k, map += width) {
        if (k < 0) std::copy_n(mean.data() + strip, n, map);
        for (std::size_t d = 0; d < count; ++d)
          factors[d] = k < 0 ? cluster.meanScale * static_cast<float>(cluster.mean[d]) / 32767.0f
                             : static_cast<float>(cluster.components[static_cast<std::size_t>(k) * count + d]) / 127.0f;
        std::size_t d = 0;
        for (; d + 4 <= count; d += 4) {
          const float *a = functions.data() + d * columns + strip, *b = a + columns, *c = b + columns, *e = c + columns;
          const float fa = factors[d], fb = factors[d + 1], fc = factors[d + 2], fe = factors[d + 3];
          for (std::size_t i = 0; i < n; ++i) map[i] += (fa * a[i] + fb * b[i]) + (fc * c[i] + fe * e[i]);
        }
        for (; d < count; ++d) {
          const float* a = functions.data() + d * columns + strip;
          for (std::size_t i = 0; i < n; ++i) map[i] += factors[d] * a[i];
        }
      }
    }
  }
  return maps;
}

}  // namespace chiaro
