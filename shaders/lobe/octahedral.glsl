// The octahedral map: unit directions <-> the square [0, 1]^2. Project onto |x| + |y| + |z| = 1, keep (x, y) where z >= 0 (the inner
// diamond, +z in the centre), fold the four lower faces outwards where z < 0 (-z at all four corners).
// u = (p.x + 1) / 2, v = (p.y + 1) / 2. A map of `resolution`^2 texels is row-major, texel (i, j) centred at ((i + 1/2), (j + 1/2)) / resolution.
#ifndef CHIARO_CPP
#include "shaders/lobe/special.glsl"
#endif

// direction: any length between 1e-15 and 1e15; the zero vector gives NaN. On the seam (z < 0, x or y = 0, stored twice) the
// positive side is chosen. Distances to the border are computed first, so that they are relatively accurate.
FN Vec2 octahedralEncode(IN(Vec3) direction) {
  Real ax = abs(direction.x);
  Real ay = abs(direction.y);
  Real az = abs(direction.z);
  Real sum = ax + ay + az;
  bool lower = direction.z < Real(0.0);
  Real borderX = Real(0.5) * ((lower ? ay : ay + az) / sum);
  Real borderY = Real(0.5) * ((lower ? ax : ax + az) / sum);
  return Vec2(direction.x < Real(0.0) ? borderX : Real(1.0) - borderX, direction.y < Real(0.0) ? borderY : Real(1.0) - borderY);
}

// Unit direction of a point of the square. Points outside [0, 1]^2 are the caller's mistake: fold them first.
FN Vec3 octahedralDecode(IN(Vec2) uv) {
  Real px = Real(2.0) * uv.x - Real(1.0);
  Real py = Real(2.0) * uv.y - Real(1.0);
  Real z = (Real(1.0) - abs(px)) - abs(py);
  Real x = px;
  Real y = py;
  if (z < Real(0.0)) {
    x = px < Real(0.0) ? abs(py) - Real(1.0) : Real(1.0) - abs(py);
    y = py < Real(0.0) ? abs(px) - Real(1.0) : Real(1.0) - abs(px);
  }
  Vec3 p = Vec3(x, y, z);
  return p / sqrt(dot(p, p));
}

// The texel that a neighbour index beyond the border means: crossing an edge re-enters through the same edge, mirrored about its middle.
// Each coordinate in [-resolution, 2 resolution - 1]; inside it is returned unchanged.
FN IVec2 octahedralWrapTexel(IN(IVec2) texel, IN(int) resolution) {
  int x = texel.x;
  int y = texel.y;
  if (x < 0 || x >= resolution) {
    x = x < 0 ? -1 - x : 2 * resolution - 1 - x;
    y = resolution - 1 - y;
  }
  if (y < 0 || y >= resolution) {
    y = y < 0 ? -1 - y : 2 * resolution - 1 - y;
    x = resolution - 1 - x;
  }
  return IVec2(x, y);
}

// Unit direction of a texel's centre.
FN Vec3 octahedralTexelDirection(IN(IVec2) texel, IN(int) resolution) {
  return octahedralDecode(Vec2((Real(texel.x) + Real(0.5)) / Real(resolution), (Real(texel.y) + Real(0.5)) / Real(resolution)));
}

// Twice the arctangent in the solid angle of the triangle (a, b, c) on the plane x + y + z = 1, x, y, z >= 0 (van Oosterom and Strackee
// 1983). twiceArea, its doubled area seen along z, equals the determinant |a b c| there, so nothing cancels for tiny triangles.
FN Real octahedronTriangleSolidAngle(IN(Vec3) a, IN(Vec3) b, IN(Vec3) c, IN(Real) twiceArea) {
  Real la = sqrt(dot(a, a));
  Real lb = sqrt(dot(b, b));
  Real lc = sqrt(dot(c, c));
  return Real(2.0) * atanQuadrant(twiceArea, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

// Exact solid angle of a texel, sr. resolution even (an odd one would fold texels along the axes). The map sums to 4 pi.
FN Real octahedralTexelSolidAngle(IN(IVec2) texel, IN(int) resolution) {
  int middle = resolution / 2;
  // Steps from the centre, first quadrant, then the lower half mirrored into the upper one.
  int i = texel.x < middle ? middle - 1 - texel.x : texel.x - middle;
  int j = texel.y < middle ? middle - 1 - texel.y : texel.y - middle;
  if (i + j >= middle) {
    int fold = i;
    i = middle - 1 - j;
    j = middle - 1 - fold;
  }
  Real texelSize = Real(1.0) / Real(middle);
  Real x0 = Real(i) * texelSize;
  Real y0 = Real(j) * texelSize;
  Real x1 = Real(i + 1) * texelSize;
  Real y1 = Real(j + 1) * texelSize;
  Real twiceArea = texelSize * texelSize;
  Vec3 nearX = Vec3(x1, y0, Real(middle - 1 - i - j) * texelSize);
  Vec3 nearY = Vec3(x0, y1, Real(middle - 1 - i - j) * texelSize);
  Real inner = octahedronTriangleSolidAngle(Vec3(x0, y0, Real(middle - i - j) * texelSize), nearX, nearY, twiceArea);
  // The diagonal texels straddle the equator: their outer half mirrors their inner one.
  if (i + j == middle - 1) return Real(2.0) * inner;
  return inner + octahedronTriangleSolidAngle(Vec3(x1, y1, Real(middle - 2 - i - j) * texelSize), nearX, nearY, twiceArea);
}
