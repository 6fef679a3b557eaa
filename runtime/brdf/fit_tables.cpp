// Fits the tables of every reflectance model, of Ashikhmin and Shirley's with equal exponents, and writes them as C++: fit_tables OUTPUT.cpp. Runs when the library is built.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "runtime/brdf/reflectance_fit.h"
#include "shaders/cpp/lobe.h"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: fit_tables OUTPUT.cpp\n", stderr);
    return 2;
  }
  using namespace chiaro;
  std::ofstream out(arguments[1]);
  out.precision(9);  // enough for every float
  out << "#include \"runtime/brdf/embedded_tables.h\"\n\n#include <array>\n\nnamespace chiaro {\nnamespace {\n\n";
  constexpr int kinds[] = {lobe64::kCookTorrance, lobe64::kBeckmann, lobe64::kBlinnPhong, lobe64::kWard, lobe64::kGgx, lobe64::kAshikhminShirley};
  for (const int kind : kinds) {
    out << "constexpr float kTable" << kind << "[] = {";
    const char* separator = "";
    for (const glm::vec4& entry : makeReflectanceTable(kind).entries)
      for (int c = 0; c < 4; ++c) out << separator << std::scientific << entry[c] << 'f', separator = ",\n";
    out << "};\n\n";
  }
  out << "}  // namespace\n\nstd::span<const float> embeddedTable(int kind) {\n"
         "  static constexpr std::array<std::span<const float>, 6> tables{";
  for (const int kind : kinds) out << (kind == kinds[0] ? "" : ", ") << "kTable" << kind;
  out << "};\n  return tables.at(static_cast<std::size_t>(kind));\n}\n\n}  // namespace chiaro\n";
  out.close();
  if (out.good()) return 0;
  std::fprintf(stderr, "fit_tables: %s: cannot be written: check the folder and the space left\n", arguments[1]);
  std::remove(arguments[1]);
  return 4;
}
