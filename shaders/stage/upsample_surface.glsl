// A Surface in two texels, so that any pass may shade any pixel: its triangle, and what its textures say.
struct PackedSurface {
  uvec4 place;     // first corner in the index list and the side (top bit), normal, widths, tangent angle and kind and coat's roughness
  uvec4 colors;    // halves: diffuse, F90, F0, coat; with a sheen roots in 10 bits: diffuse, F0, then F90 and coat, then the sheen and its roughness in 8
};

#if SHEEN
uint packedColor(vec3 color, float bits) {
  uvec3 steps = uvec3(sqrt(clamp(color, vec3(0.0), vec3(1.0))) * (exp2(bits) - 1.0) + 0.5);
  uint shift = uint(bits);
  return steps.r | steps.g << shift | steps.b << (2u * shift);
}
vec3 unpackedColor(uint packed, float bits) {
  uint shift = uint(bits), mask = (1u << shift) - 1u;
  vec3 roots = vec3(packed & mask, packed >> shift & mask, packed >> (2u * shift) & mask) / (exp2(bits) - 1.0);
  return roots * roots;
}
#endif

const float kTangentSteps = 65535.0;

PackedSurface packSurface(Surface s, int firstCorner, bool front) {
  PackedSurface p;
  vec3 x = anyTangent(s.n);
  float angle = atan(dot(s.t, cross(s.n, x)), dot(s.t, x)) / kTwoPi;
  uint turn = uint((angle - floor(angle)) * kTangentSteps + 0.5) & 0xffffu;
  uint coatRoughness = 0u;
  float coat = 0.0;
#if CLEARCOAT
  coat = s.coat;
  coatRoughness = uint(s.coatRoughness * 4095.0 + 0.5);
#endif
  p.place = uvec4(uint(firstCorner) | (front ? 0u : 0x80000000u), packedDirection(s.n), packUnorm2x16(sqrt(vec2(s.alphaT, s.alphaB))),
                  turn | uint(s.kind) << 16 | (s.bumped ? 0x80000u : 0u) | coatRoughness << 20);
#if SHEEN
  p.colors = uvec4(packedColor(s.diffuse, 10.0), packedColor(s.f0, 10.0), packHalf2x16(vec2(s.f90, coat)),
                   packedColor(s.sheen, 8.0) | uint(s.sheenRoughness * 255.0 + 0.5) << 24);
#else
  p.colors = uvec4(packHalf2x16(s.diffuse.rg), packHalf2x16(vec2(s.diffuse.b, s.f90)), packHalf2x16(s.f0.rg), packHalf2x16(vec2(s.f0.b, coat)));
#endif
  return p;
}

// Where the pixel's line of sight meets the plane of its triangle. `ndc` in [-1, 1].
vec3 pointOnTriangle(uvec3 corners, vec2 ndc) {
  vec4 near = frame.worldFromClip * vec4(ndc, -1.0, 1.0);
  vec4 far = frame.worldFromClip * vec4(ndc, 1.0, 1.0);
  vec3 from = near.xyz / near.w;
  vec3 way = normalize(far.xyz / far.w - from);
  vec3 a = vertices[corners.x].positionU.xyz;
  vec3 e1 = vertices[corners.y].positionU.xyz - a;
  vec3 e2 = vertices[corners.z].positionU.xyz - a;
  // By its largest side, as in barycentricOf().
  vec3 largest = max(abs(e1), abs(e2));
  float size = max(largest.x, max(largest.y, largest.z));
  vec3 normal = size > 0.0 ? cross(e1 / size, e2 / size) : vec3(0.0);
  float slant = dot(way, normal);
  return slant != 0.0 ? from + way * (dot(a - from, normal) / slant) : a;
}

Surface unpackSurface(PackedSurface p, vec2 ndc, out uvec3 corners, out vec3 barycentric) {
  Surface s;
  corners = cornersOf(int(p.place.x & 0x7fffffffu));
  barycentric = barycentricOf(corners, pointOnTriangle(corners, ndc));
  VertexBlock a = vertices[corners.x], b = vertices[corners.y], c = vertices[corners.z];
  s.position = barycentric.x * a.positionU.xyz + barycentric.y * b.positionU.xyz + barycentric.z * c.positionU.xyz;
  vec3 normal = normalize(barycentric.x * a.normalV.xyz + barycentric.y * b.normalV.xyz + barycentric.z * c.normalV.xyz);
  s.ng = (p.place.x & 0x80000000u) != 0u ? -normal : normal;
  s.wo = frame.eye.w > 0.5 ? normalize(frame.eye.xyz - s.position) : frame.eye.xyz;
  s.n = unpackedDirection(p.place.y);
  vec3 x = anyTangent(s.n);
  float turn = float(p.place.w & 0xffffu) * (kTwoPi / kTangentSteps);
  s.t = x * cos(turn) + cross(s.n, x) * sin(turn);
  s.b = cross(s.n, s.t);
  vec2 width = unpackUnorm2x16(p.place.z);
  s.roughness = min(width.x, width.y);
  s.alphaT = clampAlpha(width.x * width.x);
  s.alphaB = clampAlpha(width.y * width.y);
  s.kind = int(p.place.w >> 16 & 7u);
  s.bumped = (p.place.w & 0x80000u) != 0u;
#if SHEEN
  s.diffuse = unpackedColor(p.colors.x, 10.0);
  s.f0 = unpackedColor(p.colors.y, 10.0);
  s.sheen = unpackedColor(p.colors.w, 8.0);
  s.sheenRoughness = max(float(p.colors.w >> 24) / 255.0, 0.07);
  vec2 bf = unpackHalf2x16(p.colors.z);
  s.f90 = bf.x;
#else
  vec2 rg = unpackHalf2x16(p.colors.x), bf = unpackHalf2x16(p.colors.y);
  s.diffuse = vec3(rg, bf.x);
  s.f90 = bf.y;
  rg = unpackHalf2x16(p.colors.z);
  bf = unpackHalf2x16(p.colors.w);
  s.f0 = vec3(rg, bf.x);
#endif
#if CLEARCOAT
  s.coat = bf.y;
  s.coatRoughness = float(p.place.w >> 20) / 4095.0;
#endif
  return s;
}
