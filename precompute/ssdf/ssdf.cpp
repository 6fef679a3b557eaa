#include "precompute/ssdf/ssdf.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "precompute/simd.h"

namespace chiaro {
namespace {

// With so few points left filtering costs more than it saves: those of a group of tiles, those of one tile, those left to compare at corners.
constexpr std::size_t kFew = 16, kFewOfTile = 40, kFewToCompare = 20;

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

/// The index of the first of `count` points that is nearest to `from`; chord2 gets the squared chords to all (rounded up to 16).
std::size_t nearestTo(const AlignedFloats& px, const AlignedFloats& py, const AlignedFloats& pz, std::size_t pointCount, glm::vec3 from,
                      float* chords) {
  std::size_t nearest = 0;
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const float *x = px.data(), *y = py.data(), *z = pz.data();
    float* chord2 = chords;
    const std::size_t count = (pointCount + 15) / 16 * 16;
    const glm::vec3 center = from;
    Vector least = Vector{} + 16.0f, at = {}, index = {};
    for (int lane = 0; lane < kWidth<Vector>; ++lane) index[lane] = static_cast<float>(lane);
    for (std::size_t i = 0; i < count; i += kWidth<Vector>) {
      const Vector dx = loadVector<Vector>(x + i) - center.x, dy = loadVector<Vector>(y + i) - center.y,
                   dz = loadVector<Vector>(z + i) - center.z;
      const Vector c = dx * dx + dy * dy + dz * dz;
      storeVector(chord2 + i, c);
      at = c < least ? index : at;
      least = c < least ? c : least;
      index += static_cast<float>(kWidth<Vector>);
    }
    // Whatever the width: of those as near the first.
    float best = least[0], first = at[0];
    for (int lane = 1; lane < kWidth<Vector>; ++lane) {
      if (least[lane] > best || (!(least[lane] < best) && at[lane] > first)) continue;
      best = least[lane];
      first = at[lane];
    }
    nearest = static_cast<std::size_t>(first);
  });
  return nearest;
}

/// chord2: of each point to four corners, one corner after the other. Its first part becomes 1 for the points that are farther from all
/// corners than one of four rivals (rival[k][c]: of rival k to corner c), else 0.
void markUndominated(float* chord2, std::size_t pointStride, const float (&rivals)[4][4]) {
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const std::size_t stride = pointStride;
    float* chords = chord2;
    float rival[4][4];
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 4; ++c) rival[k][c] = rivals[k][c];
    for (std::size_t i = 0; i < stride; i += kWidth<Vector>) {
      const Vector c0 = loadVector<Vector>(chords + i), c1 = loadVector<Vector>(chords + stride + i),
                   c2 = loadVector<Vector>(chords + 2 * stride + i), c3 = loadVector<Vector>(chords + 3 * stride + i);
      auto keep = (c0 <= rival[0][0]) | (c1 <= rival[0][1]) | (c2 <= rival[0][2]) | (c3 <= rival[0][3]);
      for (int k = 1; k < 4; ++k) keep &= (c0 <= rival[k][0]) | (c1 <= rival[k][1]) | (c2 <= rival[k][2]) | (c3 <= rival[k][3]);
      storeVector(chords + i, keep ? Vector{} : Vector{} + 1.0f);
    }
  });
}

/// What pack() reads or writes: the three coordinates.
template <typename Float>
struct Coordinates {
  Float *x, *y, *z;
};

/// Keeps the points whose value is at most `limit`, in their order; returns how many. `to` may be `from`. All aligned; up to eight
/// floats more are written.
std::size_t pack(Coordinates<const float> source, const float* valueOf, float limit, std::size_t pointCount, Coordinates<float> to) {
  std::size_t keptCount = 0;
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const auto [x, y, z] = source;
    const auto [toX, toY, toZ] = to;
    const float* value = valueOf;
    const Vector most = Vector{} + limit;
    const std::size_t count = pointCount;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; i += 8) {
      unsigned bits = 0;
      for (int k = 0; k < 8; k += kWidth<Vector>) bits |= trueElements<Vector>(loadVector<Vector>(value + i + k) <= most) << k;
      if (count - i < 8) bits &= (1u << (count - i)) - 1u;
      if (bits == 0) continue;
      storePacked<Vector>(x + i, bits, toX + kept);
      storePacked<Vector>(y + i, bits, toY + kept);
      storePacked<Vector>(z + i, bits, toZ + kept);
      kept += static_cast<std::size_t>(__builtin_popcount(bits));
    }
    keptCount = kept;
  });
  return keptCount;
}

