// The surface under a fragment of shaders/stage/mesh.vert, its textures read.
in vec3 worldPosition;
in vec3 worldNormal;
in vec4 worldTangent;
in vec2 texcoord[kTextures];

#ifndef WETNESS
#define WETNESS 0
#endif
#if WETNESS
#include "shaders/stage/wetness.glsl"
#endif

uniform int firstIndex;  // of this draw in the index list

int firstCornerHere() { return firstIndex + 3 * gl_PrimitiveID; }

Surface surfaceHere(MaterialBlock m, vec4 baseColor) {
  Surface s;
  s.position = worldPosition;
  s.wo = frame.eye.w > 0.5 ? normalize(frame.eye.xyz - worldPosition) : frame.eye.xyz;
  vec3 normal = normalize(worldNormal);
  bool framed = worldTangent.w != 0.0;
  vec3 tangent = framed ? worldTangent.xyz - normal * dot(normal, worldTangent.xyz) : anyTangent(normal);
  tangent = normalize(dot(tangent, tangent) > 1.0e-12 ? tangent : anyTangent(normal));
  vec3 bitangent = cross(normal, tangent) * (worldTangent.w < 0.0 ? -1.0 : 1.0);
  float side = gl_FrontFacing ? 1.0 : -1.0;

  vec3 n = normal;
  s.bumped = hasTexture(m, kHasNormal) && framed;
  if (s.bumped) {
    vec3 mapped = texture(normalTexture, texcoord[2]).xyz * (255.0 / 127.0) - 128.0 / 127.0;
    mapped.xy *= m.surface.z;
    n = tangent * mapped.x + bitangent * mapped.y + normal * mapped.z;
    n = dot(n, n) > 1.0e-12 ? normalize(n) : normal;
  }
  s.ng = normal * side;
  s.n = shadingNormalTowards(n * side, s.wo);

  float metallic = m.surface.x;
  s.roughness = m.surface.y;
  if (hasTexture(m, kHasMetallicRoughness)) {
    vec4 texel = texture(metallicRoughnessTexture, texcoord[1]);
    s.roughness *= texel.g;
    metallic *= texel.b;
  }
  float smoother = 1.0;
  vec3 color = baseColor.rgb;
#if WETNESS
  float wetness = wetnessAt(s.position);
  smoother = wetRoughness(wetness);
  color *= wetColor(wetness, metallic);
#endif
  s.roughness = clamp(s.roughness, 0.0, 1.0) * smoother;
  float alpha = clampAlpha(s.roughness * s.roughness);
  s.alphaT = alpha;
  s.alphaB = alpha;
  s.kind = m.textures.w;
  bool given = m.anisotropy.z > 0.0;
  if (given) {
    float scale = smoother;
    if (hasTexture(m, kHasMetallicRoughness)) scale = m.surface.y > 0.0 ? s.roughness / m.surface.y : 0.0;
    s.alphaT = clampAlpha(m.anisotropy.z * scale * scale);
    s.alphaB = clampAlpha(m.anisotropy.w * scale * scale);
    s.roughness = sqrt(min(s.alphaT, s.alphaB));
  }
  vec2 direction = m.anisotropy.xy;
  float strength = m.surface.w;
  if (strength > 0.0 || given && hasTexture(m, kHasAnisotropy)) {
    if (hasTexture(m, kHasAnisotropy)) {
      vec3 texel = texture(anisotropyTexture, texcoord[4]).xyz;
      vec2 local = texel.xy * (255.0 / 127.0) - 128.0 / 127.0;
      direction = vec2(m.anisotropy.x * local.x - m.anisotropy.y * local.y, m.anisotropy.y * local.x + m.anisotropy.x * local.y);
      strength *= texel.z;
    }
    if (!given && s.kind != kCookTorrance && s.kind != kBlinnPhong) s.alphaT = mix(alpha, 1.0, strength * strength);
  }
  vec3 along = tangent * direction.x + bitangent * direction.y;
  along -= s.n * dot(s.n, along);
  s.t = dot(along, along) > 1.0e-12 ? normalize(along) : anyTangent(s.n);
  s.b = cross(s.n, s.t);

  vec3 atNormal = m.specular.rgb;
  float specular = m.specular.w;
#if MATERIAL_TEXTURES > 5
  if (hasTexture(m, kHasSpecular)) specular *= texture(specularTexture, texcoord[5]).a;
  if (hasTexture(m, kHasSpecularColor)) atNormal *= texture(specularColorTexture, texcoord[6]).rgb;
#endif
  s.f0 = mix(min(atNormal, vec3(1.0)) * specular, color, metallic);
  s.f90 = mix(specular, 1.0, metallic);
  if (m.fixedF0.w > 0.5) {
    s.f0 = m.fixedF0.rgb;
    s.f90 = 1.0;
  }
  s.diffuse = color * (1.0 - metallic);
#if CLEARCOAT
  s.coat = m.coat.x;
  float coatRoughness = m.coat.y;
#if MATERIAL_TEXTURES > 5
  if (hasTexture(m, kHasCoat)) s.coat *= texture(coatTexture, texcoord[7]).r;
  if (hasTexture(m, kHasCoatRoughness)) coatRoughness *= texture(coatRoughnessTexture, texcoord[8]).g;
#endif
  s.coatRoughness = clamp(coatRoughness, 0.0, 1.0);
#endif
#if SHEEN
  s.sheen = m.sheen.rgb;
  float sheenRoughness = m.sheen.w;
#if MATERIAL_TEXTURES > 5
  if (hasTexture(m, kHasSheenColor)) s.sheen *= texture(sheenColorTexture, texcoord[9]).rgb;
  if (hasTexture(m, kHasSheenRoughness)) sheenRoughness *= texture(sheenRoughnessTexture, texcoord[10]).a;
#endif
  s.sheenRoughness = clamp(sheenRoughness, 0.07, 1.0);
#endif
  return s;
}

vec3 emissionHere(MaterialBlock m, Surface s) {
  return m.emissive.rgb * (hasTexture(m, kHasEmissive) ? texture(emissiveTexture, texcoord[3]).rgb : vec3(1.0)) * throughCoat(s);
}
