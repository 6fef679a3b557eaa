// What shaded radiance is divided by before it is filtered, and multiplied with after: diffuse and reflected light hardly know the material then.
struct Albedos {
  vec3 diffuse;
  vec3 reflected;
  vec2 slope;  // of the window depth, a pixel, in units of depthUnit()
};

uvec4 packAlbedos(Albedos a) {
  return uvec4(packHalf2x16(a.diffuse.rg), packHalf2x16(vec2(a.diffuse.b, a.reflected.r)), packHalf2x16(a.reflected.gb),
               packHalf2x16(clamp(a.slope, vec2(-6.0e4), vec2(6.0e4))));
}

Albedos unpackAlbedos(uvec4 words) {
  Albedos a;
  vec2 middle = unpackHalf2x16(words.y);
  a.diffuse = vec3(unpackHalf2x16(words.x), middle.x);
  a.reflected = vec3(middle.y, unpackHalf2x16(words.z));
  a.slope = unpackHalf2x16(words.w);
  return a;
}

// A channel that an albedo has not is not there in the light either.
const float kLeastAlbedo = 1.0e-4;
vec3 withoutAlbedo(vec3 radiance, vec3 albedo) { return max(radiance, vec3(0.0)) / max(albedo, vec3(kLeastAlbedo)); }
vec3 withAlbedo(vec3 light, vec3 albedo) { return light * max(albedo, vec3(kLeastAlbedo)); }
