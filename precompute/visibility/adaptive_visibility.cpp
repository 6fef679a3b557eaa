#include "precompute/visibility/adaptive_visibility.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

/// So many directions of one 4x4 tile are a packet of their own; fewer share one with those of other tiles.
constexpr int kOwnPacket = 12;

constexpr Board bitOf(std::size_t texel) { return Board{1} << texel % 64; }

std::array<Board, 4> everyQuarter(Board b) { return {b, b, b, b}; }

/// Tile `k` of a board as a board of the map twice as fine; by quarter of each texel.
Board doubledQuarters(const std::array<Board, 4>& quarters, std::size_t k) {
  constexpr Board kQuarter[4] = {0x0505050505050505u, 0x0a0a0a0a0a0a0a0au, 0x5050505050505050u, 0xa0a0a0a0a0a0a0a0u};
  const auto tile = [&](std::size_t corner) { return static_cast<std::uint16_t>(quarters[corner] >> 16 * k); };
  if (tile(0) == tile(1) && tile(0) == tile(2) && tile(0) == tile(3)) return doubled(tile(0));
  Board result = 0;
  for (std::size_t corner = 0; corner < 4; ++corner) result |= doubled(tile(corner)) & kQuarter[corner];
  return result;
}

/// Of the four texels `steps` levels finer that meet at the centre of `texel`: the last is right of it and below, which is
/// what OctahedralGrid::texelAt takes the centre for. Texels: 64 board + bit.
std::size_t besideCentre(std::size_t texel, std::size_t steps, std::size_t corner) {
  const auto dx = corner % 2, dy = corner / 2;
  const auto child = [](std::size_t of, std::size_t x, std::size_t y) {
    const auto lane = of % 16, column = 2 * (lane % 4) + x, row = 2 * (lane / 4) + y;
    return 64 * (of / 16) + 32 * (row / 4) + 16 * (column / 4) + 4 * (row % 4) + column % 4;
  };
  texel = child(texel, dx, dy);
  for (std::size_t step = 1; step < steps; ++step) texel = child(texel, 1 - dx, 1 - dy);
  return texel;
}

}  // namespace

AdaptiveSphere::AdaptiveSphere(int coarse, int sampling, double leastOccluder) {
  if (coarse < 8 || coarse % 8 != 0) throw std::invalid_argument("coarse resolution: not a multiple of 8");
  levels.emplace_back(coarse);
  while (levels.back().resolution < sampling) levels.push_back(SphereBoards::finer(levels.back()));
  if (levels.back().resolution != sampling) throw std::invalid_argument("sampling resolution: not the coarse one times a power of two");
  if (leastOccluder == 0.0) return;
  while (first < levels.size() && !(coveringRadius(levels[first].resolution) <= 0.5 * leastOccluder)) ++first;
  if (first == levels.size()) throw std::invalid_argument("least occluder: too small for the sampling resolution");
}

AdaptiveVisibility::AdaptiveVisibility(const RayScene& rays, const AdaptiveSphere& sphere)
    : sphere_(sphere), packet_(rays), maps_(sphere.levels.size()) {
  for (std::size_t level = 0; level < maps_.size(); ++level) {
    const auto count = sphere.levels[level].boardCount;
    auto& map = maps_[level];
    for (auto* bits : {&map.side, &map.seen, &map.hidden, &map.traced, &map.visible}) bits->resize(count);
  }
  const auto most = sphere.levels.back().boardCount;
  marked_.resize(most);
  changed_.resize(most);
  otherSide_.resize(most);
  horizon_.resize(most);
  whole_.resize(most);
}

std::uint64_t AdaptiveVisibility::operator()(const Viewpoint& viewpoint) {
  rays_ = 0;
  bothSides_ = viewpoint.doubleSided;
  for (std::size_t level = 0; level < maps_.size(); ++level) {
    auto& map = maps_[level];
    sphere_.levels[level].above(viewpoint.normal, map.side);
    std::ranges::fill(map.visible, Board{0});
    std::ranges::fill(map.traced, Board{0});
  }
  sphere_.levels.back().toTexels(maps_.back().side, above_);
  traceSide(viewpoint.front);
  if (viewpoint.doubleSided) {
    for (auto& map : maps_)
      for (auto& bits : map.side) bits = ~bits;
    traceSide(viewpoint.back);
    for (auto& map : maps_)
      for (auto& bits : map.side) bits = ~bits;
  }
  sphere_.levels.back().toTexels(maps_.back().visible, visible_);
  return rays_;
}

