#version 450 core
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/material.glsl"
#include "shaders/stage/shade.glsl"
#include "shaders/stage/surface.glsl"
#include "shaders/lobe/display.glsl"

#ifdef TAPE
layout(early_fragment_tests) in;  // what is hidden asks nothing
#endif
layout(location = 0) out vec4 color;

const int kDebugAlbedo = 1;
const int kDebugNormal = 2;
const int kDebugRoughness = 3;
const int kDebugVisibility = 4;
const int kDebugSsdf = 5;
const int kDebugUpsampling = 6;  // and above: of what is not done here

vec3 signColor(float distance) {
  float x = distance / kHalfPi;
  return x > 0.0 ? mix(vec3(0.97), vec3(0.13, 0.4, 0.67), x) : mix(vec3(0.97), vec3(0.7, 0.09, 0.17), -x);
}

void main() {
  MaterialBlock m = materials[materialIndex];
  vec4 baseColor = baseColorAt(m, texcoord[0]);
  if (m.textures.y == 1 && baseColor.a < m.emissive.w) discard;

  uvec3 corners = cornersOf(firstCornerHere());
  Transfer t = transferAt(corners, barycentricOf(corners, worldPosition));
  Surface s = surfaceHere(m, baseColor);

  vec3 radiance;
  int debugView = frame.counts.z;
  if (debugView == kDebugAlbedo) radiance = baseColor.rgb;
  else if (debugView == kDebugNormal) radiance = 0.5 * s.n + 0.5;
  else if (debugView == kDebugRoughness) radiance = vec3(s.roughness);
  else if (debugView == kDebugVisibility) radiance = vec3(broadVisibility(t, s.ng));
  else if (debugView == kDebugSsdf) radiance = signColor(ssdfAt(t, 2.0 * dot(s.n, s.wo) * s.n - s.wo));
  else if (debugView >= kDebugUpsampling) radiance = vec3(0.0);
  else {
    vec3 emission = emissionHere(m, s);
    taped(kTapedSurface, s.position, s.alphaT, s.ng);
    taped(kTapedSurface, s.n, s.alphaB, s.t);
    taped(kTapedSurface, s.f0, s.f90, s.diffuse);
    taped(kTapedSurface, emission, 0.0, vec3(0.0));
    radiance = shade(s, t) + emission;
    tapeEnd();
  }
  color = vec4(radiance, m.textures.y == 2 ? baseColor.a : 1.0);
}
