#include "precompute/ssdf/ssdf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "precompute/simd.h"

namespace chiaro {
namespace {

/// With so few points left filtering costs more than it saves.
constexpr std::size_t kFew = 16;

/// Lists of points are repeated up to a multiple of this: the widest vector.
constexpr std::size_t kPadding = 16;

/// The longest way between two texels that touch is this / resolution, a chord.
constexpr float kLongestStep = 4.9f;

glm::vec3 fold(glm::vec3 w, glm::vec3 n) {
  const float cosine = glm::dot(w, n);
  return cosine < 0.0f ? w - 2.0f * cosine * n : w;
}

/// Three coordinates.
template <typename Float>
struct Coordinates {
  Float *x, *y, *z;
};

/// What is left of some points in a square.
struct Topmost {
  std::size_t kept;
  float value;  ///< of the topmost plane above the centre
};

/// Keeps the points whose plane is above the topmost one at the centre of a square somewhere within `half` to each side of it; in their order.
/// All aligned, with kPadding floats to spare; padded.
Topmost keepAbove(Coordinates<const float> source, std::size_t pointCount, glm::vec3 squareCenter, float reach, float* values,
                  Coordinates<float> to) {
  Topmost result{};
  runInWidest([&]<typename Vector>() CHIARO_INLINE {
    const auto [x, y, z] = source;
    const auto [toX, toY, toZ] = to;
    float* value = values;
    const glm::vec3 center = squareCenter;
    const std::size_t count = pointCount;
    Vector most = Vector{} - 16.0f, at = {}, index = {};
    for (int lane = 0; lane < kWidth<Vector>; ++lane) index[lane] = static_cast<float>(lane);
    for (std::size_t i = 0; i < count; i += kWidth<Vector>) {
      const Vector v = loadVector<Vector>(x + i) * center.x + loadVector<Vector>(y + i) * center.y + loadVector<Vector>(z + i) * center.z;
      storeVector(value + i, v);
      at = v > most ? index : at;
      most = v > most ? v : most;
      index += static_cast<float>(kWidth<Vector>);
    }
    // Whatever the width: of those as high the first.
    const float best = -leastElement<Vector>(-most);
    alignas(64) float places[kWidth<Vector>];
    storeVector(places, at);
    unsigned highest = elementsAtLeast<Vector>(most, Vector{} + best);
    auto rival = static_cast<std::size_t>(places[__builtin_ctz(highest)]);
    while ((highest &= highest - 1) != 0) rival = std::min(rival, static_cast<std::size_t>(places[__builtin_ctz(highest)]));
    const float half = reach, rivalU = x[rival] - z[rival], rivalV = y[rival] - z[rival];
    // A hair more, so that no rounding drops one that is as near.
    const Vector top = Vector{} + (best - 1e-6f);
    std::size_t kept = 0;
    constexpr int kAtOnce = kPackedAtOnce<Vector>;
    for (std::size_t i = 0; i < count; i += kAtOnce) {
      unsigned bits = 0;
      for (int k = 0; k < kAtOnce; k += kWidth<Vector>) {
        const Vector pz = loadVector<Vector>(z + i + k);
        const Vector u = loadVector<Vector>(x + i + k) - pz - rivalU, v = loadVector<Vector>(y + i + k) - pz - rivalV;
        const Vector rise = half * ((u < -u ? -u : u) + (v < -v ? -v : v));
        bits |= elementsAtLeast<Vector>(loadVector<Vector>(value + i + k) + rise, top) << k;
      }
      if (count - i < kAtOnce) bits &= (1u << (count - i)) - 1u;
      storePacked<Vector>(x + i, bits, toX + kept);
      storePacked<Vector>(y + i, bits, toY + kept);
      storePacked<Vector>(z + i, bits, toZ + kept);
      kept += static_cast<std::size_t>(__builtin_popcount(bits));
    }
    for (std::size_t i = kept; i % kPadding != 0; ++i) {
      toX[i] = toX[kept - 1];
      toY[i] = toY[kept - 1];
      toZ[i] = toZ[kept - 1];
    }
    result = {kept, best};
  });
  return result;
}

/// What nearestInLeaf() knows of a leaf: FaceTree's, and one step along the map's columns and rows in U and V.
struct LeafPlane {
  glm::vec3 reference{0.0f}, center{0.0f};
  float length = 0.0f, stepU = 0.0f, stepV = 0.0f;
  const float *excess = nullptr, *scale = nullptr;
  float precise = 0.0f;  ///< squared chord; nearer points are compared one by one
};

/// lowest[8 r + c] = the least of some planes at row r and column c of a leaf, by their values at its centre and their slopes. Goes row by row
/// up and down from the centre; both at once in a vector of sixteen.
template <typename Vector>
[[gnu::always_inline]] inline void lowestPlanes(const float* middles, const float* alongU, const float* alongV, std::size_t count, float* lowest) {
  constexpr int kSide = FaceTree::kSide, kRows = kSide / 2, kColumns = std::min(kWidth<Vector>, kSide), kWays = kWidth<Vector> > kSide ? 1 : 2;
  Vector way = {};
  for (int lane = 0; lane < kWidth<Vector>; ++lane) way[lane] = lane < kSide ? 1.0f : -1.0f;
  for (int first = 0; first < kSide; first += kColumns) {
    Vector column = {}, least[kWays][kRows];
    for (int lane = 0; lane < kWidth<Vector>; ++lane) column[lane] = static_cast<float>(first + lane % kColumns) - 3.5f;
    for (auto& ofWay : least)
      for (auto& row : ofWay) row = Vector{} + 16.0f;
    for (std::size_t i = 0; i < count; ++i) {
      const Vector middle = middles[i] + alongU[i] * column;
      const float step = alongV[i], half = 0.5f * step;
#pragma GCC unroll 2
      for (int w = 0; w < kWays; ++w) {
        Vector value;
        if constexpr (kWays == 1)
          value = middle + half * way;
        else
          value = w == 0 ? middle + half : middle - half;
#pragma GCC unroll 4
        for (int r = 0; r < kRows; ++r) {
          least[w][r] = value < least[w][r] ? value : least[w][r];
          if constexpr (kWays == 1)
            value += step * way;
          else
            value = w == 0 ? value + step : value - step;
        }
      }
    }
    for (int r = 0; r < kRows; ++r) {
      float *up = lowest + kSide * (kRows + r) + first, *down = lowest + kSide * (kRows - 1 - r) + first;
      std::memcpy(up, &least[0][r], kColumns * sizeof(float));
      std::memcpy(down, reinterpret_cast<const char*>(&least[kWays - 1][r]) + (kWays == 1 ? kColumns * sizeof(float) : 0), kColumns * sizeof(float));
    }
  }
}

/// Squared chords from the texels of a leaf to the nearest of some points (padded), and the least of them; scratch: three times as many floats
/// as padded points, aligned.
float nearestInLeaf(Coordinates<const float> points, std::size_t pointCount, const LeafPlane& of, float* scratch, float* chord2) {
  float nearest = 0.0f;
  runInWidest([&]<typename Vector>() CHIARO_INLINE {
    const auto [x, y, z] = points;
    const std::size_t count = pointCount, padded = (pointCount + kPadding - 1) / kPadding * kPadding;
    const LeafPlane leaf = of;
    float *middle = scratch, *alongU = scratch + padded, *alongV = scratch + 2 * padded, *result = chord2;
    // A plane relative to the reference: its value at the centre and its slopes.
    for (std::size_t i = 0; i < count; i += kWidth<Vector>) {
      const Vector dx = leaf.reference.x - loadVector<Vector>(x + i), dy = leaf.reference.y - loadVector<Vector>(y + i),
                   dz = leaf.reference.z - loadVector<Vector>(z + i);
      storeVector(middle + i, 0.5f * leaf.length * (dx * dx + dy * dy + dz * dz));
      storeVector(alongU + i, leaf.stepU * (dx - dz));
      storeVector(alongV + i, leaf.stepV * (dy - dz));
    }
    lowestPlanes<Vector>(middle, alongU, alongV, count, result);
    Vector least = Vector{} + 16.0f;
    for (std::size_t t = 0; t < FaceTree::kTexels; t += kWidth<Vector>) {
      const Vector scale = loadVector<Vector>(leaf.scale + t);
      Vector c = loadVector<Vector>(leaf.excess + t) + scale * loadVector<Vector>(result + t);
      if (elementsAtLeast<Vector>(c, Vector{} + leaf.precise) != (1u << kWidth<Vector>) - 1u) {
        // The sum cancels: by the definition.
        Vector column = {}, row = {};
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(kWidth<Vector>); ++lane) {
          column[lane] = static_cast<float>((t + lane) % FaceTree::kSide) - 3.5f;
          row[lane] = static_cast<float>((t + lane) / FaceTree::kSide) - 3.5f;
        }
        const Vector right = leaf.stepU * column, up = leaf.stepV * row;
        const Vector qx = 0.5f * scale * (leaf.center.x + right), qy = 0.5f * scale * (leaf.center.y + up),
                     qz = 0.5f * scale * (leaf.center.z - right - up);
        Vector direct = Vector{} + 16.0f;
        for (std::size_t i = 0; i < count; ++i) {
          const Vector dx = qx - x[i], dy = qy - y[i], dz = qz - z[i];
          const Vector d = dx * dx + dy * dy + dz * dz;
          direct = d < direct ? d : direct;
        }
        c = c < leaf.precise ? direct : c;  // one by one, so that the width of vectors does not show
      }
      least = c < least ? c : least;
      storeVector(result + t, c);
    }
    nearest = leastElement<Vector>(least);
  });
  return nearest;
}

/// angle[i] = 2 asin(chord / 2), at most `clamp`, negative where bit i % 8 of seen[i / 8] is 0, of a leaf's texels. The arcsine is its odd
/// polynomial interpolated on chord^2 / 4 in [0, 1/2]; relative error 7e-8.
void signedAngles(const float* chord2, const std::uint8_t* seenRows, float clamp, float* angles) {
  runInWidest([&]<typename Vector>() CHIARO_INLINE {
    using Int = decltype(Vector{} < Vector{});
    const float* chords = chord2;
    const std::uint8_t* seen = seenRows;
    float* angle = angles;
    const Vector most = Vector{} + clamp, farthest = Vector{} + 2.0f;
    constexpr float kSeries[] = {1.0f,          0.166666142f, 0.0750275732f, 0.0440916167f, 0.0358142393f,
                                 -0.00702057912f, 0.107400021f, -0.135916271f, 0.123913495f};
    Int bit = {};
    for (int l = 0; l < kWidth<Vector>; ++l) bit[l] = 1 << l;
    for (int i = 0; i < static_cast<int>(FaceTree::kTexels); i += kWidth<Vector>) {
      Vector c = loadVector<Vector>(chords + i);
      c = c < farthest ? c : farthest;
      const Vector s = 0.25f * c;
      Vector series = Vector{} + kSeries[8];
      for (int j = 7; j >= 0; --j) series = series * s + kSeries[j];
      takeSquareRoot<Vector>(c);
      Vector a = c * series;
      a = a < most ? a : most;
      int rows = seen[i / 8] >> i % 8;
      if constexpr (kWidth<Vector> > 8) rows |= seen[i / 8 + 1] << 8;
      const Int hidden = ((Int{} + rows) & bit) == 0;
      storeVector(angle + i, __builtin_bit_cast(Vector, __builtin_bit_cast(Int, a) | (hidden & static_cast<int>(0x80000000u))));
    }
  });
}

/// Directions of one tile, those below the horizon of `normal` mirrored in it.
void foldTile(const float* x, const float* y, const float* z, glm::vec3 normal, float* qx, float* qy, float* qz) {
  runInWidest([&]<typename Vector>() CHIARO_INLINE {
    const glm::vec3 n = normal;
    for (int i = 0; i < 16; i += kWidth<Vector>) {
      const Vector wx = loadVector<Vector>(x + i), wy = loadVector<Vector>(y + i), wz = loadVector<Vector>(z + i);
      const Vector dot = wx * n.x + wy * n.y + wz * n.z;
      const Vector lift = 2.0f * (dot < 0.0f ? dot : Vector{});
      storeVector(qx + i, wx - lift * n.x);
      storeVector(qy + i, wy - lift * n.y);
      storeVector(qz + i, wz - lift * n.z);
    }
  });
}

/// Of a tile in a leaf; chord2: its first texel's.
float leastInTile(const float* chord2) {
  Float4 least = loadVector<Float4>(chord2);
  for (int row = 1; row < 4; ++row) {
    const Float4 c = loadVector<Float4>(chord2 + FaceTree::kSide * row);
    least = c < least ? c : least;
  }
  return leastElement(least);
}

/// OctahedralGrid::texelAt of sixteen directions.
void texelsAt(const OctahedralGrid& grid, const float* x, const float* y, const float* z, std::uint32_t* texels) {
  const int resolution = grid.resolution;
  runInWidest([&]<typename Vector>() CHIARO_INLINE {
    using Int = decltype(Vector{} < Vector{});
    const float size = static_cast<float>(resolution);
    const int last = resolution - 1, tilesPerRow = resolution / 4;
    for (int i = 0; i < 16; i += kWidth<Vector>) {
      const Vector wx = loadVector<Vector>(x + i), wy = loadVector<Vector>(y + i), wz = loadVector<Vector>(z + i);
      const Vector ax = wx < 0.0f ? -wx : wx, ay = wy < 0.0f ? -wy : wy, az = wz < 0.0f ? -wz : wz;
      const Vector sum = ax + ay + az, zero = {};
      const Vector borderX = 0.5f * ((wz < 0.0f ? ay : ay + az) / sum), borderY = 0.5f * ((wz < 0.0f ? ax : ax + az) / sum);
      Int column = __builtin_convertvector((wx < zero ? borderX : 1.0f - borderX) * size, Int),
          row = __builtin_convertvector((wy < zero ? borderY : 1.0f - borderY) * size, Int);
      column = column > last ? Int{} + last : column;
      row = row > last ? Int{} + last : row;
      const Int texel = 16 * ((row >> 2) * tilesPerRow + (column >> 2)) + 4 * (row & 3) + (column & 3);
      std::memcpy(texels + i, &texel, sizeof(texel));
    }
  });
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
  capacity = (points + points / 2) / kPadding * kPadding + kPadding;
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
};

SsdfTransform::SsdfTransform(const OctahedralGrid& sampling, const OctahedralGrid& storage, float clamp)
    : sampling_(sampling),
      storage_(storage),
      tree_(storage.resolution),
      clamp_(clamp),
      clampChord_(2.0f * std::sin(0.5f * clamp)),
      // A storage texel is the sampling one that holds it or touches its centre.
      slack_(2.0f * kLongestStep / static_cast<float>(sampling.resolution)),
      clear_(kLongestStep / static_cast<float>(storage.resolution) + slack_) {
  std::size_t depth = 1;
  for (int side = storage.resolution; side > FaceTree::kSide; side /= 2) ++depth;
  kept_.resize(depth + 1);
}

bool SsdfTransform::sees(std::size_t texel, const Signal& signal) const {
  if (!signal.doubleSided && !texelBit(signal.above.data(), texel))
    texel = nearestAbove(storage_, signal.above, fold(storage_.direction(texel), signal.normal));
  return texelBit(signal.visible.data(), texel);
}

unsigned SsdfTransform::seenInTile(std::size_t tile, bool clear, const Signal& signal) const {
  unsigned seen = signal.visible[tile];
  const unsigned below = signal.doubleSided ? 0u : static_cast<std::uint16_t>(~signal.above[tile]);
  if (below == 0) return seen;
  const std::size_t first = 16 * tile;
  if (clear) {
    const auto any = static_cast<std::size_t>(std::countr_one(below) % 16);  // one that is above, if there is
    return sees(first + any, signal) ? 0xffffu : 0u;
  }
  alignas(64) float x[16], y[16], z[16];
  foldTile(storage_.x.data() + first, storage_.y.data() + first, storage_.z.data() + first, signal.normal, x, y, z);
  std::uint32_t home[16];
  texelsAt(storage_, x, y, z, home);
  for (unsigned left = below; left != 0; left &= left - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(left));
    std::size_t source = home[lane];
    if (!texelBit(signal.above.data(), source)) source = nearestAbove(storage_, signal.above, {x[lane], y[lane], z[lane]});
    seen = texelBit(signal.visible.data(), source) ? seen | 1u << lane : seen & ~(1u << lane);
  }
  return seen;
}

