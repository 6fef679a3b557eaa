#include "precompute/ssdf/ssdf.h"

#include <algorithm>
#include <cmath>

#include "precompute/simd.h"

namespace chiaro {
namespace {

constexpr float kMaxChord = 1.41421356f;  ///< of pi/2

glm::vec3 fold(glm::vec3 w, glm::vec3 n) {
  const float cosine = glm::dot(w, n);
  return cosine < 0.0f ? w - 2.0f * cosine * n : w;
}

/// Squared chords from `center` to `count` points (rounded up to 16); returns the smallest.
float chordsTo(const AlignedFloats& px, const AlignedFloats& py, const AlignedFloats& pz, std::size_t pointCount, glm::vec3 from,
               AlignedFloats& chords) {
  float smallest = 0.0f;
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const float *x = px.data(), *y = py.data(), *z = pz.data();
    float* chord2 = chords.data();
    const std::size_t count = pointCount;
    const glm::vec3 center = from;
    Vector least = Vector{} + 16.0f;
    for (std::size_t i = 0; i < count; i += kWidth<Vector>) {
      const Vector dx = loadVector<Vector>(x + i) - center.x, dy = loadVector<Vector>(y + i) - center.y,
                   dz = loadVector<Vector>(z + i) - center.z;
      const Vector c = dx * dx + dy * dy + dz * dz;
      storeVector(chord2 + i, c);
      least = c < least ? c : least;
    }
    smallest = least[0];
    for (int i = 1; i < kWidth<Vector>; ++i) smallest = std::min(smallest, least[i]);
  });
  return smallest;
}

/// angle[i] = 2 asin(chord / 2), at most pi/2, of the nearest of `count` points to each of sixteen directions. The arcsine is its odd
/// polynomial interpolated on chord^2 / 4 in [0, 1/2]; relative error 7e-8.
void nearestAngles(const AlignedFloats& px, const AlignedFloats& py, const AlignedFloats& pz, std::size_t pointCount, const float* qx,
                   const float* qy, const float* qz, float* angle) {
  alignas(64) float chord2[16], ratio[16];
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const float *x = px.data(), *y = py.data(), *z = pz.data();
    const std::size_t count = pointCount;
    constexpr float kSeries[] = {1.0f,          0.166666142f, 0.0750275732f, 0.0440916167f, 0.0358142393f,
                                 -0.00702057912f, 0.107400021f, -0.135916271f, 0.123913495f};
    constexpr int kParts = 16 / kWidth<Vector>;
    Vector least[kParts], wx[kParts], wy[kParts], wz[kParts];
    for (int k = 0; k < kParts; ++k) {
      least[k] = Vector{} + 2.0f;
      wx[k] = loadVector<Vector>(qx + k * kWidth<Vector>);
      wy[k] = loadVector<Vector>(qy + k * kWidth<Vector>);
      wz[k] = loadVector<Vector>(qz + k * kWidth<Vector>);
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < kParts; ++k) {
        const Vector dx = wx[k] - x[i], dy = wy[k] - y[i], dz = wz[k] - z[i];
        const Vector c = dx * dx + dy * dy + dz * dz;
        least[k] = c < least[k] ? c : least[k];
      }
    }
    for (int k = 0; k < kParts; ++k) {
      const Vector s = 0.25f * least[k];
      Vector series = Vector{} + kSeries[8];
      for (int j = 7; j >= 0; --j) series = series * s + kSeries[j];
      storeVector(chord2 + k * kWidth<Vector>, least[k]);
      storeVector(ratio + k * kWidth<Vector>, series);
    }
  });
  for (int lane = 0; lane < 16; ++lane) {
    const float a = std::sqrt(chord2[lane]) * ratio[lane];
    angle[lane] = a < kMaxDistance ? a : kMaxDistance;
  }
}

/// Directions of one tile, those below the horizon of `normal` mirrored in it.
void foldTile(const float* x, const float* y, const float* z, const float* cosine, glm::vec3 normal, float* qx, float* qy, float* qz) {
  for (int lane = 0; lane < 16; ++lane) {
    const float lift = 2.0f * (cosine[lane] < 0.0f ? cosine[lane] : 0.0f);
    qx[lane] = x[lane] - lift * normal.x;
    qy[lane] = y[lane] - lift * normal.y;
    qz[lane] = z[lane] - lift * normal.z;
  }
}

/// Repeats the last point up to a multiple of sixteen, so that loops need no remainder.
void pad(AlignedFloats& values, std::size_t count) {
  for (std::size_t i = count; i % 16 != 0; ++i) values[i] = values[count - 1];
}

}  // namespace

void boundaryPoints(const OctahedralGrid& grid, const TexelBits& above, const TexelBits& visible, bool doubleSided,
                    std::vector<glm::vec3>& points) {
  points.clear();
  for (std::size_t tile = 0; tile < grid.tileCount; ++tile) {
    // Most tiles are of one kind, and so are those around them.
    const auto bits = visible[tile];
    const auto& around = grid.tilesAround[tile];
    if ((bits == 0 || bits == 0xffff) && std::all_of(around.begin(), around.end(), [&](std::uint32_t t) { return visible[t] == bits; })) continue;
    for (auto i = grid.firstNeighbour[tile]; i < grid.firstNeighbour[tile + 1]; ++i) {
      const auto& [a, b] = grid.neighbours[i];
      if (texelBit(visible.data(), a) == texelBit(visible.data(), b)) continue;
      if (!doubleSided && !(texelBit(above.data(), a) && texelBit(above.data(), b))) continue;
      points.push_back(glm::normalize(grid.direction(a) + grid.direction(b)));
    }
  }
}

