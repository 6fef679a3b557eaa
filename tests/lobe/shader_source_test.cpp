#include "runtime/gl/shader_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "assets/error.h"

namespace chiaro::gl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

ShaderReader readerOf(std::map<std::string, std::string> files) {
  return [files = std::move(files)](const std::string& name) -> std::optional<std::string> {
    const auto it = files.find(name);
    return it == files.end() ? std::nullopt : std::optional(it->second);
  };
}

std::string failure(const std::string& root, const std::map<std::string, std::string>& files) {
  try {
    resolveShader(root, readerOf(files));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::size_t occurrences(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(ShaderSource, ExpandsEachFileOnceWhereFirstIncluded) {
  const ShaderText text = resolveShader("a", readerOf({{"a", "#include \"b\"\n#include \"c\"\nint a;\n"},
                                                       {"b", "#include \"c\"\nint b;\n"},
                                                       {"c", "int c;\n"}}));
  EXPECT_THAT(text.files, ElementsAre("a", "b", "c"));
  EXPECT_EQ(occurrences(text.text, "int c;"), 1u);
  EXPECT_LT(text.text.find("int c;"), text.text.find("int b;"));
  EXPECT_LT(text.text.find("int b;"), text.text.find("int a;"));
}

TEST(ShaderSource, VersionIsFirstAndDefinesFollow) {
  const std::vector<std::string> defines{"COUNT 3"};
  const ShaderText given = resolveShader("a", readerOf({{"a", "// head\n#version 460 core\nint a;\n"}}), defines);
  EXPECT_EQ(given.text.rfind("#version 460 core\n#define COUNT 3\n", 0), 0u) << given.text;
  EXPECT_EQ(occurrences(given.text, "#version"), 1u);
  const ShaderText added = resolveShader("a", readerOf({{"a", "int a;\n"}}));
  EXPECT_EQ(added.text.rfind("#version 450 core\n", 0), 0u) << added.text;
}

TEST(ShaderSource, KnowsWhereEachLineComesFrom) {
  const std::vector<std::string> defines{"COUNT 3"};
  const ShaderText text = resolveShader("a",
                                        readerOf({{"a", "#version 450\nint a2;\n#include \"b\"\nint a4;\n#include \"c\"\nint a6;"},
                                                  {"b", "int b1;\n#include \"c\"\n/*\n*/ int b4;\n"},
                                                  {"c", "\nint c2;\n"}}),
                                        defines);
  std::string list;
  for (std::size_t i = 0, start = 0; i < text.lines.size(); ++i) {
    const std::size_t end = text.text.find('\n', start);
    ASSERT_NE(end, std::string::npos);
    list += text.files.at(text.lines[i].file) + std::to_string(text.lines[i].line) + " " + text.text.substr(start, end - start) + "|";
    start = end + 1;
  }
  EXPECT_EQ(list, "a0 #version 450|a0 #define COUNT 3|a2 int a2;|b1 int b1;|c1 |c2 int c2;|b3 /*|b4 */ int b4;|a4 int a4;|a6 int a6;|");
}

TEST(ShaderSource, RefusesACycleAndShowsIt) {
  EXPECT_THAT(failure("a", {{"a", "\n#include \"b\"\n"}, {"b", "#include \"c\"\n"}, {"c", "\n\n#include \"a\"\n"}}),
              HasSubstr("c:3: include cycle a -> b -> c -> a"));
  EXPECT_THAT(failure("a", {{"a", "#include \"a\"\n"}}), HasSubstr("a:1: include cycle a -> a"));
}

TEST(ShaderSource, NamesTheLineOfAMissingFile) {
  EXPECT_THAT(failure("a", {{"a", "#include \"b\"\n"}, {"b", "int b;\n#include \"nowhere.glsl\"\n"}}),
              HasSubstr("b:2: no shader file \"nowhere.glsl\""));
  EXPECT_THAT(failure("gone", {}), HasSubstr("gone: no such shader"));
}

TEST(ShaderSource, RefusesMalformedIncludesAndInnerVersions) {
  EXPECT_THAT(failure("a", {{"a", "#include <b>\n"}}), HasSubstr("a:1: malformed #include <b>"));
  EXPECT_THAT(failure("a", {{"a", "#include \"b\n"}}), HasSubstr("a:1: malformed"));
  EXPECT_THAT(failure("a", {{"a", "#include \"b\"\n"}, {"b", "int b;\n#version 450\n"}}), HasSubstr("b:2: #version in an included file"));
}

TEST(ShaderSource, LeavesCommentedIncludesAlone) {
  const ShaderText text = resolveShader("a", readerOf({{"a", "// #include \"b\"\n/*\n#include \"c\"\n*/\nint a;\n"}}));
  EXPECT_THAT(text.files, ElementsAre("a"));
}

// The three shapes in which drivers write string number and line.
TEST(ShaderSource, MapsEveryDriversLog) {
  const ShaderText text{"", {"root.comp", "shaders/lobe/sg.glsl"}, {{0, 0}, {1, 41}, {0, 7}}};
  EXPECT_EQ(mapShaderLog("0:2(10): error: `x' undeclared\n", text), "shaders/lobe/sg.glsl:41:10: error: `x' undeclared\n");
  EXPECT_EQ(mapShaderLog("0(2) : error C1503: undefined variable\n", text), "shaders/lobe/sg.glsl:41: error C1503: undefined variable\n");
  EXPECT_EQ(mapShaderLog("ERROR: 0:3: 'x' : undeclared\n", text), "root.comp:7: ERROR: 'x' : undeclared\n");
  EXPECT_EQ(mapShaderLog("0:1(1): error: e\n", text), "line 1:1: error: e\n");
  EXPECT_EQ(mapShaderLog("0:4(1): error: e\n", text), "string 0:4:1: error: e\n");
  EXPECT_EQ(mapShaderLog("Linking failed\n", text), "Linking failed\n");
  EXPECT_EQ(mapShaderLog("9:1(1): error: e\n", text), "string 9:1:1: error: e\n");
}

TEST(ShaderSource, EmbedsTheLobeFiles) {
  const std::vector<std::string> names = embeddedShaderNames();
  EXPECT_THAT(names, testing::Contains("shaders/lobe/sg.glsl"));
  EXPECT_THAT(names, testing::Contains("shaders/lobe/dialect.glsl"));
  EXPECT_FALSE(readEmbeddedShader("shaders/lobe/none.glsl").has_value());
  // What was embedded is the file, byte for byte.
  if (const char* source = std::getenv("CHIARO_SOURCE_DIR")) {
    for (const std::string& name : names) {
      std::ifstream file(std::filesystem::path(source) / name, std::ios::binary);
      const std::string onDisk((std::istreambuf_iterator<char>(file)), {});
      EXPECT_EQ(readEmbeddedShader(name).value_or(""), onDisk) << name;
    }
  }
}

TEST(ShaderSource, OverrideFolderWins) {
  const std::filesystem::path folder = std::filesystem::current_path() / "override";
  std::filesystem::create_directories(folder / "shaders/lobe");
  std::ofstream(folder / "shaders/lobe/sg.glsl") << "int fromDisk;\n";
  ::setenv("CHIARO_SHADER_PATH", folder.c_str(), 1);
  const std::string replaced = readEmbeddedShader("shaders/lobe/sg.glsl").value_or("");
  const std::string untouched = readEmbeddedShader("shaders/lobe/sh.glsl").value_or("");
  ::unsetenv("CHIARO_SHADER_PATH");
  std::filesystem::remove_all(folder);
  EXPECT_EQ(replaced, "int fromDisk;\n");
  EXPECT_THAT(untouched, HasSubstr("shEvaluate"));
  EXPECT_THAT(readEmbeddedShader("shaders/lobe/sg.glsl").value_or(""), Not(HasSubstr("fromDisk")));
}

}  // namespace
}  // namespace chiaro::gl
