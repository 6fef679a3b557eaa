#include "runtime/environment/cube_map.h"

#include <algorithm>
#include <cmath>

namespace chiaro {
namespace {

float texelCentre(int index, int faceResolution) {
  return (2.0f * static_cast<float>(index) + 1.0f) / static_cast<float>(faceResolution) - 1.0f;
}

int texelIndex(float coordinate, int faceResolution) {
  return std::clamp(static_cast<int>((coordinate + 1.0f) * 0.5f * static_cast<float>(faceResolution)), 0, faceResolution - 1);
}

std::size_t texelOffset(int face, int column, int row, int faceResolution) {
  return (static_cast<std::size_t>(face) * static_cast<std::size_t>(faceResolution) + static_cast<std::size_t>(row)) *
             static_cast<std::size_t>(faceResolution) +
         static_cast<std::size_t>(column);
}

/// A texel at most one step over one edge. Its centre on the extended face plane projects into the neighbour's border
/// texel with the same index along the edge, so looking it up by direction is exact.
std::size_t wrappedOffset(int face, int column, int row, int faceResolution) {
  const auto inside = [&](int i) { return i >= 0 && i < faceResolution; };
  if (inside(column) && inside(row)) return texelOffset(face, column, row, faceResolution);
  const CubeCoordinates over =
      cubeCoordinates(cubeDirection({face, texelCentre(column, faceResolution), texelCentre(row, faceResolution)}));
  return texelOffset(over.face, texelIndex(over.s, faceResolution), texelIndex(over.t, faceResolution), faceResolution);
}

}  // namespace

glm::vec3 cubeDirection(const CubeCoordinates& c) {
  switch (c.face) {
    case 0:
      return {1, -c.t, -c.s};
    case 1:
      return {-1, -c.t, c.s};
    case 2:
      return {c.s, 1, c.t};
    case 3:
      return {c.s, -1, -c.t};
    case 4:
      return {c.s, -c.t, 1};
    default:
      return {-c.s, -c.t, -1};
  }
}

CubeCoordinates cubeCoordinates(glm::vec3 d) {
  const glm::vec3 a = glm::abs(d);
  if (a.x >= a.y && a.x >= a.z)
    return d.x >= 0 ? CubeCoordinates{0, -d.z / a.x, -d.y / a.x} : CubeCoordinates{1, d.z / a.x, -d.y / a.x};
  if (a.y >= a.z) return d.y >= 0 ? CubeCoordinates{2, d.x / a.y, d.z / a.y} : CubeCoordinates{3, d.x / a.y, -d.z / a.y};
  return d.z >= 0 ? CubeCoordinates{4, d.x / a.z, -d.y / a.z} : CubeCoordinates{5, -d.x / a.z, -d.y / a.z};
}

glm::vec3 cubeTexelDirection(int face, int column, int row, int faceResolution) {
  return glm::normalize(cubeDirection({face, texelCentre(column, faceResolution), texelCentre(row, faceResolution)}));
}

double cubeTexelSolidAngle(int column, int row, int faceResolution) {
  const auto corner = [&](int i, int j) {
    const double s = 2.0 * i / faceResolution - 1.0, t = 2.0 * j / faceResolution - 1.0;
    return std::atan2(s * t, std::sqrt(s * s + t * t + 1.0));
  };
  return corner(column, row) - corner(column + 1, row) - corner(column, row + 1) + corner(column + 1, row + 1);
}

glm::vec3 sampleCube(const std::vector<glm::vec3>& texels, int faceResolution, glm::vec3 direction) {
  const CubeCoordinates at = cubeCoordinates(direction);
  const float x = (at.s + 1.0f) * 0.5f * static_cast<float>(faceResolution) - 0.5f;
  const float y = (at.t + 1.0f) * 0.5f * static_cast<float>(faceResolution) - 0.5f;
  const int column = std::clamp(static_cast<int>(std::floor(x)), -1, faceResolution - 1);
  const int row = std::clamp(static_cast<int>(std::floor(y)), -1, faceResolution - 1);
  const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);

  glm::vec3 corner[4];
  glm::vec3 sum(0.0f);
  int missing = -1;
  for (int k = 0; k < 4; ++k) {
    const int i = column + (k & 1), j = row + (k >> 1);
    const bool beyondColumn = i < 0 || i >= faceResolution, beyondRow = j < 0 || j >= faceResolution;
    if (beyondColumn && beyondRow) {
      missing = k;
      continue;
    }
    corner[k] = texels[wrappedOffset(at.face, i, j, faceResolution)];
    sum += corner[k];
  }
  if (missing >= 0) corner[missing] = sum / 3.0f;
  return glm::mix(glm::mix(corner[0], corner[1], fx), glm::mix(corner[2], corner[3], fx), fy);
}

}  // namespace chiaro
