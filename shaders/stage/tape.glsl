// What a pixel asks of visibility and of light, in its order: counted, written down, or answered from outside with better values, so that one stage of the
// shading is exact and the rest as it is (runtime/render/shading_tape.h). Without TAPE nothing is asked.
const int kTapedSurface = 0;     // not a question: the surface, as textures were filtered for it
const int kTapedShare = 1;       // visible share of a lobe, of what is above the horizon
const int kTapedFixedShare = 2;  // the same weighted by the cosine: a fixed lobe of the vertices
const int kTapedMean = 3;        // mean radiance of the environment under a lobe
const int kTapedLobe = 4;        // mean light that arrives through a lobe
const int kTapedIrradiance = 5;  // about the normal in place of an axis
const int kTapedRest = 6;        // mean light of the environment without its lights that arrives through a fixed lobe

#ifdef TAPE
const int kTapeCounts = 0;
const int kTapeRecords = 1;

struct TapedQuestion {
  vec4 lobe;    // axis, sharpness
  vec4 answer;  // w: the kind; answered: above 0 where rgb is to be used
};
layout(std430, binding = 8) buffer TapeBuffer { TapedQuestion tape[]; };
layout(std430, binding = 9) buffer TapeStartBuffer { uint tapeStarts[]; };  // by pixel, top row first; while it counts: how many questions

uniform int tapeMode;
uniform ivec2 tapeSize;
int tapeAsked = 0;

int tapePixel() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  return (tapeSize.y - 1 - at.y) * tapeSize.x + at.x;
}

vec3 taped(int kind, vec3 axis, float sharpness, vec3 own) {
  int asked = tapeAsked++;
  if (tapeMode == kTapeCounts) return own;
  uint place = tapeStarts[tapePixel()] + uint(asked);
  if (tapeMode == kTapeRecords) {
    // What the surface is has no answer and uses its place.
    tape[place] = TapedQuestion(vec4(axis, sharpness), vec4(kind == kTapedSurface ? own : vec3(0.0), float(kind)));
    return own;
  }
  vec4 answer = tape[place].answer;
  return answer.w > 0.0 ? answer.rgb : own;
}

void tapeEnd() {
  if (tapeMode == kTapeCounts) tapeStarts[tapePixel()] = uint(tapeAsked);
}
#else
vec3 taped(int kind, vec3 axis, float sharpness, vec3 own) { return own; }
void tapeEnd() {}
#endif

float tapedShare(int kind, vec3 axis, float sharpness, float own) { return taped(kind, axis, sharpness, vec3(own)).x; }
