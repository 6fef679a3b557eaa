// A surface point's precomputed transfer: its corners' clusters and weights, and their visible fractions, interpolated.
//
// Set when the program is built for a scene (runtime/render/gpu_transfer.cpp): TERM_VECTORS, the most vec4 of terms a cluster has (0:
// nothing is occluded); DIRECTION_VECTORS; SLOTS, 1 where there is one cluster, else 3, as the corners of a triangle may be in different
// ones; WEIGHT_BITS; SSDF_SOFTNESS; LEVELS of prefiltered visibility.
#include "shaders/lobe/prefiltered.glsl"
#include "shaders/lobe/octahedral.glsl"

#if TERM_VECTORS > 0
layout(std430, binding = 3) readonly buffer WeightBuffer { uint packedWeights[]; };
layout(std430, binding = 6) readonly buffer VertexTransferBuffer { uvec2 vertexTransfer[]; };  // cluster, first word of its weights
layout(std430, binding = 7) readonly buffer ClusterBuffer { uvec2 clusterCells[]; };   // first cell, cells
layout(binding = 7) uniform sampler2DArray ssdfTerms;   // 4 terms a cell, times the weights' scale; each map with a border of one texel
layout(binding = 8) uniform sampler2DArray ssdfMeans;
#if LEVELS > 0
layout(binding = 11) uniform sampler2DArray levelTerms;  // all levels of a term on top of each other
layout(binding = 12) uniform sampler2DArray levelMeans;
const int kLevelResolutions[LEVELS] = LEVEL_RESOLUTIONS;
const int kLevelRows[LEVELS] = LEVEL_ROWS;
#endif
#endif
layout(std430, binding = 4) readonly buffer VisibilityBuffer { uint packedVisibility[]; };  // 4 x 8 bit a word

struct Transfer {
  uvec3 corners;
  vec3 barycentric;
#if TERM_VECTORS > 0
  // Clusters that its corners are in: each with the sum of the corners' shares and of their weights times these.
  int slots;
  uint cluster[SLOTS];
  float share[SLOTS];
  vec4 weights[SLOTS * TERM_VECTORS];
#endif
  vec4 visibility[DIRECTION_VECTORS];
};

#if TERM_VECTORS > 0
#if WEIGHT_BITS == 8
vec4 weightsAt(uint firstWord, int vector) { return unpackSnorm4x8(packedWeights[firstWord + uint(vector)]); }
#else
vec4 weightsAt(uint firstWord, int vector) {
  uint word = firstWord + 2u * uint(vector);
  return vec4(unpackSnorm2x16(packedWeights[word]), unpackSnorm2x16(packedWeights[word + 1u]));
}
#endif

void addCorner(inout Transfer t, uint vertex, float share) {
  uvec2 own = vertexTransfer[vertex];
  int slot = 0;
#if SLOTS > 1
  while (slot < t.slots && t.cluster[slot] != own.x) ++slot;
#else
  slot = min(t.slots, 0);
#endif
  int vectors = int(clusterCells[own.x].y);
  if (slot == t.slots) {
    t.slots = slot + 1;
    t.cluster[slot] = own.x;
    t.share[slot] = 0.0;
    for (int k = 0; k < vectors; ++k) t.weights[slot * TERM_VECTORS + k] = vec4(0.0);
  }
  t.share[slot] += share;
  for (int k = 0; k < vectors; ++k) t.weights[slot * TERM_VECTORS + k] += share * weightsAt(own.y, k);
}

// Where a direction is in a bordered map, texels.
vec2 mapTexel(vec3 direction, int resolution) { return octahedralEncode(direction) * float(resolution) + 1.0; }

vec3 cellCoordinate(vec2 texel, vec2 size, int columns, uint cell) {
  return vec3((texel.x / size.x + float(cell % uint(columns))) / float(columns), texel.y / size.y, float(cell / uint(columns)));
}

// The mean and the terms of every slot at a texel of their cells.
float lookUp(Transfer t, sampler2DArray means, sampler2DArray terms, vec2 texel, vec2 size, int columns) {
  float sum = 0.0;
  for (int s = 0; s < t.slots; ++s) {
    uvec2 cells = clusterCells[t.cluster[s]];
    sum += t.share[s] * textureLod(means, cellCoordinate(texel, size, columns, t.cluster[s]), 0.0).r;
    for (uint k = 0u; k < cells.y; ++k)
      sum += dot(t.weights[s * TERM_VECTORS + int(k)], textureLod(terms, cellCoordinate(texel, size, columns, cells.x + k), 0.0));
  }
  return sum;
}
#endif

Transfer transferAt(uvec3 corners, vec3 barycentric) {
  Transfer t;
  t.corners = corners;
  t.barycentric = barycentric;
#if TERM_VECTORS > 0
  t.slots = 0;
  for (int c = 0; c < 3; ++c) addCorner(t, corners[c], barycentric[c]);
#endif
  for (int k = 0; k < DIRECTION_VECTORS; ++k) {
    vec4 sum = vec4(0.0);
    for (int c = 0; c < 3; ++c) sum += barycentric[c] * unpackUnorm4x8(packedVisibility[corners[c] * uint(DIRECTION_VECTORS) + uint(k)]);
    t.visibility[k] = sum;
  }
  return t;
}

// The SSDF at a world direction, radians: as stored it is linear in the weights, so interpolated weights give the interpolated one.
float ssdfAt(Transfer t, vec3 direction) {
#if TERM_VECTORS > 0
  return ssdfExpanded(lookUp(t, ssdfMeans, ssdfTerms, mapTexel(direction, SSDF_RESOLUTION), vec2(SSDF_RESOLUTION + 2), SSDF_COLUMNS), SSDF_SOFTNESS);
#else
  return kHalfPi;
#endif
}

#if TERM_VECTORS > 0 && LEVELS > 0
float levelAt(Transfer t, int level, vec3 direction) {
  vec2 texel = mapTexel(direction, kLevelResolutions[level]) + vec2(0.0, float(kLevelRows[level]));
  return clamp(lookUp(t, levelMeans, levelTerms, texel, vec2(LEVEL_WIDTH, LEVEL_HEIGHT), LEVEL_COLUMNS), 0.0, 1.0);
}

// Share of a lobe of that source that the levels give.
float levelShareAt(Transfer t, vec3 axis, VisibilitySource source) {
  float share = levelAt(t, source.level, axis);
  if (source.next > 0.0) share = mix(share, levelAt(t, source.level + 1, axis), source.next);
  return share;
}

VisibilitySource sourceOf(float sharpness) { return visibilitySource(sharpness, LEVELS, LEVEL_FIRST, LEVEL_RATIO); }
#endif
