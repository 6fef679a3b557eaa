// One surface point lit by everything: shade() is all there is, so that any stage may call it.
//
// The environment is split into SG lights (suns, windows, lamps) and the rest. Per part of the reflection:
//  * diffuse: each light by its clamped-cosine integral and its own shadow from the SSDF; the rest by fixed lobes, whose visible fractions
//    the vertices hold, on top of an exact unshadowed irradiance.
//  * smooth reflection: the view's SG lobes; each takes the prefiltered environment times its visible fraction, and where a light's shadow
//    differs from the lobe's, the difference on that light's share (exact SG product).
//  * rough reflection: the BRDF itself at the lights and at the fixed lobes; SG lobes fit it poorly there.
// The scene's own lights: shaders/stage/lamps.glsl.
#ifndef REFLECTANCE_MODELS
#define REFLECTANCE_MODELS 0
#define CLEARCOAT 0
#define SHEEN 0
#endif
#ifndef LOBES
#define LOBES 0
#endif
#include "shaders/lobe/reflectance.glsl"
#include "shaders/lobe/sh.glsl"
#include "shaders/lobe/display.glsl"
#include "shaders/stage/transfer.glsl"
#include "shaders/stage/environment.glsl"
#include "shaders/stage/tape.glsl"

#if TERM_VECTORS > 0
layout(std430, binding = 5) readonly buffer LightVisibilityBuffer { uint lightVisibility[]; };  // light_visibility.comp
#endif

layout(binding = 9) uniform sampler2DArray ggxTable;  // runtime/brdf/reflectance_table.h
layout(binding = 10) uniform sampler2D albedoTable;

const int kAnisotropicTerms = 3;
// Lobes broader than this see the vertex's visible fractions instead of the half-space picture of the SSDF.
const float kBroadFrom = 4.0;
const float kBroadTo = 16.0;

struct Surface {
  vec3 position;
  vec3 ng;          // interpolated normal, towards the viewer's side
  vec3 n;           // with the normal map
  vec3 t;           // across n, along the anisotropy
  vec3 b;
  vec3 wo;
  vec3 diffuse;     // base colour of the diffuse part
  vec3 f0;
  float f90;
  int kind;         // reflectance model
  float roughness;  // perceptual
  float alphaT;
  float alphaB;
  bool bumped;      // n may differ from ng
#if CLEARCOAT
  float coat;           // factor
  float coatRoughness;  // perceptual
#endif
#if SHEEN
  vec3 sheen;            // colour
  float sheenRoughness;  // perceptual
#endif
};

vec3 fresnelColor(Surface s, float weight) { return s.f0 * (1.0 - weight) + s.f90 * weight; }

bool anisotropic(Surface s) { return s.alphaT != s.alphaB; }
vec3 tangentFrame(Surface s, vec3 w) { return vec3(dot(w, s.t), dot(w, s.b), dot(w, s.n)); }

// What a model is given for a width as alpha: that, or the exponent as wide, as far as models go.
float modelParameter(int kind, float alpha) {
  return modelHasExponent(kind) ? clamp(2.0 / (alpha * alpha) - 2.0, kMinExponent, kMaxExponent) : alpha;
}

vec3 samplePoint2(sampler2D table, vec2 unit, out vec2 at) {
  vec2 size = vec2(textureSize(table, 0));
  at = (unit * (size - 1.0) + 0.5) / size;
  return textureLod(table, at, 0.0).rgb;
}

vec3 albedoAt(float roughness, float cosineOut) {
  vec2 at;
  return samplePoint2(albedoTable, vec2(roughness, sqrt(cosineOut)), at);
}

// What the geometric horizon takes from a lobe that the shading normal let through (1 without a normal map).
float horizonShare(Surface s, vec3 axis, float sharpness) {
  if (!s.bumped) return 1.0;
  float geometric = sgHalfSpaceFraction(dot(s.ng, axis), sharpness);
  float shading = sgHalfSpaceFraction(dot(s.n, axis), sharpness);
  return min(1.0, geometric / max(shading, 1.0e-3));
}

bool shadowed() { return (uint(frame.counts.w) & kFlagShadows) != 0u; }
bool energyCompensation() { return (uint(frame.counts.w) & kFlagEnergyCompensation) != 0u; }

float fixedVisibility(Transfer t, int j) {
  float stored = shadowed() ? t.visibility[j >> 2][j & 3] : 1.0;
  return tapedShare(kTapedFixedShare, frame.directions[j].xyz, frame.pyramid.w, stored);
}

