# cmake -DROOT=<checkout> -DOUTPUT=<file.cpp> -P EmbedShaders.cmake
# Writes every text file under shaders/ as a raw string, so that no program looks for its shaders at run time.
file(GLOB_RECURSE files RELATIVE "${ROOT}"
  "${ROOT}/shaders/*.glsl" "${ROOT}/shaders/*.vert" "${ROOT}/shaders/*.frag" "${ROOT}/shaders/*.comp")
list(SORT files)
set(entries "")
foreach(file IN LISTS files)
  file(READ "${ROOT}/${file}" text)
  string(APPEND entries "  {\"${file}\", R\"CHIARO(${text})CHIARO\"},\n")
endforeach()
set(code "#include \"runtime/gl/embedded_shaders.h\"\n\n#include <array>\n\nnamespace chiaro::gl {\nnamespace {\n\n")
list(LENGTH files count)
string(APPEND code "constexpr std::array<EmbeddedShader, ${count}> kShaders{{\n${entries}}};\n\n}  // namespace\n\n")
string(APPEND code "std::span<const EmbeddedShader> embeddedShaders() { return kShaders; }\n\n}  // namespace chiaro::gl\n")
file(WRITE "${OUTPUT}" "${code}")
