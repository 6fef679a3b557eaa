// What the upsampling filter compares: one texel of four words a pixel, a coarse sample or a pixel of the frame before.
#include "shaders/lobe/octahedral.glsl"
#include "shaders/lobe/upsampling.glsl"

struct Guide {
  float depth;      // window depth; 1: nothing there
  vec3 normal;      // of the shaded surface; this and the axis in the environment's frame, so that they turn as the light does
  vec3 axis;        // of the reflection lobe
  float sharpness;  // its own
  int body;         // what moves as one
  int age;          // frames since what is kept here was shaded, at most kOldest
};

const float kLargestLogSharpness = 20.0;
const int kOldest = 255;

uint packedDirection(vec3 d) { return packUnorm2x16(octahedralEncode(d)); }
vec3 unpackedDirection(uint word) { return octahedralDecode(unpackUnorm2x16(word)); }

uvec4 packGuide(Guide g) {
  uint sharpness = uint(clamp(log2(1.0 + g.sharpness) / kLargestLogSharpness, 0.0, 1.0) * 65535.0 + 0.5);
  return uvec4(floatBitsToUint(g.depth), packedDirection(g.normal), packedDirection(g.axis), sharpness | uint(g.body & 255) << 16 | uint(g.age) << 24);
}

Guide unpackGuide(uvec4 words) {
  Guide g;
  g.depth = uintBitsToFloat(words.x);
  g.normal = unpackedDirection(words.y);
  g.axis = unpackedDirection(words.z);
  g.sharpness = exp2(float(words.w & 0xffffu) * (kLargestLogSharpness / 65535.0)) - 1.0;
  g.body = int(words.w >> 16 & 255u);
  g.age = int(words.w >> 24);
  return g;
}

const uint kNoBody = 255u;
const uvec4 kNoGuide = uvec4(0x3f800000u, 0u, 0u, 0u);  // depth 1

// Where a pixel was in the frame before (pixels, window depth), and the slope of its window depth, a pixel, in units of depthUnit().
uvec4 packMotion(vec3 before, vec2 slope) { return uvec4(floatBitsToUint(before), packHalf2x16(clamp(slope, vec2(-6.0e4), vec2(6.0e4)))); }
vec3 positionBeforeOf(uvec4 motion) { return uintBitsToFloat(motion.xyz); }
vec2 slopeOf(uvec4 motion) { return unpackHalf2x16(motion.w); }

// In window depth, the distance that a pixel spans there: x + y depth. In this unit the slope of a surface is that of its picture.
float depthUnit(vec2 scale, float depth) { return scale.x + scale.y * depth; }

// Of a surface `across` pixels aside whose plane would have it at depth 0: in pixels. Steep surfaces are known less well, to a limit: at an outline
// everything would be near.
const float kDepthDeviation = 1.2;
const float kSteepest = 8.0;
float planeWeight(float depthOff, vec2 slope, vec2 across) {
  float off = depthOff - dot(slope, across);
  return depthWeight(off / (kDepthDeviation * (1.0 + 0.25 * min(abs(slope.x) + abs(slope.y), kSteepest))));
}
