#version 450 core
// Every pixel's light from the coarse samples about it and from the frame before (Herzog et al. 2010): the weights of place, depth, lobes and change
// in time multiply. Diffuse and reflected light each by their own lobe (Tokuyoshi 2015).
#include "shaders/lobe/upsampling.glsl"
#include "shaders/lobe/display.glsl"
#include "shaders/stage/upsample_guide.glsl"
#include "shaders/stage/upsample_albedos.glsl"
#include "shaders/stage/upsample_history.glsl"
#include "shaders/stage/upsample_list.glsl"

layout(binding = 0) uniform usampler2D guideTexture;
layout(binding = 1) uniform usampler2D albedosTexture;
layout(binding = 2) uniform usampler2D beforeTexture;
layout(binding = 7) uniform sampler2D coarseDiffuse;    // a: change since the frame before
layout(binding = 8) uniform sampler2D coarseReflected;
layout(binding = 9) uniform usampler2D coarseGuide;

layout(location = 0) out vec4 diffuse;    // a: worth
layout(location = 1) out vec4 reflected;
layout(location = 2) out uvec4 guide;
layout(location = 3) out vec4 quality;    // total weight, urgency

uniform ivec2 jitter;
uniform int cell;
uniform vec2 depthScale;
uniform float exposure;
uniform bool recompute;

// Below these no sample matches; they only decide what stands in where none does.
const float kLeastLike = 1.0e-4;
const float kLeastShare = 1.0e-6;
// A sample's worth for a pixel falls with their distance, in pixels: of what is right there 1, of what is interpolated the floor.
const float kWorthDeviation = 0.5;
const float kWorthFloor = 0.02;
const float kLargestWorth = 1.5;
const float kFade = 0.98;          // of the frame before, a frame
const float kTrusted = 0.97;       // a pixel of more weight than that asks for nothing
const float kChangeDeviation = 0.2;  // relative

ivec2 sampleAt(ivec2 coarseAt, ivec2 coarse, ivec2 size) { return min(clamp(coarseAt, ivec2(0), coarse - 1) * cell + jitter, size - 1); }