void AdaptiveVisibility::traceSide(glm::vec3 origin) {
  packet_.setOrigin(origin);
  traceAll(sphere_.first);
  for (std::size_t level = sphere_.first + 1; level < maps_.size(); ++level) {
    inherit(level);
    // Every other level is enough: following an edge over two texels costs fewer rays than tracing it at one level more.
    if ((maps_.size() - 1 - level) % 2 == 0) refine(level);
  }
  for (auto& map : maps_)
    for (std::size_t b = 0; b < map.seen.size(); ++b) map.visible[b] |= map.seen[b];
}

void AdaptiveVisibility::traceAll(std::size_t level) {
  auto& map = maps_[level];
  const auto& boards = sphere_.levels[level];
  for (std::size_t b = 0; b < boards.boardCount; ++b) {
    map.traced[b] |= map.side[b];
    map.seen[b] = map.hidden[b] = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto which = static_cast<unsigned>(map.side[b] >> 16 * k & 0xffffu);
      if (which == 0) continue;
      const auto first = 64 * b + 16 * k;
      const auto hits = packet_(boards.x.data() + first, boards.y.data() + first, boards.z.data() + first, which);
      map.hidden[b] |= Board{hits} << 16 * k;
      map.seen[b] |= Board{which & ~hits} << 16 * k;
      rays_ += static_cast<std::uint64_t>(std::popcount(which));
    }
  }
}

void AdaptiveVisibility::inherit(std::size_t level) {
  const auto& from = maps_[level - 1];
  const auto& coarse = sphere_.levels[level - 1];
  auto& to = maps_[level];
  for (std::size_t b = 0; b < coarse.boardCount; ++b) {
    auto seen = from.seen[b], hidden = from.hidden[b];
    if ((seen | hidden) != ~Board{0} && (seen | hidden) != 0) {
      // On the horizon: a texel that is below takes what those about it agree on.
      const auto nearSeen = coarse.around8(from.seen.data(), b), nearHidden = coarse.around8(from.hidden.data(), b);
      const auto below = ~(seen | hidden);
      seen |= below & nearSeen & ~nearHidden;
      hidden |= below & nearHidden & ~nearSeen;
    }
    auto seenCorners = everyQuarter(seen), hiddenCorners = everyQuarter(hidden);
    if (((seen & coarse.around4(from.hidden.data(), b)) | (hidden & coarse.around4(from.seen.data(), b))) != 0) {
      // An edge that runs across is a staircase of texels: where the two neighbours at a corner agree against the texel and the two others,
      // that quarter of it is taken for theirs. A third of what is traced in vain goes.
      const auto at = [&](const std::vector<Board>& bits) {
        return std::array{coarse.at(bits.data(), b, SphereBoards::left), coarse.at(bits.data(), b, SphereBoards::right),
                          coarse.at(bits.data(), b, SphereBoards::top), coarse.at(bits.data(), b, SphereBoards::bottom)};
      };
      const auto s = at(from.seen), h = at(from.hidden);
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto x = corner % 2, y = 2 + corner / 2;  // the sides that meet there; x ^ 1 and y ^ 1 are opposite
        const auto toHidden = seen & h[x] & h[y] & s[x ^ 1] & s[y ^ 1], toSeen = hidden & s[x] & s[y] & h[x ^ 1] & h[y ^ 1];
        seenCorners[corner] = (seen | toSeen) & ~toHidden;
        hiddenCorners[corner] = (hidden | toHidden) & ~toSeen;
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      to.seen[4 * b + k] = doubledQuarters(seenCorners, k) & to.side[4 * b + k];
      to.hidden[4 * b + k] = doubledQuarters(hiddenCorners, k) & to.side[4 * b + k];
    }
  }
}

void AdaptiveVisibility::mark(std::size_t board) {
  if (marked_[board] != 0) return;
  marked_[board] = 1;
  next_.push_back(static_cast<std::uint32_t>(board));
}

