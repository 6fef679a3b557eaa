#include "precompute/mesh/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace chiaro {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

template <std::size_t N>
struct BitsHash {
  std::size_t operator()(const std::array<std::uint32_t, N>& bits) const {
    std::uint64_t h = 0xcbf29ce484222325u;  // FNV-1a, a word at a time, with a final mix
    for (const auto b : bits) h = (h ^ b) * 0x100000001b3u;
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    return h ^ (h >> 32);
  }
};

std::uint32_t bitsOf(float x) { return std::bit_cast<std::uint32_t>(x == 0.0f ? 0.0f : x); }

template <typename Vector>
void append(const std::vector<Vector>& values, std::size_t i, std::array<std::uint32_t, 12>& bits, std::size_t& used) {
  if (values.empty()) return;
  for (int c = 0; c < Vector::length(); ++c) bits[used++] = bitsOf(values[i][c]);
}

std::vector<std::uint32_t> weldVertices(const Primitive& primitive) {
  std::unordered_map<std::array<std::uint32_t, 12>, std::uint32_t, BitsHash<12>> first;
  first.reserve(primitive.positions.size());
  std::vector<std::uint32_t> result(primitive.positions.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::array<std::uint32_t, 12> bits{};
    std::size_t used = 0;
    append(primitive.positions, i, bits, used);
    append(primitive.normals, i, bits, used);
    append(primitive.tangents, i, bits, used);
    append(primitive.texcoords, i, bits, used);
    result[i] = first.try_emplace(bits, static_cast<std::uint32_t>(i)).first->second;
  }
  return result;
}

bool degenerate(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const glm::dvec3 p(a), q(b), r(c);
  const double longest = std::sqrt(std::max({glm::dot(q - p, q - p), glm::dot(r - p, r - p), glm::dot(r - q, r - q)}));
  const double altitude = glm::length(glm::cross(q - p, r - p)) / longest;
  double coordinate = 0.0;
  for (const auto& v : {p, q, r})
    for (int i = 0; i < 3; ++i) coordinate = std::max(coordinate, std::abs(v[i]));
  const double rounding = 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon()) * coordinate;
  return !(altitude > std::max(1e-7 * longest, rounding));
}

}  // namespace

std::vector<std::uint32_t> weldPositions(const std::vector<glm::vec3>& positions) {
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, BitsHash<3>> first;
  first.reserve(positions.size());
  std::vector<std::uint32_t> result(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto& p = positions[i];
    result[i] = first.try_emplace({bitsOf(p.x), bitsOf(p.y), bitsOf(p.z)}, static_cast<std::uint32_t>(i)).first->second;
  }
  return result;
}

void selectVertices(Primitive& primitive, const std::vector<std::uint32_t>& keep) {
  const auto select = [&](auto& values) {
    if (values.empty()) return;
    auto old = std::move(values);
    values = {};
    values.reserve(keep.size());
    for (const auto i : keep) values.push_back(old[i]);
  };
  select(primitive.positions);
  select(primitive.normals);
  select(primitive.tangents);
  select(primitive.texcoords);
}

void cleanPrimitive(Primitive& primitive, RepairReport& report) {
  const auto vertexCount = primitive.positions.size();
  std::vector<bool> usedByFile(vertexCount, false);
  for (const auto i : primitive.indices) usedByFile[i] = true;

  const auto welded = weldVertices(primitive);
  const auto position = weldPositions(primitive.positions);
  std::vector<std::uint32_t> indices;
  indices.reserve(primitive.indices.size());
  std::unordered_set<std::array<std::uint32_t, 3>, BitsHash<3>> seen;
  seen.reserve(primitive.triangleCount());
  for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
    const std::array corner{welded[primitive.indices[t]], welded[primitive.indices[t + 1]], welded[primitive.indices[t + 2]]};
    std::array at{position[corner[0]], position[corner[1]], position[corner[2]]};
    if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0] ||
        degenerate(primitive.positions[at[0]], primitive.positions[at[1]], primitive.positions[at[2]])) {
      ++report.degenerateTriangles;
      continue;
    }
    std::rotate(at.begin(), std::min_element(at.begin(), at.end()), at.end());  // same winding, same key
    if (!seen.insert(at).second) {
      ++report.duplicateTriangles;
      continue;
    }
    indices.insert(indices.end(), corner.begin(), corner.end());
  }

  std::vector<std::uint32_t> renumbered(vertexCount, kUnused);
  for (const auto i : indices) renumbered[i] = 0;
  std::vector<std::uint32_t> keep;
  for (std::uint32_t i = 0; i < vertexCount; ++i) {
    if (renumbered[i] != kUnused) {
      renumbered[i] = static_cast<std::uint32_t>(keep.size());
      keep.push_back(i);
    }
  }
  // A vertex is counted once: merged with a kept twin, or else dropped because nothing (any more) uses it.
  for (std::uint32_t i = 0; i < vertexCount; ++i) {
    if (renumbered[i] != kUnused) continue;
    if (welded[i] != i && usedByFile[i] && renumbered[welded[i]] != kUnused)
      ++report.weldedVertices;
    else
      ++report.isolatedVertices;
  }
  for (auto& i : indices) i = renumbered[i];
  selectVertices(primitive, keep);
  primitive.indices = std::move(indices);
}

}  // namespace chiaro
