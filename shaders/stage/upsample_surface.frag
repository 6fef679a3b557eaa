#version 450 core
// What every pixel shows, at full resolution and unshaded.
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/material.glsl"
#include "shaders/stage/shade.glsl"
#include "shaders/stage/surface.glsl"
#include "shaders/stage/upsample_guide.glsl"
#include "shaders/stage/upsample_surface.glsl"

layout(location = 0) out vec4 color;  // what it emits itself
layout(location = 1) out uvec4 place;
layout(location = 2) out uvec4 colors;
layout(location = 3) out uvec4 before;
layout(location = 4) out uint body_;

#if SHAPES
in vec3 positionBefore;
#else
#define positionBefore worldPosition
#endif

uniform int body;
uniform mat4 clipFromWorldBefore;
uniform vec2 size;
uniform vec2 depthScale;

void main() {
  MaterialBlock m = materials[materialIndex];
  vec4 baseColor = baseColorAt(m, texcoord[0]);
  vec2 slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)) / depthUnit(depthScale, gl_FragCoord.z);
  Surface s = surfaceHere(m, baseColor);
  vec3 emission = emissionHere(m, s);
  if (m.textures.y == 1 && baseColor.a < m.emissive.w) discard;

  PackedSurface p = packSurface(s, firstCornerHere(), gl_FrontFacing);
  place = p.place;
  colors = p.colors;
  vec4 clip = clipFromWorldBefore * vec4(positionBefore, 1.0);
  vec3 window = clip.w > 0.0 ? 0.5 * clip.xyz / clip.w + 0.5 : vec3(-1.0);
  before = packMotion(vec3(window.xy * size, window.z), slope);
  body_ = uint(body);
  color = vec4(emission, 1.0);
}
