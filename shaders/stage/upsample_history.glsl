// What was kept of the frame before, looked up where a pixel was then.
layout(binding = 17) uniform sampler2D historyDiffuse;    // rgb light, a: how much it is worth, 1 for a pixel that was shaded itself
layout(binding = 18) uniform sampler2D historyReflected;
layout(binding = 19) uniform usampler2D historyGuide;     // normal and axis: the mean of what the light was gathered through

uniform bool historyHolds;
uniform vec2 depthScaleBefore;
uniform int weights;

const int kLobeWeights = 0;
const int kNormalWeights = 1;
const int kBilinearWeights = 2;

// How alike what two guides gather is: diffuse, reflected.
vec2 likeness(Guide a, Guide b) {
  if (weights == kLobeWeights)
    return vec2(lobeWeight(a.normal, kDiffuseSharpness, b.normal, kDiffuseSharpness), lobeWeight(a.axis, a.sharpness, b.axis, b.sharpness));
  return vec2(normalWeight(a.normal, b.normal));
}

// The same for a choice among samples of which none may be alike.
vec2 nearness(Guide a, Guide b) {
  if (weights == kLobeWeights)
    return vec2(lobeNearness(a.normal, kDiffuseSharpness, b.normal, kDiffuseSharpness), lobeNearness(a.axis, a.sharpness, b.axis, b.sharpness));
  return vec2(normalWeight(a.normal, b.normal));
}

// Cosines between normals: what turns more than that between frames, or between two pixels, is another surface.
const float kOtherSurface = 0.5;
const float kSameSurface = 0.8;

// With less than this share of a pixel found again, the rest of the weights would be made of their tails.
const float kLeastFound = 0.2;

struct History {
  vec3 diffuse;
  vec3 reflected;
  vec2 worth;    // of both
  vec3 normal;
  vec3 axis;
  float age;
};

// `before`: window position in pixels and depth.
History historyAt(Guide here, vec2 slope, vec3 before) {
  History h = History(vec3(0.0), vec3(0.0), vec2(0.0), vec3(0.0), vec3(0.0), 0.0);
  ivec2 size = textureSize(historyGuide, 0);
  vec2 corner = before.xy - 0.5;
  if (!historyHolds || weights == kBilinearWeights || !all(greaterThanEqual(corner, vec2(-0.5))) || !all(lessThan(corner, vec2(size) - 0.5))) return h;
  ivec2 base = ivec2(floor(corner));
  vec2 f = corner - vec2(base);
  float unit = depthUnit(depthScaleBefore, before.z);
  vec2 sum = vec2(0.0);
  float found = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    ivec2 at = clamp(base + offset, ivec2(0), size - 1);
    Guide then = unpackGuide(texelFetch(historyGuide, at, 0));
    float w = (offset.x == 1 ? f.x : 1.0 - f.x) * (offset.y == 1 ? f.y : 1.0 - f.y);
    if (then.depth >= 1.0 || then.body != here.body || !(w > 1.0e-3)) continue;
    w *= planeWeight((then.depth - before.z) / unit, slope, vec2(at) + 0.5 - before.xy);
    w *= smoothstep(kOtherSurface, kSameSurface, dot(here.normal, then.normal));
    vec2 like = nearness(here, then) * w;
    vec4 d = texelFetch(historyDiffuse, at, 0);
    vec4 r = texelFetch(historyReflected, at, 0);
    if (!(d.a + r.a >= 0.0)) continue;  // not a number
    vec2 worth = like * vec2(d.a, r.a);
    sum += like;
    h.diffuse += d.rgb * worth.x;
    h.reflected += r.rgb * worth.y;
    h.normal += then.normal * worth.x;
    h.axis += then.axis * worth.y;
    h.worth += worth;
    found += w;
    h.age += float(then.age) * worth.y;
  }
  if (h.worth.x > 0.0) {
    h.diffuse /= h.worth.x;
    h.normal /= h.worth.x;
  }
  if (h.worth.y > 0.0) {
    h.reflected /= h.worth.y;
    h.axis /= h.worth.y;
    h.age /= h.worth.y;
  }
  h.worth *= smoothstep(kLeastFound, 2.0 * kLeastFound, found);
  if (weights == kLobeWeights) {  // what the mean of them looked through, beside this pixel's own
    Guide mean = here;
    if (dot(h.normal, h.normal) > 1.0e-4) mean.normal = normalize(h.normal);
    if (dot(h.axis, h.axis) > 1.0e-4) mean.axis = normalize(h.axis);
    h.worth *= found * nearness(here, mean) / max(sum, vec2(1.0e-6));
  }
  return h;
}
