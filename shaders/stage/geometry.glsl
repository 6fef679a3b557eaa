// The scene in storage buffers, read by global vertex number.
struct VertexBlock {
  vec4 positionU;
  vec4 normalV;
  vec4 tangent;  // w: handedness, 0 without tangent
};

layout(std430, binding = 0) readonly buffer VertexBuffer { VertexBlock vertices[]; };
layout(std430, binding = 1) readonly buffer IndexBuffer { uint indices[]; };