void SsdfTransform::seenInLeaf(const FaceTree::Leaf& leaf, const float* chord2, const Signal& signal, std::uint8_t* seen) const {
  if (storage_.resolution % (2 * FaceTree::kSide) != 0) {  // leaves do not begin where tiles do, or reach across the axes
    for (int y = 0; y < FaceTree::kSide; ++y) {
      seen[y] = 0;
      for (unsigned x = leaf.from[static_cast<std::size_t>(y)]; x < leaf.to[static_cast<std::size_t>(y)]; ++x) {
        const int at = (leaf.row + y) * storage_.resolution + leaf.column + static_cast<int>(x);
        seen[y] = static_cast<std::uint8_t>(seen[y] | (sees(storage_.tiled[static_cast<std::size_t>(at)], signal) ? 1u << x : 0u));
      }
    }
    return;
  }
  bool clear[4];
  unsigned bitsOf[4];
  for (unsigned k = 0; k < 4; ++k) {
    const int x = k % 2 * 4, y = static_cast<int>(k) / 2 * 4;
    const auto tile = static_cast<std::size_t>((leaf.row + y) / 4 * (storage_.resolution / 4) + (leaf.column + x) / 4);
    const float* chords = chord2 + FaceTree::kSide * y + x;
    clear[k] = leastInTile(chords) > clear_ * clear_;
    // Two that touch see the same where both are clear.
    unsigned& bits = bitsOf[k];
    if (clear[k] && k % 2 != 0 && clear[k ^ 1u])
      bits = bitsOf[k ^ 1u];
    else if (clear[k] && k >= 2 && clear[k ^ 2u])
      bits = bitsOf[k ^ 2u];
    else
      bits = seenInTile(tile, clear[k], signal);
    for (int r = 0; r < 4; ++r) seen[y + r] = static_cast<std::uint8_t>((x == 0 ? 0u : seen[y + r]) | (bits >> 4 * r & 15u) << x);
  }
}

