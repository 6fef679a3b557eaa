// Writes baked files for other people's tools to judge: write_samples FOLDER. Prints their names.
#include <cstdio>

#include "tests/assets/asset_test_support.h"

int main(int count, char** arguments) {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  try {
    for (const int terms : {0, 1, 6}) {
      const auto path = folder / ("sample" + std::to_string(terms) + ".glb");
      chiaro::writeBakedScene(path, chiaro::test::sampleBake(terms), "Chiaro's tests");
      std::puts(path.c_str());
    }
    const auto tiny = folder / "tiny.glb";
    chiaro::writeBakedScene(tiny, chiaro::test::tinyBake(), "Chiaro's tests");
    std::puts(tiny.c_str());
    const auto clustered = folder / "clustered.glb";
    chiaro::writeBakedScene(clustered, chiaro::test::clusteredBake(true), "Chiaro's tests");
    std::puts(clustered.c_str());
    return 0;
  } catch (const chiaro::Error& error) {
    std::fprintf(stderr, "write_samples: %s\n", error.what());
    return static_cast<int>(error.code());
  }
}
