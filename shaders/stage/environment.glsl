// Light from all around, by direction and sharpness.
#include "shaders/lobe/equirect.glsl"

layout(binding = 5) uniform samplerCubeArray pyramidTexture;  // layer 0: sharpness finest / 4^mip, layer 1: half of that
layout(binding = 6) uniform sampler2D radianceTexture;

vec3 pyramidLevel(vec3 direction, float index) {
  float mip = floor(0.5 * index);
  return textureLod(pyramidTexture, vec4(direction, index - 2.0 * mip), mip).rgb;
}

vec3 environmentRadiance(vec3 worldDirection) {
  vec3 d = mat3(frame.environmentFromWorld) * worldDirection;
  return textureLod(radianceTexture, equirectFromDirection(d), 0.0).rgb;
}

// Mean radiance under a normalised SG lobe: linear in log2 sharpness between levels; above the finest, towards the map itself, whose
// texels are as good as a lobe of frame.pyramid.z.
vec3 environmentMean(vec3 worldAxis, float sharpness) {
  vec3 d = mat3(frame.environmentFromWorld) * worldAxis;
  float position = frame.pyramid.x - log2(max(sharpness, 1.0e-6));
  if (position < 0.0) {
    float towardsMap = clamp(-position / max(frame.pyramid.z - frame.pyramid.x, 1.0), 0.0, 1.0);
    vec3 map = textureLod(radianceTexture, equirectFromDirection(d), 0.0).rgb;
    return mix(pyramidLevel(d, 0.0), map, towardsMap);
  }
  position = min(position, frame.pyramid.y);
  float finer = min(floor(position), frame.pyramid.y - 1.0);
  return mix(pyramidLevel(d, finer), pyramidLevel(d, finer + 1.0), position - finer);
}
