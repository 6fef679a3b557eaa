#pragma once
/// Where cube-map texels look, and bilinear lookups across face edges as GL_TEXTURE_CUBE_MAP_SEAMLESS does them.

#include <glm/glm.hpp>
#include <vector>

namespace chiaro {

struct CubeCoordinates {
  int face = 0;  ///< +X -X +Y -Y +Z -Z
  float s = 0;   ///< in the face, [-1,1] along columns
  float t = 0;   ///< in the face, [-1,1] along rows
};

/// Not normalised: length >= 1 (OpenGL 4.5, table 8.19).
glm::vec3 cubeDirection(const CubeCoordinates& coordinates);
/// Of any direction but zero.
CubeCoordinates cubeCoordinates(glm::vec3 direction);
/// Unit direction through the centre of texel (column, row).
glm::vec3 cubeTexelDirection(int face, int column, int row, int faceResolution);
/// Solid angle of a texel; those of all 6 faces add up to 4 pi.
double cubeTexelSolidAngle(int column, int row, int faceResolution);

/// Bilinear; neighbours beyond an edge come from the next face, and at a corner the missing fourth is the mean of the three.
/// `texels`: 6 faces by faceResolution^2.
glm::vec3 sampleCube(const std::vector<glm::vec3>& texels, int faceResolution, glm::vec3 direction);

}  // namespace chiaro
