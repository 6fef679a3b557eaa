#include "precompute/mesh/subdivide.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

#include "precompute/mesh/weld.h"

namespace chiaro {
namespace {

constexpr std::uint32_t kWhole = std::numeric_limits<std::uint32_t>::max();

/// The same from both ends, bit for bit: no crack between two sides of an edge.
template <typename Vector>
Vector middle(const Vector& a, const Vector& b) {
  return 0.5f * a + 0.5f * b;
}

/// A flat wall keeps the normal it had to the last bit.
glm::vec3 middleNormal(glm::vec3 a, glm::vec3 b) {
  if (a == b) return a;
  const auto sum = glm::dvec3(a) + glm::dvec3(b);
  const double length = glm::length(sum);
  return length > 1e-6 ? glm::vec3(sum / length) : a;
}

glm::vec4 middleTangent(glm::vec4 a, glm::vec4 b, glm::vec3 normal) {
  const glm::dvec3 n(normal);
  auto t = glm::dvec3(a) + glm::dvec3(b);
  t -= glm::dot(t, n) * n;
  if (!(glm::length(t) > 1e-6)) t = glm::dvec3(a) - glm::dot(glm::dvec3(a), n) * n;
  const double length = glm::length(t);
  return glm::vec4(length > 0.0 ? glm::vec3(t / length) : glm::vec3(a), a.w);
}

std::uint32_t addMiddle(Primitive& primitive, std::uint32_t a, std::uint32_t b) {
  const auto index = static_cast<std::uint32_t>(primitive.positions.size());
  primitive.positions.push_back(middle(primitive.positions[a], primitive.positions[b]));
  if (!primitive.normals.empty()) primitive.normals.push_back(middleNormal(primitive.normals[a], primitive.normals[b]));
  if (!primitive.tangents.empty())
    primitive.tangents.push_back(middleTangent(primitive.tangents[a], primitive.tangents[b], primitive.normals.back()));
  if (!primitive.texcoords.empty()) primitive.texcoords.push_back(middle(primitive.texcoords[a], primitive.texcoords[b]));
  return index;
}

/// v: corners; m[i]: middle of the edge from corner i, or kWhole. Corner 0 is where the longest edge starts.
void splitTriangle(const std::array<std::uint32_t, 3>& v, const std::array<std::uint32_t, 3>& m, std::vector<std::uint32_t>& out) {
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { out.insert(out.end(), {a, b, c}); };
  if (m[0] == kWhole) {
    add(v[0], v[1], v[2]);
  } else if (m[1] != kWhole && m[2] != kWhole) {
    add(v[0], m[0], m[2]);
    add(m[0], v[1], m[1]);
    add(m[2], m[1], v[2]);
    add(m[0], m[1], m[2]);
  } else {
    if (m[1] == kWhole) {
      add(m[0], v[1], v[2]);
    } else {
      add(m[0], v[1], m[1]);
      add(m[0], m[1], v[2]);
    }
    if (m[2] == kWhole) {
      add(v[0], m[0], v[2]);
    } else {
      add(v[0], m[0], m[2]);
      add(m[2], m[0], v[2]);
    }
  }
}

}  // namespace

EdgeTable::EdgeTable(const Scene& scene) : edgeOfCorner(3 * scene.triangleCount()) {
  std::vector<glm::vec3> positions;
  positions.reserve(scene.vertexCount());
  for (const auto& primitive : scene.primitives) positions.insert(positions.end(), primitive.positions.begin(), primitive.positions.end());
  const auto place = weldPositions(positions);

  struct Keyed {
    std::uint64_t key = 0;
    EdgeSide side;
  };
  std::vector<Keyed> keyed;
  keyed.reserve(edgeOfCorner.size());
  std::uint32_t triangle = 0, firstVertex = 0;
  for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
    const auto& primitive = scene.primitives[p];
    for (std::size_t t = 0; t < primitive.triangleCount(); ++t, ++triangle) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        const auto a = primitive.indices[3 * t + c], b = primitive.indices[3 * t + (c + 1) % 3];
        const std::uint64_t from = place[firstVertex + a], to = place[firstVertex + b];
        keyed.push_back({std::min(from, to) << 32 | std::max(from, to), {std::min(a, b), std::max(a, b), p, triangle, static_cast<std::uint32_t>(3 * t), c}});
      }
    }
    firstVertex += static_cast<std::uint32_t>(primitive.positions.size());
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& x, const Keyed& y) {
    return std::tie(x.key, x.side.primitive, x.side.a, x.side.b, x.side.triangle, x.side.corner) <
           std::tie(y.key, y.side.primitive, y.side.a, y.side.b, y.side.triangle, y.side.corner);
  });

  sides.reserve(keyed.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const bool isNewEdge = i == 0 || keyed[i].key != keyed[i - 1].key;
    if (isNewEdge) {
      const glm::dvec3 a(positions[keyed[i].key >> 32]), b(positions[keyed[i].key & 0xffffffffu]);
      firstSide.push_back(static_cast<std::uint32_t>(i));
      length.push_back(glm::length(b - a));
      wings.push_back(1);
    } else if (!keyed[i].side.sameWing(keyed[i - 1].side)) {
      ++wings.back();
    }
    sides.push_back(keyed[i].side);
    edgeOfCorner[3 * keyed[i].side.triangle + keyed[i].side.corner] = static_cast<std::uint32_t>(length.size() - 1);
  }
  firstSide.push_back(static_cast<std::uint32_t>(sides.size()));
}

std::uint32_t EdgeTable::longestOf(std::uint32_t triangle) const {
  const auto* edge = &edgeOfCorner[3 * static_cast<std::size_t>(triangle)];
  return *std::max_element(edge, edge + 3, [&](std::uint32_t x, std::uint32_t y) {
    return std::pair(length[x], x) < std::pair(length[y], y);
  });
}

void subdivide(Scene& scene, const EdgeTable& table, const std::vector<bool>& marked) {
  std::vector<std::uint32_t> middleOfCorner(table.edgeOfCorner.size(), kWhole);
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (!marked[e]) continue;
    for (auto s = table.firstSide[e]; s < table.firstSide[e + 1]; ++s) {
      const auto& side = table.sides[s];
      const bool isNewWing = s == table.firstSide[e] || !side.sameWing(table.sides[s - 1]);
      auto& primitive = scene.primitives[side.primitive];
      middleOfCorner[3 * side.triangle + side.corner] =
          isNewWing ? addMiddle(primitive, side.a, side.b) : static_cast<std::uint32_t>(primitive.positions.size() - 1);
    }
  }

  std::uint32_t triangle = 0;
  for (auto& primitive : scene.primitives) {
    std::vector<std::uint32_t> indices;
    indices.reserve(primitive.indices.size() + primitive.indices.size() / 4);
    for (std::size_t t = 0; t < primitive.triangleCount(); ++t, ++triangle) {
      const auto longest = table.longestOf(triangle);
      std::size_t first = 0;
      while (table.edgeOfCorner[3 * triangle + first] != longest) ++first;
      const bool whole = middleOfCorner[3 * triangle + first] == kWhole;
      std::array<std::uint32_t, 3> v{}, m{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto c = whole ? i : (first + i) % 3;  // what is not split keeps its corners' order
        v[i] = primitive.indices[3 * t + c];
        m[i] = middleOfCorner[3 * triangle + c];
      }
      splitTriangle(v, m, indices);
    }
    primitive.indices = std::move(indices);
  }
}

}  // namespace chiaro