// Visible fraction of a broad lobe about `axis`, from the fixed lobes.
float broadVisibility(Transfer t, vec3 axis) {
  float sum = 0.0, weight = 0.0;
  for (int j = 0; j < 4 * DIRECTION_VECTORS; ++j) {
    float w = exp(8.0 * (dot(axis, frame.directions[j].xyz) - 1.0));
    sum += w * fixedVisibility(t, j);
    weight += w;
  }
  return sum / weight;
}

// Visible share of a lobe; `distance` is the SSDF at its axis, `broad` what broadVisibility() says (used where there are no levels).
float storedShare(Transfer t, vec3 axis, float sharpness, float distance, float broad) {
  if (!shadowed()) return 1.0;
#if TERM_VECTORS > 0 && LEVELS > 0
  VisibilitySource source = sourceOf(sharpness);
  if (source.ssdf >= 1.0) return ssdfVisibleFraction(distance, sharpness);
  float share = levelShareAt(t, axis, source);
  return source.ssdf > 0.0 ? mix(share, ssdfVisibleFraction(distance, sharpness), source.ssdf) : share;
#else
  return mix(broad, ssdfVisibleFraction(distance, sharpness), smoothstep(log2(kBroadFrom), log2(kBroadTo), log2(sharpness)));
#endif
}

float visibleShare(Transfer t, vec3 axis, float sharpness, float distance, float broad) {
  return tapedShare(kTapedShare, axis, sharpness, storedShare(t, axis, sharpness, distance, broad));
}

// SSDF at the axis of an SG light, and the light's visible share.
float storedLightShare(Transfer t, int light, float sharpness, out float distance) {
  distance = kHalfPi;
#if TERM_VECTORS > 0
  if (!shadowed()) return 1.0;
  vec2 seen = vec2(0.0);
  for (int c = 0; c < 3; ++c)
    seen += t.barycentric[c] * unpackHalf2x16(lightVisibility[t.corners[c] * uint(frame.counts.x) + uint(light)]);
  distance = seen.x;
#if LEVELS > 0
  return mix(seen.y, ssdfVisibleFraction(distance, sharpness), sourceOf(sharpness).ssdf);
#else
  return ssdfVisibleFraction(distance, sharpness);
#endif
#else
  return 1.0;
#endif
}

float lightShare(Transfer t, int light, float sharpness) {
  float distance;
  float stored = storedLightShare(t, light, sharpness, distance);
  return tapedShare(kTapedShare, frame.sgLights[light].axisSharpness.xyz, sharpness, stored);
}

// Mean radiance of light `l` alone under a normalised lobe, and the sharpness of their product.
vec3 lightMean(int l, vec3 axis, float sharpness, out float productSharpness) {
  vec4 light = frame.sgLights[l].axisSharpness;
  SphericalGaussian product = sgProductLog(axis, sharpness, light.xyz, light.w);
  productSharpness = product.sharpness;
  return frame.sgLights[l].amplitude.rgb * exp(product.amplitude) * oneMinusExpOver(2.0 * product.sharpness)
       / oneMinusExpOver(2.0 * sharpness);
}

float reflectance(Surface s, vec3 wi, float alphaT, float alphaB, out float fresnel);
vec3 directReflection(Surface s, Transfer t);
#include "shaders/stage/lamps.glsl"

// What an SG light sharper than an elongated reflection gives directly, by the BRDF itself, and not through the lobes: these are too few to follow its
// narrow direction and its tail. Passes over where the light is about as broad as the narrow direction.
float directShare(Surface s, float lightSharpness) {
  if (!anisotropic(s)) return 0.0;
  float narrow = min(s.alphaT, s.alphaB);
  return smoothstep(0.1, 0.4, lightSharpness * 2.0 * narrow * narrow * max(dot(s.n, s.wo), 0.1));
}

