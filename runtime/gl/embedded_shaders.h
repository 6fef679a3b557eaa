#pragma once
/// Written by cmake/EmbedShaders.cmake at build time: every file under shaders/, sorted by name.

#include <span>
#include <string_view>

namespace chiaro::gl {

struct EmbeddedShader {
  std::string_view name;  ///< from the checkout root: "shaders/lobe/sg.glsl"
  std::string_view text;
};

std::span<const EmbeddedShader> embeddedShaders();

}  // namespace chiaro::gl