float seen(vec3 light) {
  float x = largestOf(light) * exposure;
  return x / (1.0 + x);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 words = texelFetch(guideTexture, at, 0);
  Guide g = unpackGuide(words);
  diffuse = reflected = vec4(0.0);
  guide = words;
  quality = vec4(1.0, 0.0, 0.0, 0.0);
  if (g.depth >= 1.0) return;
  Albedos a = unpackAlbedos(texelFetch(albedosTexture, at, 0));
  vec3 before = positionBeforeOf(texelFetch(beforeTexture, at, 0));

  ivec2 size = textureSize(guideTexture, 0), coarse = textureSize(coarseGuide, 0);
  ivec2 base = ivec2(floor(vec2(at - jitter) / float(cell)));
  // Samples of the last, cut cells are moved into the picture.
  ivec2 first = sampleAt(base, coarse, size), second = sampleAt(base + 1, coarse, size);
  vec2 f = clamp(vec2(at - first) / vec2(max(second - first, ivec2(1))), 0.0, 1.0);
  float unit = depthUnit(depthScale, g.depth);

  vec3 diffuseSum = vec3(0.0), reflectedSum = vec3(0.0);
  vec3 normalSum = vec3(0.0), axisSum = vec3(0.0);
  vec2 fits = vec2(0.0);
  vec2 total = vec2(0.0), divisor = vec2(0.0), change = vec2(0.0);
  float nearest = 1.0e6;
  vec3 low = vec3(1.0e30), high = vec3(0.0);
  Guide others[4];
  float same[4];
  for (int i = 0; i < 4; ++i) {
    ivec2 from = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), coarse - 1);
    others[i] = unpackGuide(texelFetch(coarseGuide, from, 0));
    vec2 step = vec2(sampleAt(from, coarse, size) - at);
    same[i] = others[i].depth < 1.0 && others[i].body == g.body ? planeWeight((others[i].depth - g.depth) / unit, a.slope, step) : 0.0;
    if (same[i] > 0.5) nearest = min(nearest, dot(step, step));
  }
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    float tent = (offset.x == 1 ? f.x : 1.0 - f.x) * (offset.y == 1 ? f.y : 1.0 - f.y);
    ivec2 from = clamp(base + offset, ivec2(0), coarse - 1);
    Guide other = others[i];
    if (other.depth >= 1.0) continue;
    vec4 d = texelFetch(coarseDiffuse, from, 0);
    vec4 r = texelFetch(coarseReflected, from, 0);
    vec2 w = vec2(1.0), floorWeight = vec2(1.0);
    if (weights != kBilinearWeights) {
      w = same[i] * likeness(g, other);
      vec2 near = nearness(g, other);
      floorWeight = max(same[i], kLeastLike) * max(near, vec2(kLeastLike));
    }
    w *= tent;
    fits += tent * same[i] * nearness(g, other);
    vec2 use = max(tent, kLeastShare) * floorWeight;
    total += w;
    divisor += use;
    diffuseSum += d.rgb * use.x;
    reflectedSum += r.rgb * use.y;
    normalSum += other.normal * use.x;
    axisSum += other.axis * use.y;
    change += vec2(d.a, r.a) * use;
    vec3 shown = withAlbedo(d.rgb, a.diffuse) + withAlbedo(r.rgb, a.reflected);
    low = min(low, shown);
    high = max(high, shown);
  }
  if (divisor.x > 0.0) {
    diffuseSum /= divisor.x;
    reflectedSum /= divisor.y;
    normalSum /= divisor.x;
    axisSum /= divisor.y;
    change /= divisor;
  }

  History h = historyAt(g, a.slope, before);
  vec2 steady = change / kChangeDeviation;
  vec2 kept = h.worth * kFade * exp(-steady * steady);
  vec2 fresh = max(weights == kLobeWeights ? fits : total, vec2(1.0e-4)) * max(exp(-0.5 * nearest / (kWorthDeviation * kWorthDeviation)), kWorthFloor);
  if (!(divisor.x > 0.0)) fresh = vec2(0.0);
  vec2 worth = kept + fresh;
  vec2 share = vec2(worth.x > 0.0 ? kept.x / worth.x : 0.0, worth.y > 0.0 ? kept.y / worth.y : 0.0);
  diffuse = vec4(mix(diffuseSum, h.diffuse, share.x), min(worth.x, kLargestWorth));
  reflected = vec4(mix(reflectedSum, h.reflected, share.y), min(worth.y, kLargestWorth));

  Guide own = g;
  vec3 normal = mix(normalSum, h.normal, share.x), axis = mix(axisSum, h.axis, share.y);
  if (dot(normal, normal) > 1.0e-4) own.normal = normalize(normal);
  if (dot(axis, axis) > 1.0e-4) own.axis = normalize(axis);
  own.age = int(min(share.y * (h.age + 1.0) + 0.5, float(kOldest)));
  guide = packGuide(own);

  // Each class counts by what it shows.
  float diffuseShown = seen(withAlbedo(diffuse.rgb, a.diffuse)), reflectedShown = seen(withAlbedo(reflected.rgb, a.reflected));
  vec2 trust = min(max(total, kept), vec2(1.0));
  float shown = diffuseShown + reflectedShown;
  float weight = shown > 0.0 ? dot(trust, vec2(diffuseShown, reflectedShown)) / shown : min(trust.x, trust.y);
  float contrast = divisor.x > 0.0 ? max(seen(high) - seen(low), 0.02) : 1.0;
  // Rounded as it is kept, so that it is counted as it is listed.
  vec2 asked = unpackHalf2x16(packHalf2x16(vec2(weight, weight < kTrusted ? (1.04 - weight) * contrast : 0.0)));
  float urgency = asked.y;
  quality = vec4(asked, 0.0, 0.0);
  if (recompute) {
    int step = urgencyStep(urgency);
    if (step >= 0) atomicAdd(urgencies[step], 1u);
  }
}