// Light that arrives through one reflection lobe.
vec3 lobeRadiance(Surface s, Transfer t, vec3 axis, float sharpness, float broad) {
  float distance = ssdfAt(t, axis);
  float own = visibleShare(t, axis, sharpness, distance, broad);
  vec3 radiance = taped(kTapedMean, axis, sharpness, environmentMean(axis, sharpness)) * own;
#if TERM_VECTORS > 0
  if (shadowed()) {
    for (int l = 0; l < frame.counts.x; ++l) {
      float productSharpness;
      vec3 mean = lightMean(l, axis, sharpness, productSharpness);
      if (largestOf(mean) < 1.0e-5 * frame.sgLights[l].amplitude.r) continue;
      // The distance is 1-Lipschitz: between the two known axes it is close to linear.
      float lightSharpness = frame.sgLights[l].axisSharpness.w;
      float lightDistance;
      storedLightShare(t, l, lightSharpness, lightDistance);
      float towards = lightSharpness / (sharpness + lightSharpness);
      vec3 between = mix(axis, frame.sgLights[l].axisSharpness.xyz, towards);
      float through = 1.0 - directShare(s, lightSharpness);
      radiance += mean * (through * visibleShare(t, between, productSharpness, mix(distance, lightDistance, towards), broad) - own);
    }
  } else
#endif
  if (anisotropic(s)) {
    for (int l = 0; l < frame.counts.x; ++l) {
      float productSharpness;
      radiance -= directShare(s, frame.sgLights[l].axisSharpness.w) * lightMean(l, axis, sharpness, productSharpness);
    }
  }
  radiance = taped(kTapedLobe, axis, sharpness, max(radiance, vec3(0.0)) * horizonShare(s, axis, sharpness));
  return radiance + lampsUnderLobe(s, t, axis, sharpness) * horizonShare(s, axis, sharpness);
}

vec3 diffuseLight(Surface s, Transfer t) {
  int count = 4 * DIRECTION_VECTORS;
  float directionSharpness = frame.pyramid.w;
  vec3 seen = vec3(0.0), all = vec3(0.0);
  float seenWeight = 0.0, allWeight = 0.0;
  for (int j = 0; j < count; ++j) {
    vec3 axis = frame.directions[j].xyz;
    float w = clampedCosineMean(dot(s.n, axis), directionSharpness);
    float v = fixedVisibility(t, j) * horizonShare(s, axis, directionSharpness);
    vec3 radiance = frame.restRadiance[j].rgb;
    seen += radiance * (w * v);
    all += radiance * w;
    seenWeight += w * v;
    allWeight += w;
  }
  // What the few fixed lobes miss of the exact irradiance gets their mean visibility.
  float basis[25];
  shEvaluate(s.n, basis);
  vec3 exact = vec3(0.0);
  for (int i = 0; i < 25; ++i) exact += basis[i] * frame.irradiance[i].rgb;
  float solidAngle = kFourPi / float(count);
  vec3 irradiance = seen * solidAngle + (exact - all * solidAngle) * (seenWeight / max(allWeight, 1.0e-6));
  irradiance = max(irradiance, vec3(0.0));
  for (int l = 0; l < frame.counts.x; ++l) {
    vec4 light = frame.sgLights[l].axisSharpness;
    float cosineMean = clampedCosineMean(dot(s.n, light.xyz), light.w);
    if (cosineMean < 1.0e-5) continue;
    float v = lightShare(t, l, light.w) * horizonShare(s, light.xyz, light.w);
    irradiance += frame.sgLights[l].amplitude.rgb * (sgUnitIntegral(light.w) * cosineMean * v);
  }
  return taped(kTapedIrradiance, s.n, 0.0, irradiance);
}

vec2 reflectanceTableAt(sampler2DArray table, int kind, float parameter, float cosineOut) {
  vec2 size = vec2(textureSize(table, 0).xy);
  return (reflectanceTableCoordinate(modelWidth(kind, parameter), cosineOut) * (size - 1.0) + 0.5) / size;
}

