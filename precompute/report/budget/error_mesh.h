#pragma once
/// A scene in the colours of its error, as a file for any glTF viewer and as pictures.

#include <cstdint>
#include <string>
#include <vector>

#include "assets/image/image.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/report/budget/vertex_error.h"

namespace chiaro {

/// The error at which the colours (magma: black, purple, orange, pale yellow) end.
inline constexpr double kVertexErrorRange = 0.05;

/// A binary glTF of the scene's triangles, unlit, with COLOR_0 for magma of error over kVertexErrorRange; `extras` of its asset says so. `generator`: as in a baked file.
std::vector<std::uint8_t> errorMesh(const Scene& scene, const VertexErrors& errors, const std::string& generator);

/// The scene as `camera` sees it in the same colours, interpolated, darker where it turns away; dark grey where nothing is.
Image8 errorMeshPicture(const Scene& scene, const RayScene& rays, const VertexErrors& errors, const Camera& camera, glm::ivec2 size);

/// A camera that looks at the vertex along its normal, from no farther than the next surface and an eighth of the scene's diagonal.
Camera cameraBefore(const WorstVertex& vertex, const Scene& scene, const RayScene& rays);

}  // namespace chiaro