void SsdfTransform::Points::reserve(std::size_t points) {
  if (points <= capacity) return;
  capacity = (points + points / 2 + 31) / 16 * 16;
  x = AlignedFloats(capacity);
  y = AlignedFloats(capacity);
  z = AlignedFloats(capacity);
}

SsdfTransform::SsdfTransform(const OctahedralGrid& grid) : grid_(grid), tileBounds_(grid.tileCount) {
  const auto bound = [&](Group& group, const std::vector<std::uint32_t>& tiles) {
    glm::dvec3 sum(0.0);
    for (const auto tile : tiles)
      for (std::size_t lane = 0; lane < 16; ++lane) sum += glm::dvec3(grid.direction(16 * tile + lane));
    group.center = glm::vec3(sum / (16.0 * static_cast<double>(tiles.size())));
    for (const auto tile : tiles)
      for (std::size_t lane = 0; lane < 16; ++lane)
        group.radius = std::max(group.radius, glm::length(grid.direction(16 * tile + lane) - group.center));
  };
  const int tilesPerRow = grid.resolution / 4;
  for (int row = 0; row < tilesPerRow; row += 4) {
    for (int column = 0; column < tilesPerRow; column += 4) {
      std::vector<std::uint32_t> tiles;
      for (int j = row; j < std::min(row + 4, tilesPerRow); ++j)
        for (int i = column; i < std::min(column + 4, tilesPerRow); ++i) tiles.push_back(static_cast<std::uint32_t>(j * tilesPerRow + i));
      auto& group = groups_.emplace_back();
      bound(group, tiles);
      group.firstTile = static_cast<std::uint32_t>(tiles_.size());
      group.tileCount = static_cast<std::uint32_t>(tiles.size());
      tiles_.insert(tiles_.end(), tiles.begin(), tiles.end());
    }
  }
  for (std::uint32_t tile = 0; tile < grid.tileCount; ++tile) bound(tileBounds_[tile], {tile});
}

void SsdfTransform::cull(const Points& from, glm::vec3 center, float radius, Points& to) {
  to.reserve(from.count);
  to.count = 0;
  if (from.count == 0) return;
  const float least = std::sqrt(chordsTo(from.x, from.y, from.z, from.count, center, chord2_));
  // A little more than the inequality asks for, to be safe from rounding. Nothing beyond pi/2 matters.
  const float reach = std::min(least + 2.0f * radius, kMaxChord + radius) * 1.00001f + 1e-6f;
  for (std::size_t i = 0; i < from.count; ++i) {
    to.x[to.count] = from.x[i];
    to.y[to.count] = from.y[i];
    to.z[to.count] = from.z[i];
    to.count += chord2_[i] <= reach * reach;
  }
  if (to.count == 0) return;
  pad(to.x, to.count);
  pad(to.y, to.count);
  pad(to.z, to.count);
}

void SsdfTransform::operator()(glm::vec3 normal, const AlignedFloats& cosine, const TexelBits& above, const TexelBits& visible,
                               bool doubleSided, float* distances) {
  boundaryPoints(grid_, above, visible, doubleSided, boundary_);
  if (boundary_.empty()) {
    for (std::size_t t = 0; t < grid_.texelCount; ++t)
      distances[grid_.rowMajor[t]] = texelBit(visible.data(), t) ? kMaxDistance : -kMaxDistance;
    return;
  }
  all_.reserve(boundary_.size());
  all_.count = boundary_.size();
  for (std::size_t i = 0; i < all_.count; ++i) {
    all_.x[i] = boundary_[i].x;
    all_.y[i] = boundary_[i].y;
    all_.z[i] = boundary_[i].z;
  }
  pad(all_.x, all_.count);
  pad(all_.y, all_.count);
  pad(all_.z, all_.count);
  if (chord2_.data() == nullptr || all_.capacity > chordCapacity_) chord2_ = AlignedFloats(chordCapacity_ = all_.capacity);

  const auto folded = [&](glm::vec3 w) { return doubleSided ? w : fold(w, normal); };
  alignas(64) float angle[16];
  for (const auto& group : groups_) {
    cull(all_, folded(group.center), group.radius, near_);
    for (std::uint32_t k = 0; k < group.tileCount; ++k) {
      const auto tile = tiles_[group.firstTile + k];
      cull(near_, folded(tileBounds_[tile].center), tileBounds_[tile].radius, nearest_);
      const std::size_t first = 16 * std::size_t{tile};
      const float *qx = grid_.x.data() + first, *qy = grid_.y.data() + first, *qz = grid_.z.data() + first;
      if (!doubleSided && above[tile] != 0xffff) {
        foldTile(qx, qy, qz, cosine.data() + first, normal, folded_[0], folded_[1], folded_[2]);
        qx = folded_[0];
        qy = folded_[1];
        qz = folded_[2];
      }
      nearestAngles(nearest_.x, nearest_.y, nearest_.z, nearest_.count, qx, qy, qz, angle);
      for (std::size_t lane = 0; lane < 16; ++lane) angle[lane] = (visible[tile] >> lane & 1) != 0 ? angle[lane] : -angle[lane];
      for (std::size_t row = 0; row < 4; ++row) std::copy_n(angle + 4 * row, 4, distances + grid_.rowMajor[first + 4 * row]);
    }
  }
}

}  // namespace chiaro
