#pragma once
/// From the name of a shader file to one text the driver compiles, and from the driver's complaint back to file and line.
/// No GL call here: usable and tested without a context.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace chiaro::gl {

/// A shader with its includes resolved. `files[i]` is the name behind string number i in the `#line` directives.
struct ShaderText {
  std::string text;
  std::vector<std::string> files;
};

/// The text of a file named from the checkout root ("shaders/lobe/sg.glsl"), or nothing when there is no such file.
using ShaderReader = std::function<std::optional<std::string>(const std::string& name)>;

/// The set compiled into this library. With the environment variable CHIARO_SHADER_PATH set to a directory that holds
/// `shaders/`, a file found there wins: edit shaders without rebuilding.
std::optional<std::string> readEmbeddedShader(const std::string& name);
/// Names of all embedded files, sorted.
std::vector<std::string> embeddedShaderNames();

/// Resolves `#include "name"` (name from the checkout root) recursively; each file appears once, where first included.
/// The result starts with the root's `#version` line, or `#version 450 core` when it has none, then one `#define` per entry of
/// `defines` ("NAME" or "NAME value").
/// Throws Error (failed) with file:line for a missing file, a malformed include, an include cycle, or a `#version` in an included file.
ShaderText resolveShader(const std::string& name, const ShaderReader& reader, std::span<const std::string> defines = {});
/// The same for a root text that is in no file; `name` is what errors call it.
ShaderText resolveShaderText(const std::string& name, std::string_view text, const ShaderReader& reader,
                             std::span<const std::string> defines = {});
/// resolveShader over the embedded set.
ShaderText loadShader(const std::string& name, std::span<const std::string> defines = {});

/// The driver's log with string numbers replaced by names: "shaders/lobe/sg.glsl:41: error: ...".
/// Understands Mesa "2:41(10): ", NVIDIA "2(41) : " and the "ERROR: 2:41: " of others; other lines pass unchanged.
std::string mapShaderLog(std::string_view log, const std::vector<std::string>& files);

}  // namespace chiaro::gl
