#version 450 core
// What every pixel shows, at full resolution and unshaded: all that shading, filtering and looking it up in the frame before need.
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/material.glsl"
#include "shaders/stage/shade.glsl"
#include "shaders/stage/surface.glsl"
#include "shaders/lobe/upsampling.glsl"
#include "shaders/stage/upsample_guide.glsl"
#include "shaders/stage/upsample_surface.glsl"
#include "shaders/stage/upsample_albedos.glsl"

layout(location = 0) out vec4 color;  // what it emits itself
layout(location = 1) out uvec4 place;
layout(location = 2) out uvec4 colors;
layout(location = 3) out uvec4 albedos;
layout(location = 4) out uvec4 guide;
layout(location = 5) out vec4 before;  // where it was in the frame before: pixels, window depth

#if SHAPES
in vec3 positionBefore;
#else
#define positionBefore worldPosition
#endif

uniform int body;
uniform bool outlook;    // take out what the light would be if nothing hid it
uniform float darkest;   // light that hardly shows, of this environment: not of the exposure, which may change while history is kept
uniform mat4 clipFromWorldBefore;
uniform vec2 size;
uniform vec2 depthScale;

const int kOpenLobes = 3;

Guide guideOf(Surface s) {
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
  g.depth = gl_FragCoord.z;
  g.normal = turn * s.n;
  g.axis = turn * lobe.axis;
  g.sharpness = lobe.sharpness;
  g.body = body;
  g.age = 0;
  return g;
}

// The radiance that a lobe of the distribution of normals would bring with nothing before it.
vec3 openReflection(Surface s, int kind, float alpha, vec3 n) {
  bool exponent = modelHasExponent(kind);
  float width = exponent ? 2.0 / (alpha * alpha) - 2.0 : alpha;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < kOpenLobes; ++i) {
    vec2 lobe = ndfMixtureLobe(kind, width, kOpenLobes, i);
    if (!(lobe.x > 0.0)) continue;
    SphericalGaussian warped = sgWarpIsotropic(sphericalGaussian(n, lobe.y, 1.0), s.wo);
    float weight = lobe.x * sgUnitIntegral(lobe.y);
    sum += weight * environmentMean(warped.axis, warped.sharpness);
    weights += weight;
  }
  return sum / max(weights, 1.0e-20);
}

vec3 openDiffuse(vec3 n) {
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

void takeOutOpenLight(Surface s, inout Albedos a) {
  vec3 reflection = openReflection(s, s.kind, sqrt(s.alphaT * s.alphaB), s.n);
#if CLEARCOAT
  float coat = 1.0 - throughCoat(s);
  if (coat > 0.0) reflection = mix(reflection, openReflection(s, kGgx, clampAlpha(s.coatRoughness * s.coatRoughness), shadingNormalTowards(s.ng, s.wo)), coat);
#endif
  // In units of the darkest, so that what is kept is light whatever the environment is.
  a.diffuse *= openDiffuse(s.n) / darkest + 1.0;
  a.reflected *= reflection / darkest + 1.0;
}

void main() {
  MaterialBlock m = materials[materialIndex];
  vec4 baseColor = baseColorAt(m, texcoord[0]);
  vec2 slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)) / depthUnit(depthScale, gl_FragCoord.z);
  Surface s = surfaceHere(m, baseColor);
  vec3 emission = emissionHere(m, s);
  if (m.textures.y == 1 && baseColor.a < m.emissive.w) discard;

  PackedSurface p = packSurface(s, firstCornerHere(), gl_FrontFacing);
  place = p.place;
  colors = p.colors;
  Albedos a;
  surfaceAlbedo(s, a.diffuse, a.reflected);
  a.slope = slope;
  if (outlook) takeOutOpenLight(s, a);
  albedos = packAlbedos(a);
  guide = packGuide(guideOf(s));
  vec4 clip = clipFromWorldBefore * vec4(positionBefore, 1.0);
  vec3 window = clip.w > 0.0 ? 0.5 * clip.xyz / clip.w + 0.5 : vec3(-1.0);
  before = vec4(window.xy * size, window.z, 0.0);
  color = vec4(emission, 1.0);
}
