#pragma once
/// Where a bake is wrong, as pictures of its error at vertices.

#include <optional>
#include <string>
#include <vector>

#include "assets/scene/camera_spec.h"
#include "precompute/report/budget/error_mesh.h"

namespace chiaro {

struct ViewedVertex {
  WorstVertex vertex;
  std::optional<glm::vec2> at;          ///< in the overview, (0,0) its top left and (1,1) its bottom right corner; nothing where it is not seen
  std::vector<std::uint8_t> closeUp;    ///< PNG, the vertex in its middle
};

struct ErrorView {
  VertexErrors errors;
  std::vector<std::uint8_t> overview;  ///< PNG
  std::vector<ViewedVertex> worst;     ///< at most eight
};

/// As the camera sees it. scene: prepared. Throws Error (usage) for a camera that the scene does not have.
ErrorView viewErrors(const Scene& scene, VertexErrors errors, const CameraSpec& camera);

/// A section of the budget's page.
std::string errorViewSection(const ErrorView& view);

}  // namespace chiaro
