#version 450 core
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/material.glsl"

// Drawn without vertex attributes: gl_VertexID counts the corners of the global index list.
out vec3 worldPosition;
out vec3 worldNormal;
out vec4 worldTangent;
out vec2 texcoord[kTextures];  // by binding
#ifndef SHAPES
#define SHAPES 0
#endif
#if SHAPES
layout(std430, binding = 10) readonly buffer BeforeBuffer { vec4 positionsBefore[]; };
out vec3 positionBefore;  // in the frame before
#endif
invariant gl_Position;

void main() {
  VertexBlock v = vertices[indices[gl_VertexID]];
  worldPosition = v.positionU.xyz;
  worldNormal = v.normalV.xyz;
  worldTangent = v.tangent;
  vec2 uv = vec2(v.positionU.w, v.normalV.w);
  MaterialBlock m = materials[materialIndex];
  for (int binding = 0; binding < kTextures; ++binding) texcoord[binding] = movedTexcoord(m, binding, uv);
#if SHAPES
  positionBefore = positionsBefore[indices[gl_VertexID]].xyz;
#endif
  gl_Position = frame.clipFromWorld * vec4(v.positionU.xyz, 1.0);
}
