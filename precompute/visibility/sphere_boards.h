#pragma once
/// Sixty-four texels of an octahedral map a word, so that what lies beside a whole 8x8 board is a few shifts.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "precompute/visibility/octahedral_grid.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

/// Bit 32 (y / 4) + 16 (x / 4) + 4 (y % 4) + x % 4 is texel (x, y) of the board: four tiles of OctahedralGrid, row-major.
using Board = std::uint64_t;

/// What is the same for every vertex. Board b of a map and board 4 b + k of one twice as fine: the latter is tile k of the former.
struct SphereBoards {
  enum Side { left, right, top, bottom };

  /// resolution: a multiple of 8.
  explicit SphereBoards(int resolution);
  /// The map twice as fine.
  static SphereBoards finer(const SphereBoards& parent);

  int resolution;
  std::size_t boardCount;
  AlignedFloats x, y, z;                             ///< 64 a board; unit directions of the texel centres
  std::vector<std::array<std::uint32_t, 4>> beside;  ///< #boards; by Side; across the border the board that touches there
  std::vector<std::array<bool, 4>> mirrored;         ///< #boards; by Side: the border lies between
  std::vector<std::uint32_t> tile;                   ///< 4 a board: tile of OctahedralGrid
  std::vector<glm::vec4> bound;                      ///< #boards; centre, and the largest distance of a texel centre from it

  /// The bits beside each texel of board `b`: of `bits`, which is indexed by board.
  Board at(const Board* bits, std::size_t b, Side side) const { return shifted(bits[b], bits[beside[b][side]], side, mirrored[b][side]); }
  /// Or of the four texels that share an edge.
  Board around4(const Board* bits, std::size_t b) const { return at(bits, b, left) | at(bits, b, right) | at(bits, b, top) | at(bits, b, bottom); }
  /// Or of the eight about each texel, and of itself.
  Board around8(const Board* bits, std::size_t b) const;

  /// Bits of texels whose direction w has dot(normal, w) > 0.
  void above(glm::vec3 normal, std::vector<Board>& bits) const;
  void toTexels(const std::vector<Board>& bits, TexelBits& texels) const;
  void fromTexels(const TexelBits& texels, std::vector<Board>& bits) const;

  /// The bits of `here` moved one texel so that each lands on the texel whose `side` it was beside, those of `there` moved in.
  static Board shifted(Board here, Board there, Side side, bool mirrored);

  /// One texel in each row and column of a board; of boards in a row, in seven of eight diagonals too.
  static constexpr Board sparse() { return 0x1280000440000821u; }

  /// The texels along the sides of a board.
  static constexpr Board rim() { return 0xf000f000000f000fu | 0x8888111188881111u; }

 private:
  SphereBoards(int resolution, const std::vector<std::array<std::uint16_t, 2>>& corner);
};

/// A tile of a map (16 bits) as the board of the map twice as fine: each texel becomes four.
Board doubled(std::uint16_t tile);

}  // namespace chiaro
