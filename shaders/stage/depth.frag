#version 450 core
#include "shaders/stage/material.glsl"

in vec2 texcoord[kTextures];

void main() {
  MaterialBlock m = materials[materialIndex];
  if (m.textures.y == 1 && baseColorAt(m, texcoord[0]).a < m.emissive.w) discard;
}
