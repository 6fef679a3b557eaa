// Equirectangular images: +Y up at the top row (v = 0), the image's centre looks along -Z, its right half towards +X.
#ifndef CHIARO_CPP
#include "shaders/lobe/special.glsl"
#endif

// u = 1/2 + atan2(x, -z) / (2 pi) in [0, 1], v = acos(y) / pi in [0, 1]. Any length between 1e-15 and 1e15; the zero vector gives NaN.
// The pole's u is 1/2. The seam (x = 0, z > 0) gives u = 1. v comes from atan2, which is accurate at the poles where acos is not;
// u from its distance to the nearer of 0, 1/2 and 1.
FN Vec2 equirectFromDirection(IN(Vec3) direction) {
  Real ax = abs(direction.x);
  Real az = abs(direction.z);
  Real turn = ax == Real(0.0) && az == Real(0.0) ? Real(0.0) : atanQuadrant(ax, az) / kTwoPi;
  Real u;
  if (direction.z > Real(0.0)) {
    u = direction.x < Real(0.0) ? turn : Real(1.0) - turn;
  } else {
    u = direction.x < Real(0.0) ? Real(0.5) - turn : Real(0.5) + turn;
  }
  Real polar = atanQuadrant(sqrt(direction.x * direction.x + direction.z * direction.z), abs(direction.y)) * kOneOverPi;
  return Vec2(u, direction.y < Real(0.0) ? Real(1.0) - polar : polar);
}

// The unit direction of a point of the image. u in [0, 1] (wrap it first), v taken as clamped to [0, 1].
FN Vec3 directionFromEquirect(IN(Vec2) uv) {
  Real v = clampReal(uv.y, Real(0.0), Real(1.0));
  Real halfTurns = Real(2.0) * uv.x - Real(1.0);
  Real sinPolar = sinPi(v);
  return Vec3(sinPolar * sinPi(halfTurns), cosPi(v), -sinPolar * cosPi(halfTurns));
}
