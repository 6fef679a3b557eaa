#version 450 core
#include "shaders/stage/frame.glsl"
#include "shaders/stage/geometry.glsl"
#include "shaders/stage/material.glsl"
#include "shaders/stage/shade.glsl"
#include "shaders/lobe/display.glsl"

in vec3 worldPosition;
in vec3 worldNormal;
in vec4 worldTangent;
in vec2 texcoord[kTextures];

uniform int firstIndex;  // of this draw in the index list

layout(location = 0) out vec4 color;

const int kDebugAlbedo = 1;
const int kDebugNormal = 2;
const int kDebugRoughness = 3;
const int kDebugVisibility = 4;
const int kDebugSsdf = 5;

// Area coordinates of the shaded point, from its position: exact derivatives of nothing are needed, and no varying per weight.
vec3 barycentricOf(uvec3 corners, vec3 p) {
  vec3 a = vertices[corners.x].positionU.xyz;
  vec3 e1 = vertices[corners.y].positionU.xyz - a;
  vec3 e2 = vertices[corners.z].positionU.xyz - a;
  vec3 q = p - a;
  // The area squared has the fourth power of a length: 0 or infinity in float for a scene of nanometres or of light seconds.
  vec3 largest = max(abs(e1), abs(e2));
  float size = max(largest.x, max(largest.y, largest.z));
  if (!(size > 0.0)) return vec3(1.0, 0.0, 0.0);
  e1 /= size;
  e2 /= size;
  q /= size;
  vec3 normal = cross(e1, e2);
  float scale = dot(normal, normal);
  if (!(scale > 0.0)) return vec3(1.0, 0.0, 0.0);
  float v = clamp(dot(cross(q, e2), normal) / scale, 0.0, 1.0);
  float w = clamp(dot(cross(e1, q), normal) / scale, 0.0, 1.0 - v);
  return vec3(1.0 - v - w, v, w);
}

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
  s.roughness = clamp(s.roughness, 0.0, 1.0);
  float alpha = clampAlpha(s.roughness * s.roughness);
  s.alphaT = alpha;
  s.alphaB = alpha;
  s.kind = m.textures.w;
  bool given = m.anisotropy.z > 0.0;
  if (given) {
    float scale = m.surface.y > 0.0 ? s.roughness / m.surface.y : 0.0;
    if (!hasTexture(m, kHasMetallicRoughness)) scale = 1.0;
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
  s.f0 = mix(min(atNormal, vec3(1.0)) * specular, baseColor.rgb, metallic);
  s.f90 = mix(specular, 1.0, metallic);
  if (m.fixedF0.w > 0.5) {
    s.f0 = m.fixedF0.rgb;
    s.f90 = 1.0;
  }
  s.diffuse = baseColor.rgb * (1.0 - metallic);
#if CLEARCOAT
  s.coat = m.coat.x;
  float coatRoughness = m.coat.y;
#if MATERIAL_TEXTURES > 5
  if (hasTexture(m, kHasCoat)) s.coat *= texture(coatTexture, texcoord[7]).r;
  if (hasTexture(m, kHasCoatRoughness)) coatRoughness *= texture(coatRoughnessTexture, texcoord[8]).g;
#endif
  s.coatRoughness = clamp(coatRoughness, 0.0, 1.0);
#endif
  return s;
}

vec3 signColor(float distance) {
  float x = distance / kHalfPi;
  return x > 0.0 ? mix(vec3(0.97), vec3(0.13, 0.4, 0.67), x) : mix(vec3(0.97), vec3(0.7, 0.09, 0.17), -x);
}

void main() {
  MaterialBlock m = materials[materialIndex];
  vec4 baseColor = baseColorAt(m, texcoord[0]);
  if (m.textures.y == 1 && baseColor.a < m.emissive.w) discard;

  int first = firstIndex + 3 * gl_PrimitiveID;
  uvec3 corners = uvec3(indices[first], indices[first + 1], indices[first + 2]);
  Transfer t = transferAt(corners, barycentricOf(corners, worldPosition));
  Surface s = surfaceHere(m, baseColor);

  vec3 radiance;
  int debugView = frame.counts.z;
  if (debugView == kDebugAlbedo) radiance = baseColor.rgb;
  else if (debugView == kDebugNormal) radiance = 0.5 * s.n + 0.5;
  else if (debugView == kDebugRoughness) radiance = vec3(s.roughness);
  else if (debugView == kDebugVisibility) radiance = vec3(broadVisibility(t, s.ng));
  else if (debugView == kDebugSsdf) radiance = signColor(ssdfAt(t, 2.0 * dot(s.n, s.wo) * s.n - s.wo));
  else {
    radiance = shade(s, t) + m.emissive.rgb * (hasTexture(m, kHasEmissive) ? texture(emissiveTexture, texcoord[3]).rgb : vec3(1.0)) * throughCoat(s);
  }
  color = vec4(radiance, m.textures.y == 2 ? baseColor.a : 1.0);
}
