#version 450 core
// What each vertex sees of each SG light: the SSDF at its axis, and what the levels say of its lobe. Both are linear in the transfer, so
// pixels interpolate them instead of looking the light up themselves.
#include "shaders/stage/frame.glsl"
#include "shaders/stage/transfer.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 5) writeonly buffer LightVisibilityBuffer { uint lightVisibility[]; };  // per vertex and light: two halves

uniform int rowGroups;
uniform uint firstVertex;
uniform uint vertexCount;

void main() {
  uint vertex = (gl_WorkGroupID.y * uint(rowGroups) + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  if (vertex >= vertexCount) return;
  vertex += firstVertex;
  Transfer t;
  t.slots = 0;
  addCorner(t, vertex, 1.0);
  for (int l = 0; l < frame.counts.x; ++l) {
    vec4 light = frame.sgLights[l].axisSharpness;
    vec2 seen = vec2(0.0, 1.0);
#if LEVELS > 0
    VisibilitySource source = sourceOf(light.w);
    if (source.ssdf < 1.0) seen.y = levelShareAt(t, light.xyz, source);
#endif
    seen.x = ssdfAt(t, light.xyz);
    lightVisibility[vertex * uint(frame.counts.x) + uint(l)] = packHalf2x16(seen);
  }
}
