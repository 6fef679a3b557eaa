#version 450 core
// Shades one pixel of every coarse cell, or with RECOMPUTE the pixels of a list: diffuse and reflected light apart, both without the material's albedo.
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/shade.glsl"
#include "shaders/lobe/upsampling.glsl"
#include "shaders/stage/upsample_guide.glsl"
#include "shaders/stage/upsample_surface.glsl"
#include "shaders/stage/upsample_albedos.glsl"

layout(binding = 0) uniform usampler2D placeTexture;
layout(binding = 1) uniform usampler2D colorsTexture;
layout(binding = 2) uniform usampler2D albedosTexture;
layout(binding = 3) uniform usampler2D guideTexture;

uniform int body;

#ifdef RECOMPUTE
#include "shaders/stage/upsample_list.glsl"
layout(binding = 0, rgba32f) uniform writeonly image2D diffuseImage;
layout(binding = 1, rgba32f) uniform writeonly image2D reflectedImage;
layout(binding = 2, rgba32ui) uniform writeonly uimage2D guideImage;
layout(binding = 3, rgba16f) uniform image2D qualityImage;
uniform uint budget;
#else
#include "shaders/stage/upsample_history.glsl"
layout(binding = 13) uniform usampler2D beforeTexture;
layout(location = 0) out vec4 diffuseLight_;    // a: how much the frame before was off here
layout(location = 1) out vec4 reflectedLight_;
layout(location = 2) out uvec4 guide_;
uniform ivec2 jitter;
uniform int cell;
uniform float darkest;  // light that hardly shows

float change(vec3 now, vec3 then) {
  vec3 difference = abs(now - then);
  return largestOf(difference) / (0.5 * (largestOf(now) + largestOf(then)) + darkest);
}
#endif

void main() {
  ivec2 size = textureSize(guideTexture, 0);
#ifdef RECOMPUTE
  uint index = uint(gl_FragCoord.y) * uint(size.x) + uint(gl_FragCoord.x);
  if (index >= min(listed, budget)) discard;
  ivec2 at = ivec2(int(list[index]) % size.x, int(list[index]) / size.x);
#else
  ivec2 at = min(ivec2(gl_FragCoord.xy) * cell + jitter, size - 1);
#endif
  uvec4 words = texelFetch(guideTexture, at, 0);
  Guide g = unpackGuide(words);
#ifdef RECOMPUTE
  if (g.body != body) discard;
#else
  if (g.depth >= 1.0) {
    if (body != 0) discard;
    diffuseLight_ = reflectedLight_ = vec4(0.0);
    guide_ = words;
    return;
  }
  if (g.body != body) discard;
#endif
  PackedSurface p = PackedSurface(texelFetch(placeTexture, at, 0), texelFetch(colorsTexture, at, 0));
  Albedos a = unpackAlbedos(texelFetch(albedosTexture, at, 0));
  uvec3 corners;
  vec3 barycentric;
  Surface s = unpackSurface(p, 2.0 * (vec2(at) + 0.5) / vec2(size) - 1.0, corners, barycentric);
  vec3 diffusePart;
  vec3 radiance = shade(s, transferAt(corners, barycentric), diffusePart);
  vec3 diffuseLight = withoutAlbedo(diffusePart, a.diffuse);
  vec3 reflectedLight = withoutAlbedo(radiance - diffusePart, a.reflected);
#ifdef RECOMPUTE
  imageStore(diffuseImage, at, vec4(diffuseLight, 1.0));
  imageStore(reflectedImage, at, vec4(reflectedLight, 1.0));
  imageStore(guideImage, at, words);
  imageStore(qualityImage, at, vec4(imageLoad(qualityImage, at).x, 0.0, 1.0, 0.0));
#else
  History h = historyAt(g, a.slope, positionBeforeOf(texelFetch(beforeTexture, at, 0)));
  // What was only interpolated then may be wrong without any change in the light.
  vec2 proof = min(2.0 * h.worth, vec2(1.0));
  proof *= proof;
  diffuseLight_ = vec4(diffuseLight, proof.x * change(diffuseLight, h.diffuse));
  reflectedLight_ = vec4(reflectedLight, proof.y * change(reflectedLight, h.reflected));
  guide_ = words;
#endif
}
