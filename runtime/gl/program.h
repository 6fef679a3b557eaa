#pragma once
/// A linked GL program.

#include <epoxy/gl.h>

#include <glm/glm.hpp>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/gl/handle.h"
#include "runtime/gl/shader_source.h"

namespace chiaro::gl {

struct ProgramDeleter {
  static void destroy(GLuint id) { glDeleteProgram(id); }
};

/// Move-only. Every maker throws Error (failed) whose text holds the driver's log with our file names and lines.
class Program {
 public:
  using Stages = std::initializer_list<std::pair<GLenum, std::string>>;

  Program() = default;
  /// Stage files of the embedded set, e.g. load({{GL_VERTEX_SHADER, "shaders/stage/mesh.vert"}, ...}, {"COUNT 3"}).
  static Program load(Stages stages, const std::vector<std::string>& defines = {});
  static Program loadCompute(const std::string& name, const std::vector<std::string>& defines = {});
  /// Stages already resolved.
  static Program link(const std::vector<std::pair<GLenum, ShaderText>>& stages);

  GLuint id() const { return handle_.id(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }
  void use() const { glUseProgram(id()); }
  /// -1 when the program has no such active uniform (setting it is then silently ignored, as GL does).
  GLint uniform(const char* name) const { return glGetUniformLocation(id(), name); }

  void set(const char* name, int value) const { glProgramUniform1i(id(), uniform(name), value); }
  void set(const char* name, unsigned value) const { glProgramUniform1ui(id(), uniform(name), value); }
  void set(const char* name, float value) const { glProgramUniform1f(id(), uniform(name), value); }
  void set(const char* name, glm::ivec2 v) const { glProgramUniform2i(id(), uniform(name), v.x, v.y); }
  void set(const char* name, glm::vec2 v) const { glProgramUniform2f(id(), uniform(name), v.x, v.y); }
  void set(const char* name, glm::vec3 v) const { glProgramUniform3f(id(), uniform(name), v.x, v.y, v.z); }
  void set(const char* name, glm::vec4 v) const { glProgramUniform4f(id(), uniform(name), v.x, v.y, v.z, v.w); }
  void set(const char* name, const glm::mat3& m) const { glProgramUniformMatrix3fv(id(), uniform(name), 1, GL_FALSE, &m[0][0]); }
  void set(const char* name, const glm::mat4& m) const { glProgramUniformMatrix4fv(id(), uniform(name), 1, GL_FALSE, &m[0][0]); }

 private:
  explicit Program(GLuint id) : handle_(id) {}
  Handle<ProgramDeleter> handle_;
};

}  // namespace chiaro::gl
