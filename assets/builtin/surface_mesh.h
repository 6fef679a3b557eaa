#pragma once
/// Triangle meshes of surfaces given by a formula.

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro::builtin {

/// A point of the surface, metres, from parameters (u, v) in [0,1]^2.
using SurfaceFunction = std::function<glm::dvec3(double u, double v)>;

/// How a parameter patch becomes a grid of vertices.
struct Patch {
  int columns = 1;                     ///< cells along u
  int rows = 1;                        ///< cells along v
  glm::dvec2 texcoordScale{1.0, 1.0};  ///< texture coordinates are (u, v) times this
  /// Where grid row j lies in v; empty: evenly. rows + 1 increasing values from 0 to 1.
  std::vector<double> rowParameters;
};

/// Appends a patch. Normals point along cross(dP/du, dP/dv) where `outward` is 1 and against it where it is -1; tangents point along dP/du;
/// both come from the formula by central differences. Cells that shrink to a line or a point leave out their empty triangles.
void addPatch(Primitive& primitive, const Patch& patch, const SurfaceFunction& surface, double outward);

/// Takes out vertices that no triangle uses: one at each pole of a patch. All attributes must be there.
void dropUnusedVertices(Primitive& primitive);

/// An outline in a plane (x = distance from the axis, y = height), of straight lines whose corners are rounded, so that the surface it
/// sweeps has a continuous normal.
class RoundedOutline {
 public:
  struct Corner {
    glm::dvec2 at;
    double radius;  ///< of the fillet; shrunk where the lines are too short for it
  };
  explicit RoundedOutline(const std::vector<Corner>& corners);

  double length() const { return length_; }
  /// The point at a share of the length, [0,1].
  glm::dvec2 at(double share) const;
  /// Parameters that put points at most `step` apart, closer on the fillets (at most `turn` radians between points).
  std::vector<double> parameters(double step, double turn) const;

 private:
  struct Piece {
    glm::dvec2 from, to;
    glm::dvec2 center;
    double radius;  ///< 0: a line
    double startAngle;
    double sweep;  ///< radians, signed
    double length;
  };
  std::vector<Piece> pieces_;
  double length_ = 0.0;
};

}  // namespace chiaro::builtin