/// angle[i] = 2 asin(chord / 2), at most `clamp`, of the nearest of `count` points to each of sixteen directions. The arcsine is its odd
/// polynomial interpolated on chord^2 / 4 in [0, 1/2]; relative error 7e-8.
void nearestAngles(const AlignedFloats& px, const AlignedFloats& py, const AlignedFloats& pz, std::size_t pointCount, const float* qx,
                   const float* qy, const float* qz, float clamp, float* angle) {
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const float *x = px.data(), *y = py.data(), *z = pz.data();
    const std::size_t count = pointCount;
    const Vector most = Vector{} + clamp;
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
      takeSquareRoot<Vector>(least[k]);
      const Vector a = least[k] * series;
      storeVector(angle + k * kWidth<Vector>, a < most ? a : most);
    }
  });
}

/// Directions of one tile, those below the horizon of `normal` mirrored in it; a bit for each of those.
unsigned foldTile(const float* x, const float* y, const float* z, glm::vec3 normal, float* qx, float* qy, float* qz) {
  alignas(64) float cosine[16];
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const glm::vec3 n = normal;
    for (int i = 0; i < 16; i += kWidth<Vector>) {
      const Vector wx = loadVector<Vector>(x + i), wy = loadVector<Vector>(y + i), wz = loadVector<Vector>(z + i);
      const Vector dot = wx * n.x + wy * n.y + wz * n.z;
      const Vector lift = 2.0f * (dot < 0.0f ? dot : Vector{});
      storeVector(cosine + i, dot);
      storeVector(qx + i, wx - lift * n.x);
      storeVector(qy + i, wy - lift * n.y);
      storeVector(qz + i, wz - lift * n.z);
    }
  });
  unsigned below = 0;
  for (unsigned lane = 0; lane < 16; ++lane) below |= static_cast<unsigned>(!(cosine[lane] > 0.0f)) << lane;
  return below;
}

/// OctahedralGrid::texelAt of sixteen directions.
void texelsAt(const OctahedralGrid& grid, const float* x, const float* y, const float* z, std::uint32_t* texels) {
  alignas(64) float u[16], v[16];
  const auto resolution = static_cast<float>(grid.resolution);
  runVectorised([&]<typename Vector>() CHIARO_INLINE {
    const float size = resolution;
    for (int i = 0; i < 16; i += kWidth<Vector>) {
      const Vector wx = loadVector<Vector>(x + i), wy = loadVector<Vector>(y + i), wz = loadVector<Vector>(z + i);
      const Vector ax = wx < 0.0f ? -wx : wx, ay = wy < 0.0f ? -wy : wy, az = wz < 0.0f ? -wz : wz;
      const Vector sum = ax + ay + az, zero = {};
      const Vector borderX = 0.5f * ((wz < 0.0f ? ay : ay + az) / sum), borderY = 0.5f * ((wz < 0.0f ? ax : ax + az) / sum);
      storeVector(u + i, (wx < zero ? borderX : 1.0f - borderX) * size);
      storeVector(v + i, (wy < zero ? borderY : 1.0f - borderY) * size);
    }
  });
  const auto last = static_cast<std::uint32_t>(grid.resolution - 1), tilesPerRow = static_cast<std::uint32_t>(grid.resolution / 4);
  for (int lane = 0; lane < 16; ++lane) {
    const auto column = std::min(static_cast<std::uint32_t>(static_cast<int>(u[lane])), last),
               row = std::min(static_cast<std::uint32_t>(static_cast<int>(v[lane])), last);
    texels[lane] = 16 * (row / 4 * tilesPerRow + column / 4) + 4 * (row % 4) + column % 4;
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
  const auto add = [&](std::size_t a, std::size_t b) { points.push_back(glm::normalize(grid.direction(a) + grid.direction(b))); };
  const auto tilesPerRow = static_cast<std::size_t>(grid.resolution / 4);
  // A tile's bits with those of the tile right of it and of the one under it: lane i beside lane i + 1, above lane i + 4.
  for (std::size_t tile = 0; tile < grid.tileCount; ++tile) {
    const bool lastColumn = (tile + 1) % tilesPerRow == 0, lastRow = tile + tilesPerRow >= grid.tileCount;
    const auto right = lastColumn ? tile : tile + 1, under = lastRow ? tile : tile + tilesPerRow;
    const unsigned bits = visible[tile], rightBits = visible[right], underBits = visible[under];
    if ((bits == 0 || bits == 0xffff) && bits == rightBits && bits == underBits) continue;
    const auto fromRight = [](unsigned here, unsigned there) { return (here >> 1 & 0x7777u) | (there << 3 & 0x8888u); };
    const auto fromUnder = [](unsigned here, unsigned there) { return here >> 4 | (there << 12 & 0xf000u); };
    unsigned across = bits ^ fromRight(bits, rightBits), down = bits ^ fromUnder(bits, underBits);
    if (lastColumn) across &= 0x7777u;
    if (lastRow) down &= 0x0fffu;
    if (!doubleSided) {
      const unsigned high = above[tile];
      across &= high & fromRight(high, above[right]);
      down &= high & fromUnder(high, above[under]);
    }
    for (; across != 0; across &= across - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(across));
      add(16 * tile + lane, lane % 4 == 3 ? 16 * right + lane - 3 : 16 * tile + lane + 1);
    }
    for (; down != 0; down &= down - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(down));
      add(16 * tile + lane, lane >= 12 ? 16 * under + lane - 12 : 16 * tile + lane + 4);
    }
  }
  for (const auto& [a, b] : grid.seam) {
    if (texelBit(visible.data(), a) == texelBit(visible.data(), b)) continue;
    if (!doubleSided && !(texelBit(above.data(), a) && texelBit(above.data(), b))) continue;
    add(a, b);
  }
}

