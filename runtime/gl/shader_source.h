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

/// Where a line comes from: an index into ShaderText::files, and a line counted from 1, or 0 for one that is in no file.
struct ShaderLine {
  std::size_t file = 0;
  std::size_t line = 0;
};

/// A shader with its includes resolved. There are no `#line` directives in it: Mesa forgets their string number in most errors
/// (it reports the right line of string 0), so it is `lines[i]` that says where line i + 1 comes from.
struct ShaderText {
  std::string text;
  std::vector<std::string> files{};
  std::vector<ShaderLine> lines{};
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

/// The driver's log of this text with names and lines of files: "shaders/lobe/sg.glsl:41: error: ...".
/// Understands Mesa "0:41(10): ", NVIDIA "0(41) : " and the "ERROR: 0:41: " of others; other lines pass unchanged.
std::string mapShaderLog(std::string_view log, const ShaderText& source);

}  // namespace chiaro::gl
