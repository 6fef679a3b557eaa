#version 450 core
// Every pixel's guide, and an estimate of its light: from a few lobes behind one distance to what hides them. What is shaded is filtered as its ratio
// to that, which changes little from pixel to pixel even where highlights and shadow edges do.
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/shade.glsl"
#include "shaders/lobe/upsampling.glsl"
#include "shaders/stage/upsample_guide.glsl"
#include "shaders/stage/upsample_surface.glsl"
#include "shaders/stage/upsample_albedos.glsl"

layout(binding = 0) uniform usampler2D placeTexture;
layout(binding = 1) uniform usampler2D colorsTexture;
layout(binding = 2) uniform usampler2D beforeTexture;
layout(binding = 3) uniform usampler2D bodyTexture;
layout(binding = 13) uniform sampler2D depthTexture;

layout(location = 0) out uvec4 albedos;
layout(location = 1) out uvec4 guide;

uniform int body;
uniform bool estimates;  // else albedos alone
uniform float darkest;   // light that hardly shows, of this environment: not of the exposure, which may change while history is kept

const int kEstimateLobes = 3;

Guide guideOf(Surface s, float depth) {
  Guide g;
  mat3 turn = mat3(frame.environmentFromWorld);
  float alphaT = s.alphaT, alphaB = s.alphaB;
  bool exponent = modelHasExponent(s.kind);
  float width = min(alphaT, alphaB);
  SphericalGaussian lobe = reflectionLobe(s.kind, exponent ? 2.0 / (width * width) - 2.0 : width, s.n, s.wo);
#if CLEARCOAT
  // Of a coat and what lies under it, the sharper.
  if (s.coat > 0.0) {
    SphericalGaussian coat = reflectionLobe(kGgx, clampAlpha(s.coatRoughness * s.coatRoughness), shadingNormalTowards(s.ng, s.wo), s.wo);
    if (coat.sharpness > lobe.sharpness) lobe = coat;
  }
#endif
  g.depth = depth;
  g.normal = turn * s.n;
  g.axis = turn * lobe.axis;
  g.sharpness = lobe.sharpness;
  g.body = body;
  g.age = 0;
  return g;
}

// What a lobe gathers: as lobeRadiance(), with the distance at the middle of all lobes.
vec3 estimatedRadiance(Transfer t, vec3 axis, float sharpness, float distance) {
  vec3 radiance = environmentMean(axis, sharpness);
#if TERM_VECTORS > 0
  if (!shadowed()) return radiance;
  float own = ssdfVisibleFraction(distance, sharpness);
  radiance *= own;
  for (int l = 0; l < frame.counts.x; ++l) {
    float productSharpness;
    vec3 mean = lightMean(l, axis, sharpness, productSharpness);
    if (largestOf(mean) < 1.0e-3 * frame.sgLights[l].amplitude.r) continue;
    float lightSharpness = frame.sgLights[l].axisSharpness.w;
    float lightDistance;
    storedLightShare(t, l, lightSharpness, lightDistance);
    float towards = lightSharpness / (sharpness + lightSharpness);
    radiance += mean * (ssdfVisibleFraction(mix(distance, lightDistance, towards), productSharpness) - own);
  }
  radiance = max(radiance, vec3(0.0));
#endif
  return radiance;
}

vec3 estimatedReflection(Surface s, Transfer t, int kind, float alpha, vec3 n) {
  bool exponent = modelHasExponent(kind);
  float width = exponent ? 2.0 / (alpha * alpha) - 2.0 : alpha;
  float distance = shadowed() ? ssdfAt(t, reflect(-s.wo, n)) : kHalfPi;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < kEstimateLobes; ++i) {
    vec2 lobe = ndfMixtureLobe(kind, width, kEstimateLobes, i);
    if (!(lobe.x > 0.0)) continue;
    SphericalGaussian warped = sgWarpIsotropic(sphericalGaussian(n, lobe.y, 1.0), s.wo);
    float weight = lobe.x * sgUnitIntegral(lobe.y);
    sum += weight * estimatedRadiance(t, warped.axis, warped.sharpness, distance);
    weights += weight;
  }
  return sum / max(weights, 1.0e-20);
}

vec3 estimatedDiffuse(vec3 n) {
  float basis[25];
  shEvaluate(n, basis);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 25; ++i) sum += basis[i] * frame.irradiance[i].rgb;
  sum = max(sum, vec3(0.0));
  for (int l = 0; l < frame.counts.x; ++l) {
    vec4 light = frame.sgLights[l].axisSharpness;
    sum += frame.sgLights[l].amplitude.rgb * (sgUnitIntegral(light.w) * clampedCosineMean(dot(n, light.xyz), light.w));
  }
  return sum * kOneOverPi;
}

void multiplyByEstimate(Surface s, Transfer t, inout Albedos a) {
  vec3 reflection = estimatedReflection(s, t, s.kind, sqrt(s.alphaT * s.alphaB), s.n);
#if CLEARCOAT
  float coat = 1.0 - throughCoat(s);
  if (coat > 0.0)
    reflection = mix(reflection, estimatedReflection(s, t, kGgx, clampAlpha(s.coatRoughness * s.coatRoughness), shadingNormalTowards(s.ng, s.wo)), coat);
#endif
  // In units of the darkest, so that what is kept is light whatever the environment is.
  a.diffuse *= estimatedDiffuse(s.n) / darkest + 1.0;
  a.reflected *= reflection / darkest + 1.0;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uint here = texelFetch(bodyTexture, at, 0).r;
  if (here == kNoBody ? body != 0 : here != uint(body)) discard;
  albedos = uvec4(0u);
  guide = kNoGuide;
  if (here == kNoBody) return;
  PackedSurface p = PackedSurface(texelFetch(placeTexture, at, 0), texelFetch(colorsTexture, at, 0));
  uvec3 corners;
  vec3 barycentric;
  Surface s = unpackSurface(p, 2.0 * gl_FragCoord.xy / vec2(textureSize(placeTexture, 0)) - 1.0, corners, barycentric);
  Albedos a;
  surfaceAlbedo(s, a.diffuse, a.reflected);
  a.slope = slopeOf(texelFetch(beforeTexture, at, 0));
  if (estimates) multiplyByEstimate(s, transferAt(corners, barycentric), a);
  albedos = packAlbedos(a);
  guide = packGuide(guideOf(s, texelFetch(depthTexture, at, 0).r));
}