// The fitted lobes of a round model of this width or exponent; `first`: layer at which its table starts. Lobes that carry next to nothing of the albedo
// are left out.
vec3 fittedReflection(Surface s, Transfer t, sampler2DArray table, float first, int kind, float parameter, vec2 albedo, float broad) {
  float cosineOut = dot(s.n, s.wo);
  vec3 x = incidenceTangent(s.n, s.wo);
  vec3 y = cross(s.n, x);
  vec2 at = reflectanceTableAt(table, kind, parameter, cosineOut);
  int singles = reflectanceSingles(kind);
  vec4 elevations = textureLod(table, vec3(at, first + float(reflectanceEntries(kind) - 1)), 0.0);
  float least = 1.0e-3 * (albedo.x + albedo.y);
  vec3 base = vec3(0.0), edge = vec3(0.0);
  for (int k = 0; k < reflectanceLobeCount(kind); ++k) {
    int pair = (k - singles) >> 1;
    vec4 entry = textureLod(table, vec3(at, first + float(k < singles ? k : singles + pair)), 0.0);
    if (entry.z + entry.w < least) continue;
    float elevation = k < singles ? 0.0 : elevations[pair] * (((k - singles) & 1) == 0 ? 1.0 : -1.0);
    SpecularLobe lobe = reflectanceTableLobe(entry, elevation, s.n, x, y, cosineOut, modelWidth(kind, parameter));
    vec3 radiance = lobeRadiance(s, t, lobe.axis, lobe.sharpness, broad);
    base += radiance * lobe.weight;
    edge += radiance * lobe.fresnelWeight;
  }
  return s.f0 * base + s.f90 * edge;
}

#if REFLECTANCE_MODELS || LOBES > 0
#include "shaders/stage/models.glsl"
#endif

// The reflection (D V of GGX) and Fc = (1 - wo.wh)^5, for two widths as alpha.
float reflectance(Surface s, vec3 wi, float alphaT, float alphaB, out float fresnel) {
  vec3 wh = s.wo + wi;
  wh *= inversesqrt(max(dot(wh, wh), 1.0e-12));
  fresnel = fresnelSchlickWeight(dot(s.wo, wh));
  float cosineIn = max(dot(s.n, wi), 0.0);
#if REFLECTANCE_MODELS
  if (s.kind != kGgx) return modelTimesCosine(modelOf(s.kind, alphaT, alphaB), tangentFrame(s, s.wo), tangentFrame(s, wi)) / max(cosineIn, kMinCosine);
#endif
  float cosineOut = dot(s.n, s.wo);
  if (alphaT == alphaB) return ggxDistribution(max(dot(s.n, wh), 0.0), alphaT) * ggxVisibility(cosineOut, cosineIn, alphaT);
  vec3 localHalf = tangentFrame(s, wh);
  localHalf.z = max(localHalf.z, 0.0);
  return ggxDistributionAnisotropic(localHalf, alphaT, alphaB) *
         ggxVisibilityAnisotropic(tangentFrame(s, s.wo), vec3(dot(wi, s.t), dot(wi, s.b), cosineIn), alphaT, alphaB);
}

// An SG light's reflection by the BRDF itself, widened by the light.
vec3 lightReflection(Surface s, Transfer t, int l) {
  vec4 light = frame.sgLights[l].axisSharpness;
  float cosineMean = clampedCosineMean(dot(s.n, light.xyz), light.w);
  if (cosineMean < 1.0e-5) return vec3(0.0);
  float fresnel;
  float f = reflectance(s, cosineWeightedAxis(light.xyz, light.w, s.n), alphaUnderLight(s.alphaT, light.w), alphaUnderLight(s.alphaB, light.w), fresnel);
  float v = lightShare(t, l, light.w) * horizonShare(s, light.xyz, light.w);
  return frame.sgLights[l].amplitude.rgb * (sgUnitIntegral(light.w) * cosineMean * f * v) * fresnelColor(s, fresnel);
}

vec3 directReflection(Surface s, Transfer t) {
  vec3 sum = vec3(0.0);
  if (!anisotropic(s)) return sum;
  for (int l = 0; l < frame.counts.x; ++l) {
    float direct = directShare(s, frame.sgLights[l].axisSharpness.w);
    if (direct > 0.0) sum += direct * lightReflection(s, t, l);
  }
  return sum;
}

vec3 roughReflection(Surface s, Transfer t, vec3 albedo) {
  float directionSharpness = frame.pyramid.w;
  vec3 base = vec3(0.0), edge = vec3(0.0);
  float baseWeight = 0.0, edgeWeight = 0.0;
  for (int j = 0; j < 4 * DIRECTION_VECTORS; ++j) {
    vec3 axis = frame.directions[j].xyz;
    float cosineMean = clampedCosineMean(dot(s.n, axis), directionSharpness);
    if (cosineMean < 1.0e-5) continue;
    // The cosine-weighted middle of the lobe: for one that the horizon cuts, not its axis.
    float fresnel;
    float w = cosineMean * reflectance(s, cosineWeightedAxis(axis, directionSharpness, s.n), s.alphaT, s.alphaB, fresnel);
    vec3 radiance = frame.restRadiance[j].rgb * (fixedVisibility(t, j) * horizonShare(s, axis, directionSharpness));
    radiance = taped(kTapedRest, axis, directionSharpness, radiance);
    base += radiance * (w * (1.0 - fresnel));
    edge += radiance * (w * fresnel);
    baseWeight += w * (1.0 - fresnel);
    edgeWeight += w * fresnel;
  }
  vec3 result = s.f0 * base * (albedo.x / max(baseWeight, 1.0e-6)) + s.f90 * edge * (albedo.y / max(edgeWeight, 1.0e-6));
  result = max(result, vec3(0.0));
  for (int l = 0; l < frame.counts.x; ++l) result += lightReflection(s, t, l);
  return result;
}

