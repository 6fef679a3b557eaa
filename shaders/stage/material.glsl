// One material: factors in a uniform block that may change each frame, textures bound per draw.
const int kTextures = 5;

struct MaterialBlock {
  vec4 baseColor;
  vec4 emissive;      // rgb; w: alpha cutoff
  vec4 surface;       // metallic, perceptual roughness, normal scale, anisotropy strength
  vec4 anisotropy;    // cos, sin of the rotation; unused
  ivec4 textures;     // bit per texture present; alpha mode (0 opaque, 1 mask, 2 blend); double-sided; unused
  vec4 textureLinear[kTextures];  // by binding: how its texture coordinates come from the mesh's, as a 2 x 2 matrix
  vec4 textureOffset[kTextures];  // and what is added; zw unused
};

const int kHasBaseColor = 1;
const int kHasMetallicRoughness = 2;
const int kHasNormal = 4;
const int kHasEmissive = 8;
const int kHasAnisotropy = 16;

layout(std430, binding = 2) readonly buffer MaterialBuffer { MaterialBlock materials[]; };
uniform int materialIndex;

layout(binding = 0) uniform sampler2D baseColorTexture;
layout(binding = 1) uniform sampler2D metallicRoughnessTexture;
layout(binding = 2) uniform sampler2D normalTexture;
layout(binding = 3) uniform sampler2D emissiveTexture;
layout(binding = 4) uniform sampler2D anisotropyTexture;

bool hasTexture(MaterialBlock m, int which) { return (m.textures.x & which) != 0; }

// For the vertex shader: beyond a triangle's edge a fragment shader's reads of a buffer may be zero, and a mip level come of that.
vec2 movedTexcoord(MaterialBlock m, int binding, vec2 uv) {
  vec4 linear = m.textureLinear[binding];
  return mat2(linear.xy, linear.zw) * uv + m.textureOffset[binding].xy;
}

vec4 baseColorAt(MaterialBlock m, vec2 uv) {
  return hasTexture(m, kHasBaseColor) ? m.baseColor * texture(baseColorTexture, uv) : m.baseColor;
}
