#version 450 core
// Puts the pixels above the cut on the list.
#include "shaders/stage/upsample_list.glsl"

layout(binding = 0) uniform sampler2D qualityTexture;
uniform uint budget;

// Of the pixels at the cut an even choice, another for each frame.
uniform uint seed;
float noise(uvec2 at) {
  uint x = (at.x * 0x8da6b343u) ^ (at.y * 0xd8163841u) ^ (seed * 0xcb1ab31fu);
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return float(x) * (1.0 / 4294967296.0);
}

void main() {
  uvec2 at = uvec2(gl_FragCoord.xy);
  int step = urgencyStep(texelFetch(qualityTexture, ivec2(at), 0).y);
  if (step < 0 || step < cut || step == cut && noise(at) >= cutShare) return;
  uint place = atomicAdd(listed, 1u);
  if (place < budget) list[place] = at.y * uint(textureSize(qualityTexture, 0).x) + at.x;
}
