#include "assets/transfer/transfer.h"

namespace chiaro {

double Transfer::bytesPerVertex(std::size_t vertexCount) const {
  if (vertexCount == 0) return 0.0;
  const double perVertex = 2.0 * paddedTerms() + directionCount;
  const double shared = 4.0 * static_cast<double>(mean.size()) + 2.0 * static_cast<double>(eigenfunctions.size()) +
                        4.0 * static_cast<double>(weightScale.size()) + 12.0 * static_cast<double>(directions.size());
  return perVertex + shared / static_cast<double>(vertexCount);
}

}  // namespace chiaro
