#include "runtime/gl/shader_source.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "assets/error.h"
#include "runtime/gl/embedded_shaders.h"

namespace chiaro::gl {
namespace {

Error shaderError(const std::string& file, std::size_t line, const std::string& what, const std::string& remedy) {
  return {ExitCode::failed, file + ":" + std::to_string(line), what, remedy};
}

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r')) s.remove_suffix(1);
  return s;
}

/// The rest of a `#<keyword>` line, trimmed, or nothing when the line is another one.
std::optional<std::string_view> directive(std::string_view line, std::string_view keyword) {
  line = trimmed(line);
  if (line.empty() || line.front() != '#') return std::nullopt;
  line = trimmed(line.substr(1));
  if (!line.starts_with(keyword)) return std::nullopt;
  line.remove_prefix(keyword.size());
  if (!line.empty() && line.front() != ' ' && line.front() != '\t' && line.front() != '"' && line.front() != '<') return std::nullopt;
  return trimmed(line);
}

std::vector<std::string_view> linesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  }
  return lines;
}

/// Whether each line starts inside a block comment, so that a commented-out include stays out.
class CommentTracker {
 public:
  bool inside() const { return inside_; }
  void pass(std::string_view line) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const std::string_view two = line.substr(i, 2);
      if (inside_ && two == "*/") {
        inside_ = false;
        ++i;
      } else if (!inside_ && two == "/*") {
        inside_ = true;
        ++i;
      } else if (!inside_ && two == "//") {
        return;
      }
    }
  }

 private:
  bool inside_ = false;
};

class Resolver {
 public:
  explicit Resolver(const ShaderReader& reader) : reader_(reader) {}

  ShaderText resolve(const std::string& name, std::string_view text, std::span<const std::string> defines) {
    std::string version = "#version 450 core";
    for (std::string_view line : linesOf(text)) {
      if (directive(line, "version")) version = std::string(trimmed(line));
    }
    emit(version, {});
    for (const std::string& define : defines) emit("#define " + define, {});
    expand(name, text, true);
    return std::move(result_);
  }

 private:
  void expand(const std::string& name, std::string_view text, bool root) {
    const std::size_t number = result_.files.size();
    result_.files.push_back(name);
    stack_.push_back(name);
    CommentTracker comment;
    std::size_t lineNumber = 0;
    for (std::string_view line : linesOf(text)) {
      ++lineNumber;
      const bool commented = comment.inside();
      comment.pass(line);
      if (commented) {
        emit(line, {number, lineNumber});
      } else if (const auto target = directive(line, "include")) {
        include(name, lineNumber, *target);
      } else if (directive(line, "version")) {
        if (!root) throw shaderError(name, lineNumber, "#version in an included file", "remove it: only a stage file may have one");
      } else {
        emit(line, {number, lineNumber});
      }
    }
    stack_.pop_back();
  }

  void include(const std::string& from, std::size_t line, std::string_view target) {
    if (target.size() < 3 || target.front() != '"' || target.find('"', 1) != target.size() - 1) {
      throw shaderError(from, line, "malformed #include " + std::string(target), "write #include \"shaders/...\"");
    }
    const std::string name(target.substr(1, target.size() - 2));
    if (std::find(stack_.begin(), stack_.end(), name) != stack_.end()) {
      std::string path;
      for (const std::string& file : stack_) path += file + " -> ";
      throw shaderError(from, line, "include cycle " + path + name, "break it by moving the shared part to a third file");
    }
    if (std::find(result_.files.begin(), result_.files.end(), name) != result_.files.end()) return;
    const std::optional<std::string> text = reader_(name);
    if (!text) throw shaderError(from, line, "no shader file \"" + name + "\"", "names start at the checkout root, as in \"shaders/lobe/sg.glsl\"");
    expand(name, *text, false);
  }

  void emit(std::string_view line, ShaderLine origin) {
    result_.text.append(line).append("\n");
    result_.lines.push_back(origin);
  }

  const ShaderReader& reader_;
  ShaderText result_;
  std::vector<std::string> stack_;
};

}  // namespace

std::optional<std::string> readEmbeddedShader(const std::string& name) {
  if (const char* path = std::getenv("CHIARO_SHADER_PATH"); path != nullptr && *path != '\0') {
    std::ifstream file(std::filesystem::path(path) / name, std::ios::binary);
    if (file) {
      std::ostringstream text;
      text << file.rdbuf();
      return text.str();
    }
  }
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (shader.name == name) return std::string(shader.text);
  }
  return std::nullopt;
}

std::vector<std::string> embeddedShaderNames() {
  std::vector<std::string> names;
  for (const EmbeddedShader& shader : embeddedShaders()) names.emplace_back(shader.name);
  return names;
}

ShaderText resolveShaderText(const std::string& name, std::string_view text, const ShaderReader& reader,
                             std::span<const std::string> defines) {
  return Resolver(reader).resolve(name, text, defines);
}

ShaderText resolveShader(const std::string& name, const ShaderReader& reader, std::span<const std::string> defines) {
  const std::optional<std::string> text = reader(name);
  if (!text) throw Error(ExitCode::failed, name, "no such shader", "names start at the checkout root, as in \"shaders/stage/mesh.vert\"");
  return resolveShaderText(name, *text, reader, defines);
}

ShaderText loadShader(const std::string& name, std::span<const std::string> defines) {
  return resolveShader(name, readEmbeddedShader, defines);
}

std::string mapShaderLog(std::string_view log, const ShaderText& source) {
  static const std::regex mesa(R"(^(\d+):(\d+)\((\d+)\):\s*(.*)$)");
  static const std::regex nvidia(R"(^(\d+)\((\d+)\)\s*:\s*(.*)$)");
  static const std::regex others(R"(^(ERROR|WARNING):\s*(\d+):(\d+):\s*(.*)$)");
  const auto place = [&source](const std::string& string, const std::string& line) {
    std::size_t number = 0;
    std::from_chars(line.data(), line.data() + line.size(), number);
    if (string != "0" || number == 0 || number > source.lines.size()) return "string " + string + ":" + line;
    const ShaderLine& origin = source.lines[number - 1];
    return origin.line == 0 ? "line " + line : source.files[origin.file] + ":" + std::to_string(origin.line);
  };
  std::string mapped;
  for (std::string_view view : linesOf(log)) {
    const std::string line(trimmed(view));
    if (line.empty() || line.front() == '\0') continue;
    std::smatch m;
    if (std::regex_match(line, m, mesa)) {
      mapped += place(m[1], m[2]) + ":" + m[3].str() + ": " + m[4].str();
    } else if (std::regex_match(line, m, nvidia)) {
      mapped += place(m[1], m[2]) + ": " + m[3].str();
    } else if (std::regex_match(line, m, others)) {
      mapped += place(m[2], m[3]) + ": " + m[1].str() + ": " + m[4].str();
    } else {
      mapped += line;
    }
    mapped += "\n";
  }
  return mapped;
}

}  // namespace chiaro::gl
