#pragma once
/// The C++ side of shaders/stage/frame.glsl and material.glsl: std140 and std430 layouts, checked at compile time.

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace chiaro {

inline constexpr int kMaxSgLights = 32;
inline constexpr int kMaxPunctualLights = 32;
inline constexpr int kMaxDirections = 64;
inline constexpr int kCommonTextures = 5;    // of a glTF material with anisotropy, units 0 ..
inline constexpr int kMaterialTextures = 11;  // with those of KHR_materials_specular, _clearcoat and _sheen, units 17 ..

struct SgLightBlock {
  glm::vec4 axisSharpness{0.0f};
  glm::vec4 amplitude{0.0f};
};

struct PunctualLightBlock {
  glm::vec4 positionType{0.0f};
  glm::vec4 directionRange{0.0f};
  glm::vec4 intensity{0.0f};
  glm::vec4 cone{0.0f};
};

struct FrameBlock {
  glm::mat4 clipFromWorld{1.0f};         // 0
  glm::mat4 worldFromClip{1.0f};         // 64
  glm::mat4 environmentFromWorld{1.0f};  // 128
  glm::vec4 eye{0.0f};                   // 192
  glm::ivec4 counts{0};                  // 208
  glm::vec4 pyramid{0.0f};               // 224
  glm::vec4 irradiance[25];              // 240
  glm::vec4 restRadiance[kMaxDirections];  // 640
  glm::vec4 directions[kMaxDirections];    // 1664
  SgLightBlock sgLights[kMaxSgLights];     // 2688
  PunctualLightBlock punctualLights[kMaxPunctualLights];  // 3712
  glm::vec4 wetnessS{0.0f}, wetnessT{0.0f};               // 5760
};
static_assert(offsetof(FrameBlock, eye) == 192 && offsetof(FrameBlock, irradiance) == 240);
static_assert(offsetof(FrameBlock, restRadiance) == 640 && offsetof(FrameBlock, sgLights) == 2688);
static_assert(offsetof(FrameBlock, punctualLights) == 3712 && sizeof(FrameBlock) == 5792, "std140 says otherwise");

struct VertexBlock {
  glm::vec4 positionU{0.0f};
  glm::vec4 normalV{0.0f};
  glm::vec4 tangent{0.0f};
};
static_assert(sizeof(VertexBlock) == 48);

struct MaterialBlock {
  glm::vec4 baseColor{1.0f};
  glm::vec4 emissive{0.0f};
  glm::vec4 surface{0.0f};
  glm::vec4 anisotropy{1.0f, 0.0f, 0.0f, 0.0f};
  glm::ivec4 textures{0};
  glm::vec4 specular{0.0f};
  glm::vec4 fixedF0{0.0f};
  glm::vec4 coat{0.0f};
  glm::vec4 sheen{0.0f};
  glm::vec4 textureLinear[kMaterialTextures];  // columns of a 2 x 2 matrix
  glm::vec4 textureOffset[kMaterialTextures];
};
static_assert(offsetof(MaterialBlock, textureLinear) == 144 && sizeof(MaterialBlock) == 496);

}  // namespace chiaro
