// The pixels that the filter failed: how many of each urgency, where the budget cuts, and their list.
const int kUrgencies = 64;

layout(std430, binding = 8) buffer UrgencyBuffer {
  uint urgencies[kUrgencies];
  uint listed;
  int cut;         // the least urgency that is shaded
  float cutShare;  // of the pixels of just that urgency
  uint wanted;     // pixels that asked
};
layout(std430, binding = 9) buffer ListBuffer { uint list[]; };

// Six steps an octave; below 0: not worth it.
int urgencyStep(float urgency) { return urgency > 0.0 ? min(kUrgencies - 1 + int(floor(6.0 * log2(urgency))), kUrgencies - 1) : -1; }
