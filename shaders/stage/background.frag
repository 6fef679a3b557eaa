#version 450 core
#include "shaders/stage/frame.glsl"
#include "shaders/stage/environment.glsl"

in vec2 ndc;
layout(location = 0) out vec4 color;

// The environment where no surface was drawn; coverage 0.
void main() {
  vec3 direction;
  if (frame.eye.w > 0.5) {
    vec4 far = frame.worldFromClip * vec4(ndc, 1.0, 1.0);
    direction = normalize(far.xyz / far.w - frame.eye.xyz);
  } else {
    direction = -frame.eye.xyz;
  }
  color = vec4(environmentRadiance(direction), 0.0);
}
