// Water in and on what is not sealed (after Lagarde, Water drop 3b: Physically based wet surfaces, 2013): what is not metal darkens, as light that
// scatters below a film of water meets the surface more often, and all gets smoother.
layout(binding = 24) uniform sampler2D wetnessTexture;  // runtime/render/wetness.h

const float kDarkest = 0.4;     // of the base colour, soaked
const float kSmoothest = 0.35;  // of the perceptual roughness under water

float wetnessAt(vec3 position) {
  return texture(wetnessTexture, vec2(dot(frame.wetnessS, vec4(position, 1.0)), dot(frame.wetnessT, vec4(position, 1.0)))).r;
}
float wetColor(float wetness, float metallic) { return mix(1.0, kDarkest, wetness * (1.0 - metallic)); }
float wetRoughness(float wetness) { return mix(1.0, kSmoothest, wetness); }
