#include "precompute/visibility/octahedral_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "shaders/cpp/lobe.h"

namespace chiaro {

OctahedralGrid::OctahedralGrid(int side)
    : resolution(side),
      texelCount(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)),
      tileCount(texelCount / 16),
      x(texelCount),
      y(texelCount),
      z(texelCount),
      solidAngle(texelCount),
      rowMajor(texelCount),
      tiled(texelCount) {
  const int tilesPerRow = resolution / 4;
  for (std::size_t t = 0; t < texelCount; ++t) {
    const int tile = static_cast<int>(t / 16), lane = static_cast<int>(t % 16);
    const int column = tile % tilesPerRow * 4 + lane % 4, row = tile / tilesPerRow * 4 + lane / 4;
    rowMajor[t] = static_cast<std::uint32_t>(row * resolution + column);
    tiled[rowMajor[t]] = static_cast<std::uint32_t>(t);
    const auto w = lobe64::octahedralTexelDirection({column, row}, resolution);
    x[t] = static_cast<float>(w.x);
    y[t] = static_cast<float>(w.y);
    z[t] = static_cast<float>(w.z);
    solidAngle[t] = static_cast<float>(lobe64::octahedralTexelSolidAngle({column, row}, resolution));
  }
  for (std::size_t t = 0; t < texelCount; ++t) {
    for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
      const auto other = texelBeside(t, dx, dy);
      if (t < other) neighbours.emplace_back(static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(other));
    }
  }
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());

  for (const auto& [a, b] : neighbours) {
    const auto from = static_cast<int>(rowMajor[a]), to = static_cast<int>(rowMajor[b]);
    if (std::abs(from % resolution - to % resolution) + std::abs(from / resolution - to / resolution) != 1) seam.emplace_back(a, b);
  }
}

std::vector<float> OctahedralGrid::rowMajorSolidAngle() const {
  std::vector<float> result(texelCount);
  for (std::size_t t = 0; t < texelCount; ++t) result[rowMajor[t]] = solidAngle[t];
  return result;
}

std::size_t OctahedralGrid::texelAt(glm::vec3 direction) const {
  const auto uv = lobe32::octahedralEncode(direction);
  const auto texel = [&](float u) { return std::clamp(static_cast<int>(u * static_cast<float>(resolution)), 0, resolution - 1); };
  return tiled[static_cast<std::size_t>(texel(uv.y) * resolution + texel(uv.x))];
}

std::size_t OctahedralGrid::texelBeside(std::size_t texel, int dx, int dy) const {
  const int column = static_cast<int>(rowMajor[texel]) % resolution, row = static_cast<int>(rowMajor[texel]) / resolution;
  const auto beside = lobe32::octahedralWrapTexel({column + dx, row + dy}, resolution);
  return tiled[static_cast<std::size_t>(beside.y * resolution + beside.x)];
}

float sampleOctahedral(const float* values, int resolution, glm::vec3 direction) {
  const auto uv = lobe32::octahedralEncode(direction);
  const auto at = uv * static_cast<float>(resolution) - 0.5f;
  const auto corner = glm::floor(at);
  const auto share = at - corner;
  const auto value = [&](int dx, int dy) {
    const auto texel = lobe32::octahedralWrapTexel({static_cast<int>(corner.x) + dx, static_cast<int>(corner.y) + dy}, resolution);
    return values[texel.y * resolution + texel.x];
  };
  return glm::mix(glm::mix(value(0, 0), value(1, 0), share.x), glm::mix(value(0, 1), value(1, 1), share.x), share.y);
}

}  // namespace chiaro