vec3 smoothReflection(Surface s, Transfer t, vec3 albedo) {
#if LEVELS > 0
  float broad = 1.0;
#else
  float broad = broadVisibility(t, s.n * (2.0 * dot(s.n, s.wo)) - s.wo);
#endif
  if (!anisotropic(s)) return fittedReflection(s, t, ggxTable, 0.0, kGgx, s.alphaT, albedo.xy, broad);
  vec3 base = vec3(0.0), edge = vec3(0.0);
  float baseWeight = 0.0, edgeWeight = 0.0;
  int parts = anisotropicPartCount(max(s.alphaT / s.alphaB, s.alphaB / s.alphaT));
  for (int j = 0; j < kAnisotropicTerms; ++j) {
    for (int k = 0; k < parts; ++k) {
      SpecularLobe lobe = anisotropicPart(ggxMixtureTerm(kAnisotropicTerms, j), parts, k, s.n, s.t, s.b, s.alphaT, s.alphaB, s.wo);
      if (!(lobe.weight + lobe.fresnelWeight > 1.0e-4)) continue;
      vec3 radiance = lobeRadiance(s, t, lobe.axis, lobe.sharpness, broad);
      base += radiance * lobe.weight;
      edge += radiance * lobe.fresnelWeight;
      baseWeight += lobe.weight;
      edgeWeight += lobe.fresnelWeight;
    }
  }
  return s.f0 * base * (albedo.x / max(baseWeight, 1.0e-6)) + s.f90 * edge * (albedo.y / max(edgeWeight, 1.0e-6)) + directReflection(s, t);
}

#if SHEEN
#include "shaders/stage/fuzz.glsl"
#endif

// GGX by SG lobes where it is smooth, by the BRDF itself where it is rough; smoothShare: how much of it comes from lobes.
vec3 ggxReflection(Surface s, Transfer t, vec3 albedo, out float smoothShare) {
#if LOBES > 0
  smoothShare = 1.0;
  float broad = broadVisibility(t, 2.0 * dot(s.n, s.wo) * s.n - s.wo);
  return stringReflection(s, t, modelOf(kGgx, s.alphaT, s.alphaB), LOBES, albedo.xy, broad);
#else
  float rough = roughReflectionShare(kGgx, min(s.alphaT, s.alphaB));
  vec3 reflected = vec3(0.0);
  if (rough < 1.0) reflected += (1.0 - rough) * smoothReflection(s, t, albedo);
  if (rough > 0.0) reflected += rough * roughReflection(s, t, albedo);
  smoothShare = 1.0 - rough;
  return reflected;
#endif
}

// What the coat lets through to what lies under it (KHR_materials_clearcoat: Fresnel of F0 .04 at the mesh's own normal).
float throughCoat(Surface s) {
#if CLEARCOAT
  return 1.0 - s.coat * (0.04 + 0.96 * fresnelSchlickWeight(dot(shadingNormalTowards(s.ng, s.wo), s.wo)));
#else
  return 1.0;
#endif
}

#if CLEARCOAT
// The coat as a surface of its own that reflects all it can.
Surface coatOf(Surface s) {
  s.n = shadingNormalTowards(s.ng, s.wo);
  s.bumped = false;
  s.kind = kGgx;
  s.roughness = s.coatRoughness;
  s.alphaT = s.alphaB = clampAlpha(s.coatRoughness * s.coatRoughness);
  s.f0 = vec3(1.0);
  s.f90 = 1.0;
  s.diffuse = vec3(0.0);
  return s;
}

