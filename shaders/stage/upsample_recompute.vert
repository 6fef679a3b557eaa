#version 450 core
// As many rows of the target as the list fills.
#include "shaders/stage/upsample_list.glsl"
uniform uint budget;
uniform ivec2 size;

void main() {
  uint count = min(listed, budget);
  float rows = float((count + uint(size.x) - 1u) / uint(size.x));
  float top = -1.0 + 2.0 * rows / float(size.y);
  gl_Position = vec4((gl_VertexID & 1) == 1 ? 1.0 : -1.0, (gl_VertexID & 2) == 2 ? top : -1.0, 0.0, 1.0);
}
