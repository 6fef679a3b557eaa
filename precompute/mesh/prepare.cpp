#include "precompute/bake.h"
#include "precompute/mesh/half_edge.h"
#include "precompute/mesh/normals.h"
#include "precompute/mesh/tangents.h"
#include "precompute/mesh/weld.h"

namespace chiaro {

Scene prepareScene(const Scene& scene, float creaseAngle, RepairReport& report) {
  report = {};
  Scene result = scene;
  for (auto& primitive : result.primitives) {
    const auto& material = materialOf(result, primitive);
    if (!needsTangents(material, primitive)) primitive.tangents.clear();  // they must not keep equal vertices apart
    cleanPrimitive(primitive, report);
    const auto edges = buildHalfEdges(primitive.positions, primitive.indices, weldPositions(primitive.positions));
    report.nonManifoldEdges += edges.nonManifoldEdges;
    report.boundaryEdges += edges.boundaryEdges;
    if (primitive.normals.empty())
      computeNormals(primitive, edges, creaseAngle, report);
    else
      repairNormals(primitive, report);
    makeTangents(primitive, material, report);
  }
  std::erase_if(result.primitives, [](const Primitive& primitive) { return primitive.indices.empty(); });
  return result;
}

}  // namespace chiaro
