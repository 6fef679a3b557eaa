#pragma once
/// Visibility in octahedral maps: signed distances or visibility itself, compressed by one PCA for all vertices or not at all.

#include <memory>

#include "precompute/report/visibility/traced_vertices.h"
#include "precompute/report/visibility/visibility_method.h"

namespace chiaro {

/// The fraction of a lobe from a (decoded, interpolated) map of `resolution`^2 texels.
using MapFraction = double (*)(const float* map, int resolution, const SurfacePoint& point, const Lobe& lobe);

/// What is in the maps and what is made of it.
struct MapKind {
  std::string name;
  float range = 1.0f;  ///< largest magnitude of a value
  VertexMap map = nullptr;
  MapFraction fraction = nullptr;
};

/// Wang et al. 2009: the horizon is part of the SSDF; f_h of the distance at the axis.
MapKind ssdfWithHorizon();
/// As a bake stores it: the SSDF of other surfaces; f_h of the distance at the axis, times that of the point's own horizon.
MapKind ssdfOfOccluders();
/// 0 or 1; the map is integrated against the lobe.
MapKind binaryVisibility();

/// VisibilityInput::terms components of the maps of VisibilityInput::basis, columns weighted by solid angle; 16-bit weights with one scale
/// a term, half-float functions, float mean.
std::unique_ptr<VisibilityMethod> makePcaMethod(const VisibilityInput& input, const TracedVertices& traced, const MapKind& kind);

/// 16 bits a texel: what compression can at best be as good as.
std::unique_ptr<VisibilityMethod> makeUncompressedMethod(const VisibilityInput& input, const TracedVertices& traced,
                                                         const MapKind& kind);

/// f_h of the horizon alone, no byte stored: what ignoring all shadows costs.
std::unique_ptr<VisibilityMethod> makeUnoccludedMethod();

}  // namespace chiaro
