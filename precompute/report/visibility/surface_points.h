#pragma once
/// Where the visible fraction is measured: at vertices, where transfer is stored, and inside triangles, where it is interpolated.

#include <array>
#include <cstdint>
#include <vector>

#include "precompute/visibility/viewpoints.h"

namespace chiaro {

struct SurfacePoint {
  std::array<std::size_t, 3> vertices{};  ///< of the whole scene, in the order of its primitives; all three equal at a vertex
  std::array<float, 3> weights{1.0f, 0.0f, 0.0f};  ///< barycentric
  Viewpoint view;                                  ///< `front` is used alone: what is below the horizon is hidden
};

/// `wanted` different vertices, or all there are.
std::vector<SurfacePoint> pointsAtVertices(const std::vector<Viewpoint>& viewpoints, std::size_t wanted, std::uint32_t seed);

/// Uniform over the area of the scene; position and normal are interpolated, and the origin is moved off along that normal.
std::vector<SurfacePoint> pointsInTriangles(const Scene& scene, const RayScene& rays, std::size_t wanted, std::uint32_t seed);

/// `wanted` different numbers below `count` (all when there are fewer), in random order.
std::vector<std::size_t> randomSubset(std::size_t count, std::size_t wanted, std::uint32_t seed);

}  // namespace chiaro