void SsdfTransform::visitLeaf(const FaceTree::Square& square, const OctahedralFace& face, const Points& points, Kind kind,
                              const Signal& signal) {
  const auto& leaf = tree_.leaves[square.leaf];
  const float step = 2.0f / static_cast<float>(storage_.resolution), radius = square.radius;
  // Of the terms that cancel the largest is radius^2, and lengths of unit vectors are off by 6e-8: so the error of the chord stays below 2e-6.
  const float precise = std::max(0.25f * radius * radius, 0.03f * radius);
  const LeafPlane plane{.reference = leaf.reference,
                        .center = square.center,
                        .length = square.length,
                        .stepU = face.signU * step,
                        .stepV = face.signV * step,
                        .excess = tree_.excess.data() + FaceTree::kTexels * square.leaf,
                        .scale = tree_.scale.data() + FaceTree::kTexels * square.leaf,
                        .precise = precise * precise};
  alignas(64) float chord2[FaceTree::kTexels], angle[FaceTree::kTexels];
  std::uint8_t seen[FaceTree::kSide];
  const float nearest = nearestInLeaf({points.x.data(), points.y.data(), points.z.data()}, points.count, plane, scratch_.data(), chord2);
  if (kind == Kind::mixed && square.whole && nearest > clear_ * clear_)
    kind = sees(storage_.tiled[static_cast<std::size_t>(leaf.row * storage_.resolution + leaf.column)], signal) ? Kind::seen : Kind::hidden;
  if (kind == Kind::mixed)
    seenInLeaf(leaf, chord2, signal, seen);
  else
    std::fill_n(seen, FaceTree::kSide, static_cast<std::uint8_t>(kind == Kind::seen ? 0xff : 0));
  signedAngles(chord2, seen, clamp_, angle);
  for (int y = 0; y < FaceTree::kSide; ++y) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(leaf.row + y) * storage_.resolution + leaf.column;
    if (square.whole) {
      std::memcpy(signal.distances + row, angle + FaceTree::kSide * y, FaceTree::kSide * sizeof(float));
      continue;
    }
    const std::size_t from = leaf.from[static_cast<std::size_t>(y)], to = leaf.to[static_cast<std::size_t>(y)];
    // A leaf may begin outside the map, where it has no texels.
    if (from != to) std::copy_n(angle + FaceTree::kSide * y + from, to - from, signal.distances + row + static_cast<std::ptrdiff_t>(from));
  }
}

