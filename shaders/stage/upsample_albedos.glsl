// What shaded radiance is divided by before it is filtered, and multiplied with after: albedos times what upsample_estimate.frag expects of the light,
// so that diffuse and reflected light hardly know the material and its surroundings then.
struct Albedos {
  vec3 diffuse;
  vec3 reflected;
  vec2 slope;  // of the window depth, a pixel, in units of depthUnit()
};

// As square roots: what mirrors the sun is far beyond the range of a half.
const float kLargestRoot = 6.0e4;
float packedRoot(float x) { return x > 0.0 ? min(sqrt(x), kLargestRoot) : 0.0; }  // of what is not a number too
vec3 packedRoot(vec3 x) { return vec3(packedRoot(x.r), packedRoot(x.g), packedRoot(x.b)); }

uvec4 packAlbedos(Albedos a) {
  vec3 diffuse = packedRoot(a.diffuse), reflected = packedRoot(a.reflected);
  return uvec4(packHalf2x16(diffuse.rg), packHalf2x16(vec2(diffuse.b, reflected.r)), packHalf2x16(reflected.gb),
               packHalf2x16(clamp(a.slope, vec2(-6.0e4), vec2(6.0e4))));
}

Albedos unpackAlbedos(uvec4 words) {
  Albedos a;
  vec2 middle = unpackHalf2x16(words.y);
  a.diffuse = vec3(unpackHalf2x16(words.x), middle.x);
  a.reflected = vec3(middle.y, unpackHalf2x16(words.z));
  a.diffuse *= a.diffuse;
  a.reflected *= a.reflected;
  a.slope = unpackHalf2x16(words.w);
  return a;
}

// A channel that an albedo has not is not there in the light either.
const float kLeastAlbedo = 1.0e-4;
// What is not a number would stay in the history for good, and spread.
const float kMostLight = 1.0e30;
float finiteLight(float x) { return x > 0.0 ? (x < kMostLight ? x : kMostLight) : 0.0; }
vec3 withoutAlbedo(vec3 radiance, vec3 albedo) {
  return vec3(finiteLight(radiance.r), finiteLight(radiance.g), finiteLight(radiance.b)) / max(albedo, vec3(kLeastAlbedo));
}
vec3 withAlbedo(vec3 light, vec3 albedo) { return light * max(albedo, vec3(kLeastAlbedo)); }
