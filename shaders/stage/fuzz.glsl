// Fuzz over the base (KHR_materials_sheen), read by shade.glsl where a material has it. It is broad: the BRDF itself at the lights and at the fixed
// lobes, scaled to its albedo, as for rough reflections.
#include "shaders/lobe/sheen.glsl"

layout(binding = 23) uniform sampler2D sheenAlbedoTable;  // runtime/brdf/albedo_table.h

// Directional albedo of a sheen of colour 1.
float sheenAlbedoOf(Surface s) {
  vec2 at;
  return samplePoint2(sheenAlbedoTable, vec2(s.sheenRoughness, sqrt(dot(s.n, s.wo))), at).r;
}

// What the sheen lets through to what lies under it.
float throughSheen(Surface s) { return max(0.0, 1.0 - largestOf(s.sheen) * sheenAlbedoOf(s)); }

float sheenAt(Surface s, vec3 wi) {
  vec3 wh = s.wo + wi;
  wh *= inversesqrt(max(dot(wh, wh), 1.0e-12));
  return sheenReflectance(dot(s.n, s.wo), dot(s.n, wi), dot(s.n, wh), s.sheenRoughness * s.sheenRoughness);
}

// Of the environment and of the scene's own lights.
vec3 sheenReflection(Surface s, Transfer t) {
  float directionSharpness = frame.pyramid.w;
  vec3 sum = vec3(0.0);
  float weight = 0.0;
  for (int j = 0; j < 4 * DIRECTION_VECTORS; ++j) {
    vec3 axis = frame.directions[j].xyz;
    float cosineMean = clampedCosineMean(dot(s.n, axis), directionSharpness);
    if (cosineMean < 1.0e-5) continue;
    float w = cosineMean * sheenAt(s, cosineWeightedAxis(axis, directionSharpness, s.n));
    sum += frame.restRadiance[j].rgb * (w * fixedVisibility(t, j) * horizonShare(s, axis, directionSharpness));
    weight += w;
  }
  vec3 result = max(sum * (sheenAlbedoOf(s) / max(weight, 1.0e-6)), vec3(0.0));
  for (int l = 0; l < frame.counts.x; ++l) {
    vec4 light = frame.sgLights[l].axisSharpness;
    float cosineMean = clampedCosineMean(dot(s.n, light.xyz), light.w);
    if (cosineMean < 1.0e-5) continue;
    float f = sheenAt(s, cosineWeightedAxis(light.xyz, light.w, s.n));
    result += frame.sgLights[l].amplitude.rgb * (sgUnitIntegral(light.w) * cosineMean * f * lightShare(t, l, light.w) * horizonShare(s, light.xyz, light.w));
  }
  for (int l = 0; l < frame.counts.y; ++l) {
    Lamp lamp;
    if (!lampAt(l, s.position, lamp)) continue;
    float irradiance = capIrradianceShare(lamp.cap, dot(s.n, lamp.cap.axis));
    if (!(irradiance > 0.0)) continue;
    vec3 axis = cosineWeightedAxis(lamp.cap.axis, lamp.sharpness, s.n);
    float visible = lampVisibility(s, t, axis, lamp.sharpness) * horizonShare(s, axis, lamp.sharpness);
    result += lamp.color * (lamp.cap.irradiance * irradiance * visible * sheenAt(s, axis));
  }
  return s.sheen * result;
}
