#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "assets/error.h"
#include "runtime/gl/buffer.h"
#include "runtime/gl/framebuffer.h"
#include "runtime/gl/program.h"
#include "runtime/gl/query.h"
#include "runtime/gl/texture.h"
#include "tests/lobe/gl_test_main.h"

namespace chiaro::gl {
namespace {

using testing::HasSubstr;

class GlWrapper : public testing::Test {
 protected:
  void SetUp() override { testContext().debugLog().clear(); }
  void TearDown() override { EXPECT_THAT(testContext().debugLog().messages(), testing::IsEmpty()); }
};

std::string linkFailure(const ShaderText& source) {
  try {
    Program::link({{GL_COMPUTE_SHADER, source}});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A file that needs another must include it itself: each is compiled as the only include of an empty compute shader.
TEST_F(GlWrapper, EveryLobeFileCompilesAlone) {
  int count = 0;
  for (const std::string& name : embeddedShaderNames()) {
    if (name.rfind("shaders/lobe/", 0) != 0) continue;
    const std::string main = "#include \"" + name + "\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
    EXPECT_NO_THROW(Program::link({{GL_COMPUTE_SHADER, resolveShaderText("alone.comp", main, readEmbeddedShader)}})) << name;
    ++count;
  }
  EXPECT_GE(count, 11);
}

// The driver's own message must come back with the file and line where the mistake was made, two includes deep.
TEST_F(GlWrapper, CompileErrorNamesFileAndLine) {
  const ShaderReader reader = [](const std::string& name) -> std::optional<std::string> {
    if (name == "shaders/outer.glsl") return "int before;\n#include \"shaders/inner.glsl\"\nint after;\nfloat g() { return missingOuter; }\n";
    if (name == "shaders/inner.glsl") return "int one;\nint two;\nfloat f() { return missingInner; }\nvoid k() {\n  alsoMissing;\n}\n";
    return std::nullopt;
  };
  const std::string root = "// head\n#include \"shaders/outer.glsl\"\n\nlayout(local_size_x = 1) in;\nvoid main() {}\nfloat h() { return missingRoot; }\n";
  const std::string message = linkFailure(resolveShaderText("root.comp", root, reader));
  EXPECT_THAT(message, HasSubstr("shaders/inner.glsl:3:"));
  EXPECT_THAT(message, HasSubstr("shaders/inner.glsl:5:")) << "where Mesa forgets which string it was in";
  EXPECT_THAT(message, HasSubstr("shaders/outer.glsl:4:"));
  EXPECT_THAT(message, HasSubstr("root.comp:6:"));
  testContext().debugLog().clear();  // the driver reports the failed compile here as well
}

TEST_F(GlWrapper, LinkErrorThrows) {
  // Two stages that disagree about a varying.
  const ShaderText vertex{"#version 450 core\nout vec3 v;\nvoid main() { v = vec3(1); gl_Position = vec4(0); }\n", {"a.vert"}};
  const ShaderText fragment{"#version 450 core\nin vec2 v;\nout vec4 c;\nvoid main() { c = v.xyxy; }\n", {"a.frag"}};
  try {
    Program::link({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
    FAIL() << "linked";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.vert + a.frag: does not link"));
  }
  testContext().debugLog().clear();
}

TEST_F(GlWrapper, BufferRoundTripAndRange) {
  const std::vector<std::uint32_t> values{1, 2, 3, 0xffffffffu};
  Buffer buffer(values);
  EXPECT_EQ(buffer.read<std::uint32_t>(), values);
  const std::vector<std::uint32_t> tail{7};
  buffer.write(12, std::span<const std::uint32_t>(tail));
  EXPECT_EQ(buffer.read<std::uint32_t>()[3], 7u);
  EXPECT_THROW(buffer.write(13, std::span<const std::uint32_t>(tail)), std::out_of_range);
  EXPECT_THROW(buffer.writeBytes(~std::size_t{0}, values.data(), 4), std::out_of_range);
}

TEST_F(GlWrapper, MovedFromHandlesOwnNothing) {
  Buffer a(std::size_t{16});
  const GLuint id = a.id();
  Buffer b = std::move(a);
  EXPECT_EQ(b.id(), id);
  EXPECT_FALSE(static_cast<bool>(a));
  b = Buffer(std::size_t{32});
  EXPECT_FALSE(glIsBuffer(id));
}

TEST_F(GlWrapper, OddSizedThreeByteTextureRoundTrip) {
  Texture texture = Texture::make2dArray(GL_RGB8, 3, 2, 2);
  std::vector<std::uint8_t> pixels(3 * 3 * 2 * 2);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(7 * i);
  texture.upload(0, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  std::vector<std::uint8_t> back(pixels.size());
  texture.download(0, GL_RGB, GL_UNSIGNED_BYTE, back.data(), back.size());
  EXPECT_EQ(back, pixels);
}

TEST_F(GlWrapper, CubeArrayLayersAreSeparate) {
  Texture texture = Texture::makeCubeArray(GL_R32F, 4, 2, 0);
  EXPECT_EQ(texture.levels(), 3);
  EXPECT_EQ(texture.layers(), 12);
  std::vector<float> all(12 * 16, 0.0f), face(16, 5.0f);
  texture.upload(0, GL_RED, GL_FLOAT, all.data());
  texture.uploadLayer(0, 7, GL_RED, GL_FLOAT, face.data());
  texture.download(0, GL_RED, GL_FLOAT, all.data(), all.size() * sizeof(float));
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i / 16 == 7 ? 5.0f : 0.0f) << i;
}

TEST_F(GlWrapper, RefusesImpossibleTextureSizes) {
  EXPECT_THROW(Texture::make2d(GL_RGBA8, 0, 4), Error);
  EXPECT_THROW(Texture::make2d(GL_RGBA8, 1 << 28, 4), Error);
}

TEST_F(GlWrapper, DrawsIntoAFramebufferLayer) {
  Texture color = Texture::make2dArray(GL_RGBA32F, 5, 3, 2);
  const std::vector<float> zero(5 * 3 * 2 * 4, 0.0f);
  color.upload(0, GL_RGBA, GL_FLOAT, zero.data());
  Framebuffer target = Framebuffer::makeLayer(color, 0, 1);
  const ShaderText vertex{"#version 450 core\nvoid main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }\n", {"t.vert"}};
  const ShaderText fragment{"#version 450 core\nuniform vec3 tint;\nout vec4 c;\nvoid main() { c = vec4(tint, gl_FragCoord.x); }\n", {"t.frag"}};
  Program program = Program::link({{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
  program.set("tint", glm::vec3(1, 2, 3));
  VertexArray empty = VertexArray::create();
  TimerQuery timer = TimerQuery::create();
  target.bind();
  program.use();
  empty.bind();
  timer.begin();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  timer.end();
  const std::vector<float> pixels = target.readColor();
  ASSERT_EQ(pixels.size(), 60u);
  EXPECT_EQ(pixels[4 * 7 + 1], 2.0f);
  EXPECT_EQ(pixels[4 * 7 + 3], 2.5f);
  EXPECT_GE(timer.seconds(), 0.0);
  std::vector<float> all(zero.size());
  color.download(0, GL_RGBA, GL_FLOAT, all.data(), all.size() * sizeof(float));
  EXPECT_EQ(all[1], 0.0f);
}

TEST_F(GlWrapper, DebugLogCatchesAWrongCall) {
  glBindTextureUnit(0, 0x7fffffffu);
  EXPECT_THAT(testContext().debugLog().messages(), testing::Not(testing::IsEmpty()));
  EXPECT_THROW(testContext().debugLog().requireClean("test"), Error);
  testContext().debugLog().clear();
  while (glGetError() != GL_NO_ERROR) {
  }
}

}  // namespace
}  // namespace chiaro::gl
