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

// Inlined: the loops over boards are little else.
namespace board {

// Columns and rows of a board.
inline constexpr Board kColumn0 = 0x0000111100001111u, kColumn3 = 0x0000888800008888u, kColumn4 = 0x1111000011110000u,
                kColumn7 = 0x8888000088880000u, kRow0 = 0x00000000000f000fu, kRow3 = 0x00000000f000f000u, kRow4 = 0x000f000f00000000u,
                kRow7 = 0xf000f00000000000u;

inline Board flipRows(Board b) {
  b = std::rotl(b, 32);
  b = (b & 0x0f0f0f0f0f0f0f0fu) << 4 | (b >> 4 & 0x0f0f0f0f0f0f0f0fu);
  return (b & 0x00ff00ff00ff00ffu) << 8 | (b >> 8 & 0x00ff00ff00ff00ffu);
}

inline Board flipColumns(Board b) {
  b = (b & 0x0000ffff0000ffffu) << 16 | (b >> 16 & 0x0000ffff0000ffffu);
  b = (b & 0x3333333333333333u) << 2 | (b >> 2 & 0x3333333333333333u);
  return (b & 0x5555555555555555u) << 1 | (b >> 1 & 0x5555555555555555u);
}

}  // namespace board

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
  /// Whether around4 may be anything but 0.
  bool anyAround4(const Board* bits, std::size_t b) const {
    const auto& others = beside[b];
    return (bits[b] | bits[others[0]] | bits[others[1]] | bits[others[2]] | bits[others[3]]) != 0;
  }
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

inline Board SphereBoards::shifted(Board here, Board there, Side side, bool mirrored) {
  switch (side) {
    case right:
      return (here >> 1 & ~(board::kColumn3 | board::kColumn7)) | (here >> 13 & board::kColumn3) | ((mirrored ? board::flipRows(there) : there << 19) & board::kColumn7);
    case left:
      return (here << 1 & ~(board::kColumn0 | board::kColumn4)) | (here << 13 & board::kColumn4) | ((mirrored ? board::flipRows(there) : there >> 19) & board::kColumn0);
    case bottom:
      return (here >> 4 & ~(board::kRow3 | board::kRow7)) | (here >> 20 & board::kRow3) | ((mirrored ? board::flipColumns(there) : there << 44) & board::kRow7);
    case top:
      return (here << 4 & ~(board::kRow0 | board::kRow4)) | (here << 20 & board::kRow4) | ((mirrored ? board::flipColumns(there) : there >> 44) & board::kRow0);
  }
  return 0;
}

/// A tile of a map (16 bits) as the board of the map twice as fine: each texel becomes four.
Board doubled(std::uint16_t tile);

}  // namespace chiaro
