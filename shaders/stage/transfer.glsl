// A surface point's precomputed transfer: its vertices' PCA weights and visible fractions, interpolated.
// TERM_VECTORS, DIRECTION_VECTORS: numbers of vec4 of each, set when the program is built for a scene; 0 terms: nothing is occluded.
#include "shaders/lobe/ssdf.glsl"
#include "shaders/lobe/octahedral.glsl"

#if TERM_VECTORS > 0
layout(std430, binding = 3) readonly buffer WeightBuffer { uint packedWeights[]; };        // 2 x int16 a word
layout(std430, binding = 5) readonly buffer LightEigenBuffer { vec4 lightEigen[]; };        // per SG light: TERM_VECTORS values at its axis
layout(binding = 7) uniform sampler2DArray eigenTexture;   // 4 eigenfunctions a layer, times the weight scale; border of one texel
layout(binding = 8) uniform sampler2D meanTexture;
#endif
layout(std430, binding = 4) readonly buffer VisibilityBuffer { uint packedVisibility[]; };  // 4 x 8 bit a word

struct Transfer {
#if TERM_VECTORS > 0
  vec4 weights[TERM_VECTORS];
#endif
  vec4 visibility[DIRECTION_VECTORS];
};

Transfer transferAt(uvec3 corners, vec3 barycentric) {
  Transfer t;
#if TERM_VECTORS > 0
  for (int k = 0; k < TERM_VECTORS; ++k) {
    vec4 sum = vec4(0.0);
    for (int c = 0; c < 3; ++c) {
      uint at = (corners[c] * uint(TERM_VECTORS) + uint(k)) * 2u;
      sum += barycentric[c] * vec4(unpackSnorm2x16(packedWeights[at]), unpackSnorm2x16(packedWeights[at + 1u]));
    }
    t.weights[k] = sum;
  }
#endif
  for (int k = 0; k < DIRECTION_VECTORS; ++k) {
    vec4 sum = vec4(0.0);
    for (int c = 0; c < 3; ++c) sum += barycentric[c] * unpackUnorm4x8(packedVisibility[corners[c] * uint(DIRECTION_VECTORS) + uint(k)]);
    t.visibility[k] = sum;
  }
  return t;
}

// The SSDF at a world direction, radians: linear in the weights, so interpolated weights give the interpolated distance.
float ssdfAt(Transfer t, vec3 direction) {
#if TERM_VECTORS > 0
  vec2 inner = vec2(textureSize(meanTexture, 0)) - 2.0;
  vec2 uv = (octahedralEncode(direction) * inner + 1.0) / (inner + 2.0);
  float distance = textureLod(meanTexture, uv, 0.0).r;
  for (int k = 0; k < TERM_VECTORS; ++k) distance += dot(t.weights[k], textureLod(eigenTexture, vec3(uv, float(k)), 0.0));
  return distance;
#else
  return kHalfPi;
#endif
}

float ssdfAtLight(Transfer t, int light) {
#if TERM_VECTORS > 0
  float distance = frame.sgLights[light].amplitude.w;
  for (int k = 0; k < TERM_VECTORS; ++k) distance += dot(t.weights[k], lightEigen[light * TERM_VECTORS + k]);
  return distance;
#else
  return kHalfPi;
#endif
}
