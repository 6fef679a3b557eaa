#pragma once
/// How wrong a bake is at every vertex of a scene.

#include <cstdint>
#include <string>
#include <vector>

#include "assets/scene/scene.h"
#include "assets/transfer/transfer.h"
#include "precompute/bake.h"

namespace chiaro {

struct VertexErrorSettings {
  int axes = 8;          ///< random, above each vertex's horizon
  int raysPerLobe = 24;  ///< of the truth, at each sharpness: tells a visible fraction to about .01 on average, which is in every error
  std::uint32_t seed = 0;
  int threads = 0;
};

struct VertexErrors {
  std::vector<float> error;  ///< mean |error| of the visible fraction over axes and kLobeSharpness, by vertex in the order of the primitives
  double mean = 0.0, median = 0.0, percentile95 = 0.0;
};

struct WorstVertex {
  std::size_t vertex = 0;  ///< in the order of the primitives
  std::string mesh;        ///< its name, or "mesh N"
  glm::vec3 position{0.0f}, normal{0.0f};
  double error = 0.0;
};

/// scene: prepared, and what `transfer` was baked from. Same figures for any number of threads.
VertexErrors vertexErrors(const Scene& scene, const Transfer& transfer, const VertexErrorSettings& settings, const ProgressHandler& progress);

/// At most `count`, the worst first, none nearer to a worse one than a fiftieth of the scene's diagonal: places, not one place many times.
std::vector<WorstVertex> worstVertices(const Scene& scene, const VertexErrors& errors, std::size_t count);

}  // namespace chiaro
