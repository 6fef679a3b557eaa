// A stranger's program: all it knows of chiaro is find_package.
#include <cstdio>

#include "assets/builtin/builtin_scene.h"
#include "precompute/bake.h"
#include "shaders/cpp/lobe.h"

int main() {
  chiaro::BakeSettings settings;
  settings.resolution = 16;
  chiaro::BakeReport report;
  const chiaro::BakedScene baked = chiaro::bake(chiaro::builtinScene("sphere"), settings, report);
  std::printf("%zu vertices, integral of an SG of sharpness 10: %.4f sr\n", report.vertices, chiaro::lobe64::sgUnitIntegral(10.0));
  return report.vertices > 0 && baked.transfer.resolution == settings.resolution ? 0 : 1;
}
