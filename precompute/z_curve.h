#pragma once
/// An order in which places that lie together come together.

namespace chiaro {

/// Place of a cell along a Z curve through cells x cells (a power of two) of them.
constexpr unsigned zCurve(unsigned x, unsigned y, unsigned cells) {
  unsigned place = 0;
  for (unsigned bit = cells / 2; bit > 0; bit /= 2) place = 4 * place + ((y & bit) != 0 ? 2 : 0) + ((x & bit) != 0 ? 1 : 0);
  return place;
}

}  // namespace chiaro
