// What every pass of a frame reads. The C++ mirror is runtime/render/frame_block.h; both sides are std140.
const int kMaxSgLights = 32;
const int kMaxPunctualLights = 32;
const int kMaxDirections = 64;

const uint kFlagShadows = 1u;
const uint kFlagEnergyCompensation = 2u;

struct SgLightBlock {
  vec4 axisSharpness;  // world axis, sharpness
  vec4 amplitude;      // rgb radiance at the axis; w unused
};

struct PunctualLightBlock {
  vec4 positionType;    // world position; w: 0 sun, 1 point or sphere, 2 spot, 3 disk
  vec4 directionRange;  // unit, the way the light travels; w: 1 / range, 0 for none
  vec4 intensity;       // rgb: lux or candela; w: radius, metres, or of a sun angular radius, radians
  vec4 cone;            // x: scale, y: offset of KHR_lights_punctual's angular attenuation
};

layout(std140, binding = 0) uniform FrameBlock {
  mat4 clipFromWorld;
  mat4 worldFromClip;
  mat4 environmentFromWorld;
  vec4 eye;                                 // xyz: position (perspective) or direction towards the viewer (orthographic); w: 1 or 0
  ivec4 counts;                             // SG lights, punctual lights, debug view, flags
  vec4 pyramid;                             // log2 of the finest sharpness, last level index, log2 of the map's own sharpness, direction sharpness
  vec4 irradiance[25];                      // rest of the environment (lights taken out): A_l L_lm
  vec4 restRadiance[kMaxDirections];        // rest of the environment under the fixed lobes
  vec4 directions[kMaxDirections];          // their world axes
  SgLightBlock sgLights[kMaxSgLights];
  PunctualLightBlock punctualLights[kMaxPunctualLights];
  vec4 wetnessS;                            // texture coordinates of a baked world position
  vec4 wetnessT;
} frame;
