// The scene's own lights: suns, points, spots, spheres and disks, several at once. Each is the cap of directions that the shaded point sees of it
// (shaders/lobe/area_light.glsl). Its direction varies over a triangle, so its shadow is looked up for the pixel, not for the vertices.
//  * diffuse: the closed-form irradiance times the visible share of the cap's SG.
//  * reflection of lights narrower than it: the BRDF at seven points of the cap. Others: the view's SG lobes, each with the part of the
//    light's disc that is under it, and the visible share of the product of both.
// What a vertex sees is known to infinity: a surface behind a near light shadows as if it were in front of it.
#include "shaders/lobe/area_light.glsl"

const int kSun = 0;
const int kPoint = 1;  // or sphere
const int kSpot = 2;
const int kDisk = 3;
// Parts of a lobe below this share see no lamp.
const float kLeastShare = 1.0e-5;

// A shadow's edge is no sharper than the stored sphere resolves: a third of a texel, sqrt(4 pi) / (3 resolution), as deviation.
#if TERM_VECTORS > 0
const float kResolvedSharpness = 9.0 * float(SSDF_RESOLUTION) * float(SSDF_RESOLUTION) / kFourPi;
#else
const float kResolvedSharpness = 1.0e6;
#endif

struct Lamp {
  LightCap cap;     // irradiance with KHR_lights_punctual's range and cone
  vec3 color;       // intensity
  float sharpness;  // of its shadow
};

// False where it gives no light.
bool lampAt(int l, vec3 position, out Lamp lamp) {
  PunctualLightBlock block = frame.punctualLights[l];
  int type = int(block.positionType.w);
  vec3 way = block.directionRange.xyz;
  lamp.color = block.intensity.rgb;
  if (type == kSun) {
    lamp.cap = sunCap(-way, block.intensity.w);
  } else {
    vec3 towards = block.positionType.xyz - position;
    if (type == kDisk) lamp.cap = diskCap(towards, way, block.intensity.w);
    else lamp.cap = sphereCap(towards, block.intensity.w);
    float relative = dot(towards, towards) * block.directionRange.w * block.directionRange.w;
    float attenuation = clamp(1.0 - relative * relative, 0.0, 1.0);
    if (type == kSpot || type == kDisk) {
      float angular = clamp(dot(way, -lamp.cap.axis) * block.cone.x + block.cone.y, 0.0, 1.0);
      attenuation *= angular * angular;
    }
    lamp.cap.irradiance *= attenuation;
    lamp.cap.flux *= attenuation;
  }
  if (!(lamp.cap.irradiance > 0.0)) return false;
  lamp.sharpness = blurredSharpness(capSharpness(lamp.cap), kResolvedSharpness);
  return true;
}

float lampVisibility(Surface s, Transfer t, vec3 axis, float sharpness) {
  if (!shadowed()) return 1.0;
#if LEVELS > 0
  float broad = 1.0;
#else
  float broad = broadVisibility(t, axis);
#endif
  return visibleShare(t, axis, sharpness, ssdfAt(t, axis), broad);
}

float narrowerAlpha(Surface s) { return min(s.alphaT, s.alphaB); }

// Of all lamps through one reflection lobe; `share` is what of the reflection the lobes give.
vec3 lampsUnderLobe(Surface s, Transfer t, vec3 axis, float sharpness) {
  vec3 sum = vec3(0.0);
  for (int l = 0; l < frame.counts.y; ++l) {
    Lamp lamp;
    if (!lampAt(l, s.position, lamp)) continue;
    float through = capThroughLobes(lamp.cap, narrowerAlpha(s));
    if (through <= 0.0) continue;
    float mean = capMeanUnderLobe(lamp.cap, axis, sharpness);
    if (mean * lamp.cap.sinSquared * kPi < kLeastShare) continue;
    SphericalGaussian product = sgProductLog(axis, sharpness, lamp.cap.axis, lamp.sharpness);
    sum += lamp.color * (lamp.cap.irradiance * mean * through * lampVisibility(s, t, product.axis, product.sharpness));
  }
  return sum;
}

// Diffuse light of all lamps, and their reflection but for what lampsUnderLobe() gives of it; `smoothShare` of the reflection comes from lobes, `gain`
// is what scattering more than once adds to it. diffusePart: what of the sum is diffuse.
vec3 lampLight(Surface s, Transfer t, float smoothShare, vec3 gain, out vec3 diffusePart) {
  vec3 sum = vec3(0.0);
  diffusePart = vec3(0.0);
  for (int l = 0; l < frame.counts.y; ++l) {
    Lamp lamp;
    if (!lampAt(l, s.position, lamp)) continue;
    float irradiance = capIrradianceShare(lamp.cap, dot(s.n, lamp.cap.axis));
    if (!(irradiance > 0.0)) continue;
    vec3 x = incidenceTangent(lamp.cap.axis, s.wo);
    vec3 y = cross(lamp.cap.axis, x);
    float seen = 0.0, edge = 0.0, base = 0.0, grazing = 0.0;
    int points = lamp.cap.sinSquared > 0.0 ? kCapPoints : 1;
    for (int i = 0; i < points; ++i) {
      vec3 wi = capPoint(lamp.cap, x, y, i);
      float w = (points == 1 ? 1.0 : capPointWeight(i)) * max(dot(s.n, wi), 0.0);
      if (!(w > 0.0)) continue;
      float fresnel;
      float f = w * reflectance(s, wi, s.alphaT, s.alphaB, fresnel);
      seen += w;
      edge += w * fresnel;
      base += f * (1.0 - fresnel);
      grazing += f * fresnel;
    }
    vec3 axis = cosineWeightedAxis(lamp.cap.axis, lamp.sharpness, s.n);
    float visible = lampVisibility(s, t, axis, lamp.sharpness) * horizonShare(s, axis, lamp.sharpness);
    float diffuseShare = 1.0 - largestOf(fresnelColor(s, edge / max(seen, 1.0e-6)));
    vec3 diffuse = s.diffuse * (kOneOverPi * lamp.cap.irradiance * irradiance * diffuseShare);
    float direct = 1.0 - smoothShare * capThroughLobes(lamp.cap, narrowerAlpha(s));
    sum += lamp.color * visible * (diffuse + (s.f0 * base + s.f90 * grazing) * gain * (lamp.cap.flux * direct));
    diffusePart += lamp.color * visible * diffuse;
  }
  return sum;
}
