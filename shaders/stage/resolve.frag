#version 450 core
// Box filter of supersample^2 shaded points into one pixel.
layout(binding = 0) uniform sampler2D source;
uniform int supersample;

layout(location = 0) out vec4 color;

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * supersample;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < supersample; ++y)
    for (int x = 0; x < supersample; ++x) sum += texelFetch(source, corner + ivec2(x, y), 0);
  color = sum / float(supersample * supersample);
}