void SsdfTransform::Points::reserve(std::size_t points) {
  if (points <= capacity) return;
  capacity = (points + points / 2 + 31) / 16 * 16;
  x = AlignedFloats(capacity);
  y = AlignedFloats(capacity);
  z = AlignedFloats(capacity);
}

/// What the transform reads of one vertex, and where it writes.
struct SsdfTransform::Signal {
  glm::vec3 normal;
  bool doubleSided;
  const TexelBits& above;
  const TexelBits& visible;
  float* distances;

  glm::vec3 folded(glm::vec3 w) const { return doubleSided ? w : fold(w, normal); }
};

SsdfTransform::SsdfTransform(const OctahedralGrid& sampling, const OctahedralGrid& storage, float clamp)
    : sampling_(sampling),
      storage_(storage),
      clamp_(clamp),
      clampChord_(2.0f * std::sin(0.5f * clamp)),
      // The longest texel is 4.9 / resolution; a storage texel is the sampling one that holds it or touches its centre.
      slack_(2.0f * 4.9f / static_cast<float>(sampling.resolution)) {
  // Squares (column, row, side) of tiles. A quarter of the map holds two halves of faces, split along its diagonal; so does a square on that
  // diagonal, and another square lies within one face.
  const int tilesPerRow = storage.resolution / 4, half = tilesPerRow / 2;
  convex_ = tilesPerRow % 2 == 0;
  std::vector<std::array<int, 3>> roots;
  if (convex_) {
    for (int q = 0; q < 4; ++q) roots.push_back({q % 2 * half, q / 2 * half, half});
  } else {  // the axes cut tiles
    for (int t = 0; t < tilesPerRow * tilesPerRow; ++t) roots.push_back({t % tilesPerRow, t / tilesPerRow, 1});
  }
  rootCount_ = static_cast<std::uint32_t>(roots.size());
  std::vector<std::array<int, 3>> squares = roots;
  addGroups(squares);
  std::size_t deepest = 1;
  for (std::size_t g = 0; g < groups_.size(); ++g) {  // grows as it goes
    const auto [column, row, side] = squares[g];
    if (side == 1) continue;
    const int parts = side % 2 == 0 ? 2 : side;
    std::vector<std::array<int, 3>> children;
    for (int k = 0; k < parts * parts; ++k) children.push_back({column + k % parts * (side / parts), row + k / parts * (side / parts), side / parts});
    groups_[g].firstChild = static_cast<std::uint32_t>(groups_.size());
    groups_[g].childCount = static_cast<std::uint32_t>(children.size());
    squares.insert(squares.end(), children.begin(), children.end());
    addGroups(children);
    if (column == 0 && row == 0) ++deepest;
  }
  kept_.resize(deepest);
}

