#include "precompute/program/bake_json.h"

#include <nlohmann/json.hpp>
#include <numbers>

namespace chiaro {
namespace {

const char* nameOf(Compression compression) {
  switch (compression) {
    case Compression::pca: return "pca";
    case Compression::clustered: return "clustered";
    case Compression::joint: return "joint";
  }
  return "";
}

}  // namespace

std::string bakeJson(const BakeRun& run, const BakeReport& report) {
  using Json = nlohmann::ordered_json;
  Json errors = Json::object();
  for (const auto& [name, value] : report.error) errors[name] = value;
  const auto& repairs = report.repairs;
  const auto& refinement = report.refinement;
  const auto& seconds = report.seconds;
  const Json json = {
      {"version", run.version},
      {"input", run.input},
      {"output", run.output},
      {"vertices", report.vertices},
      {"triangles", report.triangles},
      {"resolution", run.settings.resolution},
      {"terms", report.terms},
      {"rays_traced", report.raysTraced},
      {"vertices_resumed", report.verticesResumed},
      {"bytes_per_vertex", report.bytesPerVertex},
      {"peak_memory_bytes", run.peakMemoryBytes},
      {"seconds",
       {{"load", run.loadSeconds},
        {"refinement", refinement.seconds},
        {"visibility", seconds.visibility},
        {"ssdf", seconds.ssdf},
        {"compression", seconds.compression},
        {"write", run.writeSeconds},
        {"total", run.loadSeconds + seconds.total + run.writeSeconds}}},
      {"error", errors},
      {"repairs",
       {{"welded_vertices", repairs.weldedVertices},
        {"isolated_vertices", repairs.isolatedVertices},
        {"degenerate_triangles", repairs.degenerateTriangles},
        {"duplicate_triangles", repairs.duplicateTriangles},
        {"triangles_turned", repairs.trianglesTurned},
        {"non_manifold_edges", repairs.nonManifoldEdges},
        {"boundary_edges", repairs.boundaryEdges},
        {"normals_computed", repairs.normalsComputed},
        {"normals_repaired", repairs.normalsRepaired},
        {"tangents_computed", repairs.tangentsComputed}}},
      {"refinement",
       {{"vertices_added", refinement.verticesAdded},
        {"triangles_added", refinement.trianglesAdded},
        {"passes", refinement.passes},
        {"edges_left_too_short", refinement.edgesTooShort},
        {"edges_left_over_budget", refinement.edgesOverBudget},
        {"worst_error_left", refinement.worstError},
        {"rays_traced", refinement.raysTraced}}},
      {"settings",
       {{"resolution", run.settings.resolution},
        {"compression", nameOf(run.settings.compression)},
        {"sample_resolution", run.settings.samplingResolution},
        {"least_occluder_deg", static_cast<double>(run.settings.leastOccluder) * 180.0 / std::numbers::pi},
        {"terms", run.settings.terms},
        {"clusters", run.settings.clusters},
        {"functions", run.settings.functions},
        {"weight_bits", run.settings.weightBits},
        {"function_bits", run.settings.functionBits},
        {"bytes_per_vertex", run.settings.bytesPerVertex},
        {"target_error", run.settings.targetError},
        {"directions", run.settings.directionCount},
        {"direction_sharpness", run.settings.directionSharpness},
        {"crease_angle_deg", static_cast<double>(run.settings.creaseAngle) * 180.0 / std::numbers::pi},
        {"refine", run.settings.refine.error},
        {"refine_vertices", run.settings.refine.mostVertices},
        {"seed", run.settings.seed},
        {"threads", run.settings.threads},
        {"memory_limit_mib", run.memoryLimitMib}}},
      {"warnings", run.warnings},
  };
  // Names from a file system need not be UTF-8; the document must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace chiaro