void SsdfTransform::visit(const FaceTree::Square& square, const OctahedralFace& face, const Points& from, std::size_t depth, Kind kind,
                          const Signal& signal) {
  const Points* points = &from;
  if (from.count > kFew || (square.whole && kind == Kind::mixed && square.childCount != 0)) {
    auto& kept = kept_[depth];
    kept.reserve(from.count + kPadding);
    const auto top = keepAbove({from.x.data(), from.y.data(), from.z.data()}, from.count, square.center, square.half, scratch_.data(),
                               {kept.x.data(), kept.y.data(), kept.z.data()});
    kept.count = top.kept;
    points = &kept;
    if (square.whole) {
      const float nearest2 = 2.0f - 2.0f * top.value / square.length - 1e-5f;
      const auto isBeyond = [&](float chord) { return nearest2 > (square.radius + chord) * (square.radius + chord); };
      // What is below the horizon has to ask its mirror images, so that it pays to ask once for all of a square.
      if (kind == Kind::mixed && isBeyond(slack_))
        kind = sees(storage_.tiled[static_cast<std::size_t>(square.row * storage_.resolution + square.column)], signal) ? Kind::seen : Kind::hidden;
      if (kind != Kind::mixed && isBeyond(clampChord_)) {
        float* first = signal.distances + static_cast<std::ptrdiff_t>(square.row) * storage_.resolution + square.column;
        for (int y = 0; y < square.side; ++y)
          std::fill_n(first + static_cast<std::ptrdiff_t>(y) * storage_.resolution, square.side, kind == Kind::seen ? clamp_ : -clamp_);
        return;
      }
    }
  }
  if (square.childCount == 0) {
    visitLeaf(square, face, *points, kind, signal);
    return;
  }
  for (auto child = square.firstChild; child < square.firstChild + square.childCount; ++child)
    visit(tree_.squares[child], face, *points, depth + 1, kind, signal);
}

