#pragma once
/// The octahedral sphere of a bake (shaders/lobe/octahedral.glsl), laid out for packets of sixteen directions.

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

namespace chiaro {

/// #texels floats that start on a 64-byte boundary.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(std::size_t count) : lines_((count + 15) / 16) {}
  float* data() { return lines_.empty() ? nullptr : lines_.front().values; }
  const float* data() const { return lines_.empty() ? nullptr : lines_.front().values; }
  float& operator[](std::size_t i) { return data()[i]; }
  float operator[](std::size_t i) const { return data()[i]; }

 private:
  struct alignas(64) Line {
    float values[16] = {};
  };
  std::vector<Line> lines_;
};

/// A texel is numbered by tile: texel t is lane t % 16 of the 4x4 tile t / 16, lanes and tiles row-major. `rowMajor` gives its number
/// in the stored map.
struct OctahedralGrid {
  /// resolution: a multiple of 4.
  explicit OctahedralGrid(int resolution);

  int resolution;
  std::size_t texelCount;
  std::size_t tileCount;
  AlignedFloats x, y, z;                 ///< #texels; unit directions of the texel centres
  std::vector<float> solidAngle;         ///< #texels, sr; sums to 4 pi
  std::vector<std::uint32_t> rowMajor;   ///< #texels
  std::vector<std::uint32_t> tiled;      ///< #texels; the inverse of `rowMajor`
  /// Texels that share an edge, each pair once, sorted; pairs across the map's border join texels that touch on the sphere.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours;
  /// Those of them that are not side by side in the map.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;

  glm::vec3 direction(std::size_t texel) const { return {x[texel], y[texel], z[texel]}; }
  /// `solidAngle` in the order of a stored map: what its columns weigh.
  std::vector<float> rowMajorSolidAngle() const;
  /// The texel that holds `direction`.
  std::size_t texelAt(glm::vec3 direction) const;
  /// The texel `dx`, `dy` (-1, 0, 1) beside `texel`, across the border where need be.
  std::size_t texelBeside(std::size_t texel, int dx, int dy) const;
};

/// Bilinear value of the row-major map `values` (resolution^2) in a direction, the border wrapped as the runtime does.
float sampleOctahedral(const float* values, int resolution, glm::vec3 direction);

}  // namespace chiaro
