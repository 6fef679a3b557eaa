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

const Float16& at(const AlignedFloats& values, std::size_t first) { return *reinterpret_cast<const Float16*>(values.data() + first); }

/// Squared chords from `center` to `count` points (rounded up to 16); returns the smallest.
CHIARO_CLONES
float chordsTo(const AlignedFloats& x, const AlignedFloats& y, const AlignedFloats& z, std::size_t count, glm::vec3 center,
               AlignedFloats& chord2) {
  Float16 least = Float16{} + 16.0f;
  for (std::size_t i = 0; i < count; i += 16) {
    const Float16 dx = at(x, i) - center.x, dy = at(y, i) - center.y, dz = at(z, i) - center.z;
    const Float16 c = dx * dx + dy * dy + dz * dz;
    *reinterpret_cast<Float16*>(chord2.data() + i) = c;
    least = c < least ? c : least;
  }
  float result = least[0];
  for (int i = 1; i < 16; ++i) result = std::min(result, least[i]);
  return result;
}

/// angle[i] = 2 asin(chord / 2), at most pi/2, of the nearest of `count` points to each of sixteen directions. The arcsine is its odd
/// polynomial interpolated on chord^2 / 4 in [0, 1/2]; relative error 7e-8.
CHIARO_CLONES
void nearestAngles(const float* px, const float* py, const float* pz, std::size_t count, const float* qx, const float* qy,
                   const float* qz, float* angle) {
  const auto x = *reinterpret_cast<const Float16*>(qx), y = *reinterpret_cast<const Float16*>(qy),
             z = *reinterpret_cast<const Float16*>(qz);
  Float16 least = Float16{} + 2.0f;
  for (std::size_t i = 0; i < count; ++i) {
    const Float16 dx = x - px[i], dy = y - py[i], dz = z - pz[i];
    const Float16 c = dx * dx + dy * dy + dz * dz;
    least = c < least ? c : least;
  }
  constexpr float kSeries[] = {1.0f,          0.166666142f, 0.0750275732f, 0.0440916167f, 0.0358142393f,
                               -0.00702057912f, 0.107400021f, -0.135916271f, 0.123913495f};
  const Float16 s = 0.25f * least;
  Float16 series = Float16{} + kSeries[8];
  for (int k = 7; k >= 0; --k) series = series * s + kSeries[k];
  for (int lane = 0; lane < 16; ++lane) angle[lane] = std::min(std::sqrt(least[lane]) * series[lane], kMaxDistance);
}

/// Repeats the last point up to a multiple of sixteen, so that loops need no remainder.
void pad(AlignedFloats& values, std::size_t count) {
  for (std::size_t i = count; i % 16 != 0; ++i) values[i] = values[count - 1];
}

}  // namespace

void boundaryPoints(const OctahedralGrid& grid, const TexelBits& above, const TexelBits& visible, bool doubleSided,
                    std::vector<glm::vec3>& points) {
  points.clear();
  for (const auto& [a, b] : grid.neighbours) {
    if (texelBit(visible.data(), a) == texelBit(visible.data(), b)) continue;
    if (!doubleSided && !(texelBit(above.data(), a) && texelBit(above.data(), b))) continue;
    points.push_back(glm::normalize(grid.direction(a) + grid.direction(b)));
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
  alignas(64) float qx[16], qy[16], qz[16], angle[16];
  for (const auto& group : groups_) {
    cull(all_, folded(group.center), group.radius, near_);
    for (std::uint32_t k = 0; k < group.tileCount; ++k) {
      const auto tile = tiles_[group.firstTile + k];
      cull(near_, folded(tileBounds_[tile].center), tileBounds_[tile].radius, nearest_);
      const std::size_t first = 16 * std::size_t{tile};
      for (std::size_t lane = 0; lane < 16; ++lane) {
        const auto t = first + lane;
        const float lift = doubleSided || texelBit(above.data(), t) ? 0.0f : 2.0f * cosine[t];
        qx[lane] = grid_.x[t] - lift * normal.x;
        qy[lane] = grid_.y[t] - lift * normal.y;
        qz[lane] = grid_.z[t] - lift * normal.z;
      }
      nearestAngles(nearest_.x.data(), nearest_.y.data(), nearest_.z.data(), nearest_.count, qx, qy, qz, angle);
      for (std::size_t lane = 0; lane < 16; ++lane)
        distances[grid_.rowMajor[first + lane]] = (visible[tile] >> lane & 1) != 0 ? angle[lane] : -angle[lane];
    }
  }
}

}  // namespace chiaro