vec3 coatReflection(Surface base, Transfer t) {
  Surface s = coatOf(base);
  float smoothShare;
  vec3 reflected = ggxReflection(s, t, albedoAt(s.roughness, dot(s.n, s.wo)), smoothShare);
  vec3 diffusePart;
  return reflected + lampLight(s, t, smoothShare, vec3(1.0), diffusePart);
}
#endif

// z, what the diffuse part goes without, is the mean of both directions' on an anisotropic surface.
vec3 ggxAlbedo(Surface s) {
  float cosineOut = dot(s.n, s.wo);
  vec3 albedo = albedoAt(sqrt(s.alphaT), cosineOut);
  if (!anisotropic(s)) return albedo;
  return vec3(ggxAlbedoAnisotropic(tangentFrame(s, s.wo), s.alphaT, s.alphaB), 0.5 * (albedo.z + albedoAt(sqrt(s.alphaB), cosineOut).z));
}

float diffuseShareOf(Surface s, vec3 albedo) { return 1.0 - (largestOf(s.f0) * (1.0 - albedo.z) + s.f90 * albedo.z); }

// diffusePart: what of the radiance is diffuse; the rest is reflected.
vec3 shade(Surface s, Transfer t, out vec3 diffusePart) {
  vec3 albedo = ggxAlbedo(s);
  vec3 gain = vec3(1.0);
  vec3 radiance;
  float smoothShare;
#if REFLECTANCE_MODELS
  if (kModelLayers[s.kind] >= 0) {
    ReflectanceModel m = modelOf(s.kind, s.alphaT, s.alphaB);
    vec2 modelTotal = modelAlbedo(s, m);
    float rough = LOBES > 0 ? 0.0 : roughReflectionShare(s.kind, min(s.alphaT, s.alphaB));
    smoothShare = 1.0 - rough;
    radiance = vec3(0.0);
    if (rough < 1.0) radiance += (1.0 - rough) * modelReflection(s, t, m, modelTotal);
    if (rough > 0.0) radiance += rough * roughReflection(s, t, vec3(modelTotal, 0.0));
  } else
#endif
  {
    // What scatters more than once (Turquin 2019).
    if (energyCompensation()) gain += s.f0 * (1.0 / clamp(albedo.x + albedo.y, 1.0e-3, 1.0) - 1.0);
    radiance = ggxReflection(s, t, albedo, smoothShare) * gain;
  }
  float diffuseShare = diffuseShareOf(s, albedo);
  diffusePart = vec3(0.0);
  if (largestOf(s.diffuse) > 0.0) {
    diffusePart = s.diffuse * (diffuseShare * kOneOverPi) * diffuseLight(s, t);
    radiance += diffusePart;
  }
  vec3 lampDiffuse;
  radiance += lampLight(s, t, smoothShare, gain, lampDiffuse);
  diffusePart += lampDiffuse;
#if SHEEN
  if (largestOf(s.sheen) > 0.0) {
    float underSheen = throughSheen(s);
    radiance = underSheen * radiance + sheenReflection(s, t);
    diffusePart *= underSheen;
  }
#endif
#if CLEARCOAT
  float through = throughCoat(s);
  if (through < 1.0) radiance = through * radiance + (1.0 - through) * coatReflection(s, t);
  diffusePart *= through;
#endif
  return radiance;
}

vec3 shade(Surface s, Transfer t) {
  vec3 diffusePart;
  return shade(s, t, diffusePart);
}

// What light of one everywhere would make of the surface, diffuse and reflected: radiance divided by it hardly knows the material's colours.
void surfaceAlbedo(Surface s, out vec3 diffuse, out vec3 reflected) {
  vec3 albedo = ggxAlbedo(s);
  diffuse = s.diffuse * max(diffuseShareOf(s, albedo), 0.0);
#if REFLECTANCE_MODELS
  if (kModelLayers[s.kind] >= 0) albedo.xy = modelAlbedo(s, modelOf(s.kind, s.alphaT, s.alphaB));
#endif
  reflected = s.f0 * albedo.x + s.f90 * albedo.y;
#if SHEEN
  float underSheen = throughSheen(s);
  diffuse *= underSheen;
  reflected = underSheen * reflected + s.sheen * sheenAlbedoOf(s);
#endif
#if CLEARCOAT
  float through = throughCoat(s);
  vec3 coat = albedoAt(s.coatRoughness, dot(shadingNormalTowards(s.ng, s.wo), s.wo));
  diffuse *= through;
  reflected = through * reflected + (1.0 - through) * (coat.x + coat.y);
#endif
}