void SsdfTransform::operator()(glm::vec3 normal, bool doubleSided, const TexelBits& above, const TexelBits& visible,
                               const TexelBits& storedAbove, const TexelBits& stored, float* distances) {
  const Signal signal{normal, doubleSided, storedAbove, stored, distances};
  boundaryPoints(sampling_, above, visible, doubleSided, boundary_);
  if (boundary_.empty()) {
    std::fill_n(distances, storage_.texelCount, sees(0, signal) ? clamp_ : -clamp_);
    return;
  }
  // A direction below the horizon is as far from a point as its mirror image is from that point's, and each is nearer to those on its side.
  const auto count = boundary_.size();
  for (std::size_t i = 0; !doubleSided && i < count; ++i) boundary_.push_back(glm::normalize(boundary_[i] - 2.0f * glm::dot(boundary_[i], normal) * normal));
  all_.reserve(boundary_.size());
  if (scratchCapacity_ < 3 * all_.capacity) scratch_ = AlignedFloats(scratchCapacity_ = 3 * all_.capacity);
  all_.count = boundary_.size();
  boundary_.resize((boundary_.size() + kPadding - 1) / kPadding * kPadding, boundary_.back());
  for (std::size_t f = 0; f < tree_.faces.size(); ++f) {
    const OctahedralFace face = tree_.faces[f];
    float *x = all_.x.data(), *y = all_.y.data(), *z = all_.z.data();
    for (const auto& point : boundary_) {
      const auto p = face.toFrame(point);
      *x++ = p.x;
      *y++ = p.y;
      *z++ = p.z;
    }
    visit(tree_.squares[f], face, all_, 0, Kind::mixed, signal);
  }
}

}  // namespace chiaro
