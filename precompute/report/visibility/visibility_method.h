#pragma once
/// A way to store what each vertex sees, as the comparison asks it: how much of a lobe arrives, and what does that cost.

#include <functional>
#include <string>
#include <vector>

#include "precompute/report/visibility/lobe.h"
#include "precompute/report/visibility/surface_points.h"

namespace chiaro {

/// Of what a file would have to hold: weights and indices of each vertex; means, basis functions and scales once.
struct StoredBytes {
  double eachVertex = 0.0;
  double shared = 0.0;
  double perVertex(std::size_t vertexCount) const { return eachVertex + shared / static_cast<double>(vertexCount); }
};

/// The visible fraction of a lobe at one point: integral of G V over integral of G, the horizon included. Not clamped.
using LobeFraction = std::function<double(const Lobe&)>;

/// at() is called from many threads at once.
class VisibilityMethod {
 public:
  VisibilityMethod() = default;
  VisibilityMethod(const VisibilityMethod&) = delete;
  VisibilityMethod& operator=(const VisibilityMethod&) = delete;
  virtual ~VisibilityMethod() = default;

  virtual std::string name() const = 0;
  virtual StoredBytes bytes() const = 0;
  /// From what is stored at the corners of the point's triangle, interpolated. The function must not outlive this object or `point`.
  virtual LobeFraction at(const SurfacePoint& point) const = 0;
};

/// What the methods are made from. Only `encoded` vertices are ever asked for; shared bases are computed from `basis` alone (with
/// more than 12 vertices a term a subset costs 2 % in rms, ALGORITHMS 3.7).
struct VisibilityInput {
  const RayScene& rays;
  const std::vector<Viewpoint>& viewpoints;  ///< of every vertex
  std::vector<std::size_t> encoded{};        ///< increasing
  std::vector<std::size_t> basis{};
  int resolution = 64;  ///< octahedral texels a side of stored maps
  int terms = 48;
  std::uint32_t seed = 0;
  int threads = 0;
};

/// Position of `vertex` in VisibilityInput::encoded. The vertex must be there.
std::size_t slotOf(const std::vector<std::size_t>& encoded, std::size_t vertex);

/// 16-bit fixed point: what `value` becomes in units of scale / 32767.
float rounded16(float value, float scale);

}  // namespace chiaro
