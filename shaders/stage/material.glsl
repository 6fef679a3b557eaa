// One material: factors in a uniform block that may change each frame, textures bound per draw.
// Those that the scene has none of (textures of specular, clearcoat and sheen) are not compiled: MATERIAL_TEXTURES.
#ifndef MATERIAL_TEXTURES
#define MATERIAL_TEXTURES 5
#endif
const int kTextures = MATERIAL_TEXTURES;
const int kMaterialTextures = 11;

struct MaterialBlock {
  vec4 baseColor;
  vec4 emissive;      // rgb; w: alpha cutoff
  vec4 surface;       // metallic, perceptual roughness, normal scale, anisotropy strength
  vec4 anisotropy;    // cos, sin of the rotation; widths as alpha along tangent and bitangent, or 0 where roughness and anisotropy make them
  ivec4 textures;     // bit per texture present; alpha mode (0 opaque, 1 mask, 2 blend); double-sided; model (shaders/lobe/ndf.glsl)
  vec4 specular;      // a dielectric's F0 by channel before it is cut at 1, factor
  vec4 fixedF0;       // F0 that replaces the rest; w: 1 where it does
  vec4 coat;          // factor, perceptual roughness; unused
  vec4 sheen;         // colour, perceptual roughness
  vec4 textureLinear[kMaterialTextures];  // by number: how its texture coordinates come from the mesh's, as a 2 x 2 matrix
  vec4 textureOffset[kMaterialTextures];  // and what is added; zw unused
};

const int kHasBaseColor = 1;
const int kHasMetallicRoughness = 2;
const int kHasNormal = 4;
const int kHasEmissive = 8;
const int kHasAnisotropy = 16;
const int kHasSpecular = 32;
const int kHasSpecularColor = 64;
const int kHasCoat = 128;
const int kHasCoatRoughness = 256;
const int kHasSheenColor = 512;
const int kHasSheenRoughness = 1024;

layout(std430, binding = 2) readonly buffer MaterialBuffer { MaterialBlock materials[]; };
uniform int materialIndex;

layout(binding = 0) uniform sampler2D baseColorTexture;
layout(binding = 1) uniform sampler2D metallicRoughnessTexture;
layout(binding = 2) uniform sampler2D normalTexture;
layout(binding = 3) uniform sampler2D emissiveTexture;
layout(binding = 4) uniform sampler2D anisotropyTexture;
#if MATERIAL_TEXTURES > 5
layout(binding = 17) uniform sampler2D specularTexture;
layout(binding = 18) uniform sampler2D specularColorTexture;
layout(binding = 19) uniform sampler2D coatTexture;
layout(binding = 20) uniform sampler2D coatRoughnessTexture;
layout(binding = 21) uniform sampler2D sheenColorTexture;
layout(binding = 22) uniform sampler2D sheenRoughnessTexture;
#endif

bool hasTexture(MaterialBlock m, int which) { return (m.textures.x & which) != 0; }

// For the vertex shader: beyond a triangle's edge a fragment shader's reads of a buffer may be zero, and a mip level come of that.
vec2 movedTexcoord(MaterialBlock m, int binding, vec2 uv) {
  vec4 linear = m.textureLinear[binding];
  return mat2(linear.xy, linear.zw) * uv + m.textureOffset[binding].xy;
}

vec4 baseColorAt(MaterialBlock m, vec2 uv) {
  return hasTexture(m, kHasBaseColor) ? m.baseColor * texture(baseColorTexture, uv) : m.baseColor;
}
