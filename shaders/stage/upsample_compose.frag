#version 450 core
// Gives the filtered light its albedos back and adds it to what the surface emits; or shows how it came about.
#include "shaders/stage/upsample_guide.glsl"
#include "shaders/stage/upsample_albedos.glsl"

layout(binding = 0) uniform usampler2D guideTexture;
layout(binding = 1) uniform usampler2D albedosTexture;
layout(binding = 2) uniform sampler2D diffuseTexture;
layout(binding = 3) uniform sampler2D reflectedTexture;
layout(binding = 4) uniform usampler2D keptGuide;
layout(binding = 5) uniform sampler2D qualityTexture;
uniform int view;

const int kTotalWeight = 6;
const int kAge = 7;
const int kRecomputed = 8;

layout(location = 0) out vec4 color;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  Guide g = unpackGuide(texelFetch(guideTexture, at, 0));
  if (g.depth >= 1.0) discard;
  vec4 quality = texelFetch(qualityTexture, at, 0);
  Albedos a = unpackAlbedos(texelFetch(albedosTexture, at, 0));
  if (view == kTotalWeight) color = vec4(vec3(quality.x), 1.0);
  else if (view == kAge) color = vec4(vec3(float(unpackGuide(texelFetch(keptGuide, at, 0)).age) / 32.0), 1.0);
  else if (view == kRecomputed) color = vec4(mix(vec3(quality.x), vec3(1.0, 0.1, 0.05), quality.z), 1.0);
  else {
    color = vec4(withAlbedo(texelFetch(diffuseTexture, at, 0).rgb, a.diffuse) + withAlbedo(texelFetch(reflectedTexture, at, 0).rgb, a.reflected), 0.0);
  }
}