void SsdfTransform::addGroups(const std::vector<std::array<int, 3>>& squares) {
  const auto tilesPerRow = static_cast<std::size_t>(storage_.resolution / 4);
  for (const auto& square : squares) {
    const auto column = static_cast<std::size_t>(square[0]), row = static_cast<std::size_t>(square[1]), side = static_cast<std::size_t>(square[2]);
    auto& group = groups_.emplace_back();
    group.firstTile = static_cast<std::uint32_t>(tiles_.size());
    group.tileCount = static_cast<std::uint32_t>(side * side);
    glm::dvec3 sum(0.0);
    for (std::size_t j = row; j < row + side; ++j)
      for (std::size_t i = column; i < column + side; ++i) {
        tiles_.push_back({static_cast<std::uint32_t>(j * tilesPerRow + i), storage_.rowMajor[16 * (j * tilesPerRow + i)]});
        for (std::size_t lane = 0; lane < 16; ++lane) sum += glm::dvec3(storage_.direction(16 * std::size_t{tiles_.back().number} + lane));
      }
    group.center = glm::vec3(sum / (16.0 * static_cast<double>(side * side)));
    for (auto t = group.firstTile; t < tiles_.size(); ++t)
      for (std::size_t lane = 0; lane < 16; ++lane)
        group.radius = std::max(group.radius, glm::distance(storage_.direction(16 * std::size_t{tiles_[t].number} + lane), group.center));
    const auto first = row * tilesPerRow + column, last = first + (side - 1) * tilesPerRow;
    corners_.push_back({storage_.direction(16 * first), storage_.direction(16 * (first + side - 1) + 3), storage_.direction(16 * last + 12),
                        storage_.direction(16 * (last + side - 1) + 15)});
  }
}

float SsdfTransform::keepNear(const Points& from, glm::vec3 center, float radius, float reach, Points& to) {
  to.reserve(from.count + 16);
  to.count = 0;
  const float least = std::sqrt(chordsTo(from.x, from.y, from.z, from.count, center, chord2_));
  // A little more than the inequality asks for, to be safe from rounding.
  const float most = std::min(least + 2.0f * radius, reach) * 1.00001f + 1e-6f;
  const float most2 = most * most;
  const auto kept = pack({from.x.data(), from.y.data(), from.z.data()}, chord2_.data(), most2, from.count, {to.x.data(), to.y.data(), to.z.data()});
  to.count = kept;
  if (kept == 0) return least;
  pad(to.x, kept);
  pad(to.y, kept);
  pad(to.z, kept);
  return least;
}

void SsdfTransform::keepUndominated(Points& points, const glm::vec3* corners) {
  const auto stride = (points.count + 15) / 16 * 16;
  // The rivals: the point nearest to each corner.
  float rival[4][4];
  for (std::size_t c = 0; c < 4; ++c) {
    const auto nearest = nearestTo(points.x, points.y, points.z, points.count, corners[c], chord2_.data() + c * stride);
    for (std::size_t d = 0; d < 4; ++d) {
      const glm::vec3 p(points.x[nearest], points.y[nearest], points.z[nearest]);
      const auto to = p - corners[d];
      // A hair farther, so that no rounding drops what is as near.
      rival[c][d] = (to.x * to.x + to.y * to.y + to.z * to.z) * 1.000002f;
    }
  }
  markUndominated(chord2_.data(), stride, rival);
  const auto kept = pack({points.x.data(), points.y.data(), points.z.data()}, chord2_.data(), 0.5f, points.count,
                         {points.x.data(), points.y.data(), points.z.data()});
  points.count = kept;
  pad(points.x, kept);
  pad(points.y, kept);
  pad(points.z, kept);
}

bool SsdfTransform::seesIn(const Group& group, const Signal& signal) const {
  const auto texel = 16 * std::size_t{tiles_[group.firstTile].number};
  std::size_t source = texel;
  if (!signal.doubleSided && !texelBit(signal.above.data(), texel))
    source = nearestAbove(storage_, signal.above, fold(storage_.direction(texel), signal.normal));
  return texelBit(signal.visible.data(), source);
}

void SsdfTransform::fill(const Group& group, const Signal& signal) const {
  const float value = seesIn(group, signal) ? clamp_ : -clamp_;
  for (auto t = group.firstTile; t < group.firstTile + group.tileCount; ++t)
    for (int row = 0; row < 4; ++row) std::fill_n(signal.distances + tiles_[t].rowMajor + row * storage_.resolution, 4, value);
}