void AdaptiveVisibility::settle(std::size_t level, std::size_t texel, bool hit) {
  auto& map = maps_[level];
  const auto b = texel / 64;
  const auto bit = bitOf(texel);
  const bool was = ((hit ? map.hidden : map.seen)[b] & bit) != 0;
  if (was) return;
  (hit ? map.hidden : map.seen)[b] |= bit;
  (hit ? map.seen : map.hidden)[b] &= ~bit;
  changed_[b] |= bit;
  mark(b);
}

void AdaptiveVisibility::traceTile(std::size_t level, std::size_t tile, unsigned which) {
  auto& map = maps_[level];
  const auto& boards = sphere_.levels[level];
  const auto first = 16 * tile;
  const Board hits{packet_(boards.x.data() + first, boards.y.data() + first, boards.z.data() + first, which)};
  const auto b = tile / 4, shift = 16 * (tile % 4);
  const auto hidden = hits << shift, seen = (Board{which} & ~hits) << shift;
  const auto changed = (hidden & ~map.hidden[b]) | (seen & ~map.seen[b]);
  rays_ += static_cast<std::uint64_t>(std::popcount(which));
  if (changed == 0) return;
  map.hidden[b] = (map.hidden[b] | hidden) & ~seen;
  map.seen[b] = (map.seen[b] | seen) & ~hidden;
  changed_[b] |= changed;
  mark(b);
}

void AdaptiveVisibility::traceGathered(std::size_t level) {
  if (gathered_ == 0) return;
  const auto hits = packet_(x_, y_, z_, (1u << gathered_) - 1u);
  for (unsigned i = 0; i < gathered_; ++i) settle(level, texel_[i], (hits >> i & 1) != 0);
  rays_ += gathered_;
  gathered_ = 0;
}

void AdaptiveVisibility::refine(std::size_t level) {
  auto& map = maps_[level];
  const auto& boards = sphere_.levels[level];
  const bool finest = level + 1 == maps_.size();
  round_.clear();
  for (std::size_t b = 0; b < boards.boardCount; ++b) {
    if (map.side[b] != 0) round_.push_back(static_cast<std::uint32_t>(b));
    otherSide_[b] = ~map.side[b];
  }
  if (finest)
    for (std::size_t b = 0; b < boards.boardCount; ++b) {
      horizon_[b] = map.side[b] == 0 || !boards.anyAround4(otherSide_.data(), b) ? 0 : map.side[b] & boards.around4(otherSide_.data(), b);
      whole_[b] = 0;
    }
  for (bool first = true; !round_.empty(); first = false) refineRound(level, first);
}

void AdaptiveVisibility::refineRound(std::size_t level, bool first) {
  auto& map = maps_[level];
  const auto& boards = sphere_.levels[level];
  const bool finest = level + 1 == maps_.size();
  next_.clear();
  for (const auto b : round_) {
    const auto seen = map.seen[b], hidden = map.hidden[b];
    // A pair that differs with both traced is settled; most boards are of one kind, and so are those about them.
    Board pending = map.side[b] & ~(seen | hidden);
    if (seen != 0 && boards.anyAround4(map.hidden.data(), b)) pending |= seen & boards.around4(map.hidden.data(), b);
    if (hidden != 0 && boards.anyAround4(map.seen.data(), b)) pending |= hidden & boards.around4(map.seen.data(), b);
    if (finest) pending |= horizon_[b] & (first ? SphereBoards::sparse() : whole_[b] != 0 ? ~Board{0} : Board{0});
    pending &= ~map.traced[b];
    if (pending == 0) continue;
    map.traced[b] |= pending;
    for (std::size_t k = 0; k < 4; ++k) {
      auto which = static_cast<unsigned>(pending >> 16 * k & 0xffffu);
      if (std::popcount(which) >= kOwnPacket) {
        traceTile(level, 4 * std::size_t{b} + k, which);
        continue;
      }
      for (; which != 0; which &= which - 1) {
        const auto texel = 64 * std::size_t{b} + 16 * k + static_cast<std::size_t>(std::countr_zero(which));
        x_[gathered_] = boards.x[texel];
        y_[gathered_] = boards.y[texel];
        z_[gathered_] = boards.z[texel];
        texel_[gathered_] = static_cast<std::uint32_t>(texel);
        if (++gathered_ == 16) traceGathered(level);
      }
    }
  }
  traceGathered(level);
  // Only beside a value that changed can there be a new pair that differs.
  const auto count = next_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t b = next_[i];
    const auto changed = changed_[b];
    changed_[b] = 0;
    // Where there is something low on the horizon there is more.
    const bool low = finest && (changed & horizon_[b]) != 0 && whole_[b] != 2;
    if (low) {
      whole_[b] = 2;
      for (const auto other : boards.beside[b]) {
        if (horizon_[other] == 0 || whole_[other] != 0) continue;
        whole_[other] = 1;
        mark(other);
      }
    }
    constexpr Board kRim = SphereBoards::rim();
    if ((changed & kRim) == 0) continue;
    for (const auto other : boards.beside[b]) mark(other);
  }
  std::ranges::sort(next_);
  for (const auto b : next_) marked_[b] = 0;
  std::swap(round_, next_);
}

