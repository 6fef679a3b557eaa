#include "precompute/visibility/sphere_boards.h"

#include <algorithm>

#include "precompute/simd.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using Corner = std::array<std::uint16_t, 2>;  ///< column and row of a board

std::vector<Corner> rowsOfBoards(int perRow) {
  std::vector<Corner> result;
  for (int row = 0; row < perRow; ++row)
    for (int column = 0; column < perRow; ++column)
      result.push_back({static_cast<std::uint16_t>(column), static_cast<std::uint16_t>(row)});
  return result;
}

}  // namespace

SphereBoards::SphereBoards(int side) : SphereBoards(side, rowsOfBoards(side / 8)) {}

SphereBoards SphereBoards::finer(const SphereBoards& parent) {
  const auto tilesPerRow = static_cast<std::uint32_t>(parent.resolution / 4);
  std::vector<Corner> corners;  // a tile of the parent is a board here
  for (const auto t : parent.tile) corners.push_back({static_cast<std::uint16_t>(t % tilesPerRow), static_cast<std::uint16_t>(t / tilesPerRow)});
  return {2 * parent.resolution, corners};
}

SphereBoards::SphereBoards(int side, const std::vector<Corner>& corners)
    : resolution(side), boardCount(corners.size()), x(64 * boardCount), y(64 * boardCount), z(64 * boardCount), beside(boardCount), mirrored(boardCount) {
  const int perRow = resolution / 8;
  std::vector<std::uint32_t> boardAt(boardCount);
  for (std::uint32_t b = 0; b < boardCount; ++b) boardAt[static_cast<std::size_t>(corners[b][1] * perRow + corners[b][0])] = b;
  for (std::uint32_t b = 0; b < boardCount; ++b) {
    const int column = corners[b][0], row = corners[b][1];
    for (const auto& [where, dx, dy] : {std::array{int{left}, -1, 0}, {int{right}, 1, 0}, {int{top}, 0, -1}, {int{bottom}, 0, 1}}) {
      const auto to = lobe32::octahedralWrapTexel({column + dx, row + dy}, perRow);
      beside[b][static_cast<std::size_t>(where)] = boardAt[static_cast<std::size_t>(to.y * perRow + to.x)];
      mirrored[b][static_cast<std::size_t>(where)] = column + dx != to.x || row + dy != to.y;
    }
    for (int k = 0; k < 4; ++k) tile.push_back(static_cast<std::uint32_t>((2 * row + k / 2) * 2 * perRow + 2 * column + k % 2));
    glm::dvec3 sum(0.0);
    for (int bit = 0; bit < 64; ++bit) {
      const int i = 8 * column + bit / 16 % 2 * 4 + bit % 4, j = 8 * row + bit / 32 * 4 + bit / 4 % 4;
      const auto w = lobe64::octahedralTexelDirection({i, j}, resolution);
      const auto at = 64 * std::size_t{b} + static_cast<std::size_t>(bit);
      x[at] = static_cast<float>(w.x);
      y[at] = static_cast<float>(w.y);
      z[at] = static_cast<float>(w.z);
      sum += w;
    }
    const glm::vec3 center(sum / 64.0);
    float radius = 0.0f;
    for (std::size_t at = 64 * std::size_t{b}; at < 64 * (std::size_t{b} + 1); ++at) radius = std::max(radius, glm::distance(center, {x[at], y[at], z[at]}));
    bound.emplace_back(center, radius);
  }
}

Board SphereBoards::around8(const Board* bits, std::size_t b) const {
  const auto across = [&](std::size_t i) { return bits[i] | at(bits, i, left) | at(bits, i, right); };
  const auto here = across(b);
  return here | shifted(here, across(beside[b][top]), top, mirrored[b][top]) |
         shifted(here, across(beside[b][bottom]), bottom, mirrored[b][bottom]);
}

void SphereBoards::above(glm::vec3 normal, std::vector<Board>& bits) const {
  bits.resize(boardCount);
  for (std::size_t b = 0; b < boardCount; ++b) {
    const float height = glm::dot(glm::vec3(bound[b]), normal), reach = bound[b].w + 1e-5f;
    if (std::abs(height) > reach) {
      bits[b] = height > 0.0f ? ~Board{0} : Board{0};
      continue;
    }
    const auto first = 64 * b;
    Board word = 0;
    runVectorised([&]<typename Vector>() CHIARO_INLINE {
      const float *bx = x.data() + first, *by = y.data() + first, *bz = z.data() + first;
      const glm::vec3 n = normal;
      Board result = 0;
      for (int i = 0; i < 64; i += kWidth<Vector>) {
        const Vector dot = loadVector<Vector>(bx + i) * n.x + loadVector<Vector>(by + i) * n.y + loadVector<Vector>(bz + i) * n.z;
        result |= Board{trueElements<Vector>(dot > Vector{})} << i;
      }
      word = result;
    });
    bits[b] = word;
  }
}

void SphereBoards::toTexels(const std::vector<Board>& bits, TexelBits& texels) const {
  texels.resize(4 * boardCount);
  for (std::size_t t = 0; t < 4 * boardCount; ++t) texels[tile[t]] = static_cast<std::uint16_t>(bits[t / 4] >> 16 * (t % 4));
}

void SphereBoards::fromTexels(const TexelBits& texels, std::vector<Board>& bits) const {
  bits.resize(boardCount);
  for (std::size_t b = 0; b < boardCount; ++b) {
    Board word = 0;
    for (std::size_t k = 0; k < 4; ++k) word |= Board{texels[tile[4 * b + k]]} << 16 * k;
    bits[b] = word;
  }
}

Board doubled(std::uint16_t tile) {
  // Two rows of a tile are four of a board: bit x of row y goes to columns 2x and 2x + 1 of rows 2y and 2y + 1.
  static const auto kHalves = [] {
    std::array<std::uint32_t, 256> halves{};
    for (unsigned rows = 0; rows < 256; ++rows)
      for (unsigned bit = 0; bit < 8; ++bit) {
        if ((rows >> bit & 1) == 0) continue;
        const unsigned column = 2 * (bit % 4), row = 2 * (bit / 4);
        halves[rows] |= 0x33u << (16 * (column / 4) + 4 * row + column % 4);
      }
    return halves;
  }();
  return Board{kHalves[tile & 255u]} | Board{kHalves[tile >> 8]} << 32;
}

}  // namespace chiaro
