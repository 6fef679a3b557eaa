#include "runtime/brdf/albedo_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

// The split-sum albedo against values computed independently by NDF quadrature (ALGORITHMS 7.5, four digits).
TEST(AlbedoTable, AlbedoMatchesPublishedQuadrature) {
  struct Case {
    double cosine, roughness, base, fresnel;
  };
  for (const Case c : {Case{.2, .3, .6893, .2254}, Case{.5, .5, .8349, .0223}, Case{.8, .3, .9869, .0008}, Case{1, .5, .9158, 0},
                       Case{1, 1, .3068, 0}, Case{.05, .5, .7703, .1643}}) {
    const auto albedo = ggxAlbedo(c.roughness * c.roughness, c.cosine);
    EXPECT_LE(std::abs(albedo.x - c.base), 2e-3) << c.cosine << " " << c.roughness;
    EXPECT_LE(std::abs(albedo.y - c.fresnel), 2e-3) << c.cosine << " " << c.roughness;
  }
}

TEST(AlbedoTable, SameForAnyThreadCount) { EXPECT_EQ(makeAlbedoTable(6, 1).entries, makeAlbedoTable(6, 3).entries); }

}  // namespace
}  // namespace chiaro
