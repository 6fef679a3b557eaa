// The scene in storage buffers, read by global vertex number.
struct VertexBlock {
  vec4 positionU;
  vec4 normalV;
  vec4 tangent;  // w: handedness, 0 without tangent
};

layout(std430, binding = 0) readonly buffer VertexBuffer { VertexBlock vertices[]; };
layout(std430, binding = 1) readonly buffer IndexBuffer { uint indices[]; };

uvec3 cornersOf(int first) { return uvec3(indices[first], indices[first + 1], indices[first + 2]); }

// Area coordinates of the shaded point, from its position: exact derivatives of nothing are needed, and no varying per weight.
vec3 barycentricOf(uvec3 corners, vec3 p) {
  vec3 a = vertices[corners.x].positionU.xyz;
  vec3 e1 = vertices[corners.y].positionU.xyz - a;
  vec3 e2 = vertices[corners.z].positionU.xyz - a;
  vec3 q = p - a;
  // The area squared has the fourth power of a length: 0 or infinity in float for a scene of nanometres or of light seconds.
  vec3 largest = max(abs(e1), abs(e2));
  float size = max(largest.x, max(largest.y, largest.z));
  if (!(size > 0.0)) return vec3(1.0, 0.0, 0.0);
  e1 /= size;
  e2 /= size;
  q /= size;
  vec3 normal = cross(e1, e2);
  float scale = dot(normal, normal);
  if (!(scale > 0.0)) return vec3(1.0, 0.0, 0.0);
  float v = clamp(dot(cross(q, e2), normal) / scale, 0.0, 1.0);
  float w = clamp(dot(cross(e1, q), normal) / scale, 0.0, 1.0 - v);
  return vec3(1.0 - v - w, v, w);
}
