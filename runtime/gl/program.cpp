#include "runtime/gl/program.h"

#include "assets/error.h"

namespace chiaro::gl {
namespace {

struct ShaderDeleter {
  static void destroy(GLuint id) { glDeleteShader(id); }
};
using Shader = Handle<ShaderDeleter>;

std::string shaderLog(GLuint id) {
  GLint length = 0;
  glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
  if (length > 0) glGetShaderInfoLog(id, length, nullptr, log.data());
  return log;
}

std::string programLog(GLuint id) {
  GLint length = 0;
  glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
  if (length > 0) glGetProgramInfoLog(id, length, nullptr, log.data());
  return log;
}

Shader compile(GLenum type, const ShaderText& source) {
  Shader shader(glCreateShader(type));
  const char* text = source.text.c_str();
  const auto length = static_cast<GLint>(source.text.size());
  glShaderSource(shader.id(), 1, &text, &length);
  glCompileShader(shader.id());
  GLint ok = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
  if (ok != GL_TRUE) {
    const std::string& name = source.files.empty() ? std::string("shader") : source.files.front();
    throw Error(ExitCode::failed, name, "does not compile: " + mapShaderLog(shaderLog(shader.id()), source), "");
  }
  return shader;
}

}  // namespace

Program Program::link(const std::vector<std::pair<GLenum, ShaderText>>& stages) {
  std::vector<Shader> shaders;
  for (const auto& [type, source] : stages) shaders.push_back(compile(type, source));
  Program program(glCreateProgram());
  for (const Shader& shader : shaders) glAttachShader(program.id(), shader.id());
  glLinkProgram(program.id());
  for (const Shader& shader : shaders) glDetachShader(program.id(), shader.id());
  GLint ok = GL_FALSE;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::string names;
    for (const auto& [type, source] : stages) {
      if (!source.files.empty()) names += (names.empty() ? "" : " + ") + source.files.front();
    }
    throw Error(ExitCode::failed, names, "does not link: " + mapShaderLog(programLog(program.id()), stages.size() == 1 ? stages.front().second : ShaderText{}), "");
  }
  return program;
}

Program Program::load(Stages stages, const std::vector<std::string>& defines) {
  std::vector<std::pair<GLenum, ShaderText>> sources;
  for (const auto& [type, name] : stages) sources.emplace_back(type, loadShader(name, defines));
  return link(sources);
}

Program Program::loadCompute(const std::string& name, const std::vector<std::string>& defines) {
  return load({{GL_COMPUTE_SHADER, name}}, defines);
}

}  // namespace chiaro::gl