void SsdfTransform::visitTile(const Group& group, const Points& points, bool folded, Kind kind, const Signal& signal) const {
  const auto [number, rowMajor] = tiles_[group.firstTile];
  const std::size_t tile = number, first = 16 * tile;
  const float *qx = storage_.x.data() + first, *qy = storage_.y.data() + first, *qz = storage_.z.data() + first;
  alignas(64) float angle[16], foldedX[16], foldedY[16], foldedZ[16];
  unsigned below = 0;
  if (folded) {
    below = foldTile(qx, qy, qz, signal.normal, foldedX, foldedY, foldedZ);
    qx = foldedX;
    qy = foldedY;
    qz = foldedZ;
  }
  nearestAngles(points.x, points.y, points.z, points.count, qx, qy, qz, clamp_, angle);
  unsigned seen = signal.visible[tile];
  if (kind != Kind::mixed) {
    seen = kind == Kind::seen ? 0xffffu : 0u;
  } else if (below != 0) {
    const auto mirrored = [&](unsigned lane) {
      return texelBit(signal.visible.data(), nearestAbove(storage_, signal.above, {qx[lane], qy[lane], qz[lane]}));
    };
    const float nearest = *std::min_element(angle, angle + 16);
    if (below == 0xffffu && nearest > 2.0f * group.radius + slack_) {
      seen = mirrored(0) ? 0xffffu : 0u;
    } else {
      std::uint32_t home[16];
      texelsAt(storage_, qx, qy, qz, home);
      for (unsigned left = below; left != 0; left &= left - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        const bool sees = texelBit(signal.above.data(), home[lane]) ? texelBit(signal.visible.data(), home[lane]) : mirrored(lane);
        seen = sees ? seen | 1u << lane : seen & ~(1u << lane);
      }
    }
  }
  for (unsigned lane = 0; lane < 16; ++lane)
    angle[lane] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(angle[lane]) | (~seen >> lane & 1u) << 31);
  for (int row = 0; row < 4; ++row) std::copy_n(angle + 4 * row, 4, signal.distances + rowMajor + row * storage_.resolution);
}

void SsdfTransform::visit(const Group& group, const Points& from, std::size_t depth, Kind kind, const Signal& signal) {
  const float height = signal.doubleSided ? 2.0f : glm::dot(group.center, signal.normal);
  const bool folded = height <= group.radius + 1e-5f, straddles = folded && height >= -group.radius - 1e-5f;
  const Points* points = &from;
  if (from.count > (group.childCount == 0 ? kFewOfTile : kFew) && group.radius < 0.7f) {
    auto& kept = kept_[depth];
    const float reach = clampChord_ + group.radius;
    const float least = keepNear(from, signal.folded(group.center), group.radius, reach, kept);
    // What is below the horizon has to ask its mirror images, so that it pays to ask once for all of a group.
    if (kind == Kind::mixed && folded && !straddles && least > 2.0f * group.radius + slack_)
      kind = seesIn(group, signal) ? Kind::seen : Kind::hidden;
    if (kept.count == 0) {
      if (clampChord_ > slack_) {
        fill(group, signal);
        return;
      }
    } else {
      points = &kept;
      if (group.childCount != 0 && kept.count > kFewToCompare && convex_ && !straddles) {
        auto corners = corners_[static_cast<std::size_t>(&group - groups_.data())];
        for (auto& corner : corners) corner = signal.folded(corner);
        keepUndominated(kept, corners.data());
      }
    }
  }
  if (group.childCount == 0) {
    visitTile(group, *points, folded, kind, signal);
    return;
  }
  for (auto child = group.firstChild; child < group.firstChild + group.childCount; ++child) visit(groups_[child], *points, depth + 1, kind, signal);
}

void SsdfTransform::operator()(glm::vec3 normal, bool doubleSided, const TexelBits& above, const TexelBits& visible,
                               const TexelBits& storedAbove, const TexelBits& stored, float* distances) {
  const Signal signal{normal, doubleSided, storedAbove, stored, distances};
  boundaryPoints(sampling_, above, visible, doubleSided, boundary_);
  if (boundary_.empty()) {
    // The root groups together; a sign of its own for each costs nothing.
    for (std::uint32_t g = 0; g < rootCount_; ++g) fill(groups_[g], signal);
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
  if (chordCapacity_ < 4 * all_.capacity) chord2_ = AlignedFloats(chordCapacity_ = 4 * all_.capacity);
  for (std::uint32_t g = 0; g < rootCount_; ++g) visit(groups_[g], all_, 0, Kind::mixed, signal);
}

}  // namespace chiaro