void AdaptiveVisibility::at(int resolution, TexelBits& above, TexelBits& visible) const {
  const auto found = std::ranges::find(sphere_.levels, resolution, &SphereBoards::resolution);
  if (found == sphere_.levels.end()) throw std::invalid_argument("resolution: no level of the adaptive map");
  const auto level = static_cast<std::size_t>(found - sphere_.levels.begin());
  const auto& map = maps_[level];
  const auto& finest = maps_.back();
  found->toTexels(map.side, above);
  auto bits = map.visible;
  const auto steps = maps_.size() - 1 - level;
  const bool unknown = level < sphere_.first;
  for (std::size_t b = 0; steps > 0 && b < bits.size(); ++b) {
    const auto asked = bothSides_ ? ~Board{0} : map.side[b];
    // Of one kind throughout, at both resolutions: most boards.
    Board any = unknown ? 0 : bits[b] & asked, all = unknown ? ~Board{0} : bits[b] | ~asked;
    for (std::size_t f = b << 2 * steps; f < (b + 1) << 2 * steps; ++f) {
      any |= finest.visible[f];
      all &= finest.visible[f] | (bothSides_ ? Board{0} : ~finest.side[f]);
    }
    if (any == 0 || all == ~Board{0}) {
      if (unknown) bits[b] = any != 0 ? asked : 0;
      continue;
    }
    for (auto left = asked; left != 0; left &= left - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(left));
      const bool sees = (bits[b] >> bit & 1) != 0;
      bool agrees = false, finer = sees;
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto fine = besideCentre(64 * b + bit, steps, corner);
        if (!bothSides_ && (finest.side[fine / 64] & bitOf(fine)) == 0) continue;
        finer = (finest.visible[fine / 64] & bitOf(fine)) != 0;
        agrees = agrees || finer == sees;
      }
      // A ray through the centre decides, unless nothing of what it met is left at the sampling resolution.
      if (agrees && (map.traced[b] >> bit & 1) != 0) continue;
      bits[b] = finer ? bits[b] | Board{1} << bit : bits[b] & ~(Board{1} << bit);
    }
  }
  found->toTexels(bits, visible);
}

double coveringRadius(int resolution) {
  // The centres of the four texels that meet at a corner of the map's grid make two triangles, split along the shorter diagonal; these
  // cover the sphere, and no point of a triangle is farther from all its vertices than the centre of its circle. One quadrant stands for all.
  const int half = resolution / 2;
  double worst = 0.0;
  const auto center = [&](int i, int j) { return lobe64::octahedralTexelDirection(lobe64::octahedralWrapTexel({i, j}, resolution), resolution); };
  const auto circle = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double twiceArea = glm::length(glm::cross(b - a, c - a));
    if (twiceArea < 1e-12) return;  // at the middle of a border side two texels meet twice
    worst = std::max(worst, glm::distance(a, b) * glm::distance(b, c) * glm::distance(c, a) / (2.0 * twiceArea));
  };
  for (int j = half; j <= resolution; ++j) {
    for (int i = half; i <= resolution; ++i) {
      const auto a = center(i - 1, j - 1), b = center(i, j - 1), c = center(i, j), d = center(i - 1, j);
      const bool ac = glm::distance(a, c) < glm::distance(b, d);
      circle(a, ac ? c : b, d);
      circle(ac ? a : d, b, c);
    }
  }
  return std::asin(worst);
}

}  // namespace chiaro
