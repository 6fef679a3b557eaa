#version 450 core
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"

// Drawn without vertex attributes: gl_VertexID counts the corners of the global index list.
out vec3 worldPosition;
out vec3 worldNormal;
out vec4 worldTangent;
out vec2 texcoord;
invariant gl_Position;

void main() {
  VertexBlock v = vertices[indices[gl_VertexID]];
  worldPosition = v.positionU.xyz;
  worldNormal = v.normalV.xyz;
  worldTangent = v.tangent;
  texcoord = vec2(v.positionU.w, v.normalV.w);
  gl_Position = frame.clipFromWorld * vec4(v.positionU.xyz, 1.0);
}
