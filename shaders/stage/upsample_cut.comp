#version 450 core
// Which urgencies the budget reaches, the most urgent first.
#include "shaders/stage/upsample_list.glsl"

layout(local_size_x = 1) in;
uniform uint budget;  // pixels

void main() {
  uint sum = 0u, all = 0u;
  for (int i = 0; i < kUrgencies; ++i) all += urgencies[i];
  cut = 0;
  cutShare = 1.0;
  for (int i = kUrgencies - 1; i >= 0; --i) {
    if (sum + urgencies[i] > budget) {
      cut = i;
      cutShare = float(budget - sum) / float(urgencies[i]);
      break;
    }
    sum += urgencies[i];
  }
  wanted = all;
  listed = 0u;
}
