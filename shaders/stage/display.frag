#version 450 core
#include "shaders/lobe/display.glsl"

in vec2 ndc;
layout(binding = 0) uniform sampler2D source;
uniform float exposure;
uniform int toneMap;

layout(location = 0) out vec4 color;

void main() {
  vec3 radiance = textureLod(source, 0.5 * ndc + 0.5, 0.0).rgb;
  color = vec4(displayEncode(radiance, exposure, toneMap), 1.0);
}
