#version 450 core
// Every pixel's guide, and an estimate of its light. Reflected: SG lights sharper than the reflection by the BRDF and their own shadows, the rest of
// the environment through a few lobes past one distance to what hides them. Diffuse: SG lights with their shadows, the rest unhidden. What is shaded
// is filtered as its ratio to that, which changes little from pixel to pixel even where highlights and shadow edges do.
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/shade.glsl"
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
uniform bool estimates;  // else divisors are albedos
uniform float darkest;   // light that hardly shows, of this environment: not of the exposure, which may change while history is kept

const int kEstimateLobes = 3;

Guide guideOf(Surface s, float depth) {
  Guide g;
  mat3 turn = mat3(frame.environmentFromWorld);
  SphericalGaussian lobe = reflectionLobe(s.kind, modelParameter(s.kind, narrowerAlpha(s)), s.n, s.wo);
#if CLEARCOAT
  // Of a coat and what lies under it, the sharper.
  if (s.coat > 0.0) {
    Surface top = coatOf(s);
    SphericalGaussian coat = reflectionLobe(kGgx, top.alphaT, top.n, s.wo);
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

// Share of an SG light that the BRDF itself gives: of lights sharper than the reflection, where few lobes have no tails; broader ones it would blur.
// A sheen's share of the light is its own.
float brdfShare(Surface s, int l) {
#if SHEEN
  if (largestOf(s.sheen) > 0.0) return 0.0;
#endif
  return smoothstep(0.5, 2.0, 2.0 * s.alphaT * s.alphaB * frame.sgLights[l].axisSharpness.w);
}

// Visible share of the product of a lobe and an SG light; `distance` is the SSDF at the lobe's axis.
float shareBetween(Transfer t, int l, SphericalGaussian lobe, float productSharpness, float distance) {
  float lightSharpness = frame.sgLights[l].axisSharpness.w;
  float lightDistance;
  storedLightShare(t, l, lightSharpness, lightDistance);
  return ssdfVisibleFraction(mix(distance, lightDistance, lightSharpness / (lobe.sharpness + lightSharpness)), productSharpness);
}

// Mean of what the view's lobes see, past the distance at their middle, but for what SG lights give directly.
vec3 estimatedMean(Surface s, Transfer t) {
  float width = modelParameter(s.kind, sqrt(s.alphaT * s.alphaB));
  float distance = shadowed() ? ssdfAt(t, reflect(-s.wo, s.n)) : kHalfPi;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < kEstimateLobes; ++i) {
    vec2 lobe = ndfMixtureLobe(s.kind, width, kEstimateLobes, i);
    if (!(lobe.x > 0.0)) continue;
    SphericalGaussian warped = sgWarpIsotropic(sphericalGaussian(s.n, lobe.y, 1.0), s.wo);
    float own = shadowed() ? ssdfVisibleFraction(distance, warped.sharpness) : 1.0;
    vec3 radiance = environmentMean(warped.axis, warped.sharpness) * own;
    for (int l = 0; l < frame.counts.x; ++l) {
      float productSharpness;
      vec3 mean = lightMean(l, warped.axis, warped.sharpness, productSharpness);
      float through = 1.0 - brdfShare(s, l);
      bool shows = through > 0.0 && largestOf(mean) > 1.0e-4 * frame.sgLights[l].amplitude.r;
      float seen = shadowed() && shows ? shareBetween(t, l, warped, productSharpness, distance) : own;
      radiance += mean * (through * seen - own);
    }
    float weight = lobe.x * sgUnitIntegral(lobe.y);
    sum += (weight * horizonShare(s, warped.axis, warped.sharpness)) * max(radiance, vec3(0.0));
    weights += weight;
  }
  return sum / max(weights, 1.0e-20);
}

vec3 estimatedReflection(Surface s, Transfer t, vec3 albedo) {
  vec3 sum = albedo * estimatedMean(s, t);
  for (int l = 0; l < frame.counts.x; ++l) {
    float direct = brdfShare(s, l);
    if (direct > 0.0) sum += direct * lightReflection(s, t, l);
  }
  return sum;
}

vec3 estimatedDiffuse(Surface s, Transfer t) {
  float basis[25];
  shEvaluate(s.n, basis);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 25; ++i) sum += basis[i] * frame.irradiance[i].rgb;
  sum = max(sum, vec3(0.0));
  for (int l = 0; l < frame.counts.x; ++l) {
    vec4 light = frame.sgLights[l].axisSharpness;
    float cosineMean = clampedCosineMean(dot(s.n, light.xyz), light.w);
    if (cosineMean < 1.0e-5) continue;
    float v = lightShare(t, l, light.w) * horizonShare(s, light.xyz, light.w);
    sum += frame.sgLights[l].amplitude.rgb * (sgUnitIntegral(light.w) * cosineMean * v);
  }
  return sum * kOneOverPi;
}

// In units of the darkest, so that what is kept is light whatever the environment is.
void addEstimate(Surface s, Transfer t, inout Albedos a) {
  vec3 reflection = estimatedReflection(s, t, a.reflected);
#if CLEARCOAT
  float coat = 1.0 - throughCoat(s);
  if (coat > 0.0) reflection = mix(reflection, estimatedReflection(coatOf(s), t, a.reflected), coat);
#endif
  a.diffuse *= estimatedDiffuse(s, t) / darkest + 1.0;
  a.reflected += reflection / darkest;
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
  if (estimates) addEstimate(s, transferAt(corners, barycentric), a);
  albedos = packAlbedos(a);
  guide = packGuide(guideOf(s, texelFetch(depthTexture, at, 0).r));
}
