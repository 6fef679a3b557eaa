// Reflectance models other than glTF's GGX, and strings of lobes for any model; read by shade.glsl. Compiled for scenes that ask for it:
// REFLECTANCE_MODELS (a material has such a model), MODEL_LAYERS (where its table starts), LOBES (a fixed number of lobes for every material).
#include "shaders/lobe/elongated.glsl"

// runtime/render/reflectance_textures.h: the layers of each table, then its albedo (what F0 scales, what Fresnel adds).
layout(binding = 16) uniform sampler2DArray modelTable;
const int kModelLayers[kModelCount] = MODEL_LAYERS;

// Widths as alpha; an exponent is n = 2 / alpha^2 - 2.
ReflectanceModel modelOf(int kind, float alphaT, float alphaB) {
  return reflectanceModel(kind, modelParameter(kind, alphaT), modelParameter(kind, alphaB));
}

// Of an anisotropic surface the mean of both directions'.
vec2 modelAlbedo(Surface s, ReflectanceModel m) {
  float layer = float(kModelLayers[s.kind] + reflectanceEntries(s.kind));
  float cosineOut = dot(s.n, s.wo);
  vec2 albedo = textureLod(modelTable, vec3(reflectanceTableAt(modelTable, s.kind, m.x, cosineOut), layer), 0.0).xy;
  if (m.x == m.y) return albedo;
  return 0.5 * (albedo + textureLod(modelTable, vec3(reflectanceTableAt(modelTable, s.kind, m.y, cosineOut), layer), 0.0).xy);
}

void addStringLobe(Surface s, Transfer t, SphericalGaussian lobe, float broad, vec3 localOut, inout vec3 base, inout vec3 edge, inout vec2 weights) {
  float weight = sgIntegral(lobe);
  if (!(weight > 1.0e-5)) return;
  float fresnel = fresnelSchlickWeight(dot(localOut, halfVector(localOut, lobe.axis)));
  vec3 axis = s.t * lobe.axis.x + s.b * lobe.axis.y + s.n * lobe.axis.z;
  vec3 radiance = lobeRadiance(s, t, axis, lobe.sharpness, broad) * weight;
  base += radiance * (1.0 - fresnel);
  edge += radiance * fresnel;
  weights += weight * vec2(1.0 - fresnel, fresnel);
}

// `count` lobes (1, 3, 5, 7 or 9) strung over light directions, GGX in three terms of as many; scaled to the albedo (z is ignored).
vec3 stringReflection(Surface s, Transfer t, ReflectanceModel m, int count, vec2 albedo, float broad) {
  vec3 localOut = tangentFrame(s, s.wo);
  vec3 base = vec3(0.0), edge = vec3(0.0);
  vec2 weights = vec2(0.0);
  if (count == 1) {
    SphericalGaussian lobe = sgWarpIsotropic(sphericalGaussian(vec3(0.0, 0.0, 1.0), ndfBestLobe(m.kind, sqrt(m.x * m.y)).y, 1.0), localOut);
    lobe.amplitude = modelTimesCosine(m, localOut, lobe.axis);
    addStringLobe(s, t, lobe, broad, localOut, base, edge, weights);
  } else {
    int terms = m.kind == kGgx ? 3 : 1;
    for (int term = 0; term < terms; ++term) {
      SphericalGaussian lobes[9];
      elongatedLobes(m, localOut, count, terms, term, lobes);
      for (int k = 0; k < count; ++k) addStringLobe(s, t, lobes[k], broad, localOut, base, edge, weights);
    }
  }
  return s.f0 * base * (albedo.x / max(weights.x, 1.0e-6)) + s.f90 * edge * (albedo.y / max(weights.y, 1.0e-6)) + directReflection(s, t);
}

// How many lobes a string takes: by how elongated the lobe of light is.
int stringLobes(ReflectanceModel m, vec3 localOut) {
#if LOBES > 0
  return LOBES;
#endif
  float ratio = lightString(ndfBestLobe(m.kind, m.x).y, ndfBestLobe(m.kind, m.y).y, localOut).ratio;
  return ratio < 0.35 ? 9 : ratio < 0.55 ? 7 : 5;
}

#if REFLECTANCE_MODELS
vec3 modelReflection(Surface s, Transfer t, ReflectanceModel m, vec2 albedo) {
#if LEVELS > 0
  float broad = 1.0;
#else
  float broad = broadVisibility(t, 2.0 * dot(s.n, s.wo) * s.n - s.wo);
#endif
#if LOBES == 0
  if (m.x == m.y) return fittedReflection(s, t, modelTable, float(kModelLayers[s.kind]), s.kind, m.x, albedo, broad);
#endif
  return stringReflection(s, t, m, stringLobes(m, tangentFrame(s, s.wo)), albedo, broad);
}
#endif
