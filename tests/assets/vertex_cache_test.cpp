// A mesh that changes shape, from files that the test makes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "assets/error.h"
#include "assets/scene/load_scene.h"
#include "assets/scene/vertex_cache.h"

namespace chiaro {
namespace {

constexpr float kUndefined = std::numeric_limits<float>::quiet_NaN();

void write(const std::string& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

void writeFrames(const std::string& file, const std::vector<glm::vec3>& positions) {
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(positions.data()), static_cast<std::streamsize>(positions.size() * sizeof(glm::vec3)));
}

/// A square in the plane of x and z; its second frame is lifted at one side.
class VertexCacheTest : public testing::Test {
 protected:
  void SetUp() override {
    write("cache_rest.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 0 1\n0 0 1\n3 0 3 2\n3 0 2 1\n");
    flat_ = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    lifted_ = {{0, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, 0, 1}};
    auto both = flat_;
    both.insert(both.end(), lifted_.begin(), lifted_.end());
    writeFrames("cache.bin", both);
    // As a bake has it: another order, and a corner twice.
    Primitive square;
    square.positions = {{1, 0, 1}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}};
    square.normals.assign(5, {0, 1, 0});
    square.indices = {1, 2, 0, 4, 0, 3};
    Primitive other;
    other.positions = {{5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
    other.normals.assign(3, {0, 0, 1});
    other.indices = {0, 1, 2};
    scene_.meshNames = {"other", "square"};
    scene_.primitives = {other, square};
  }

  std::string refusal(const Scene& scene, const VertexCacheFiles& files) {
    try {
      const VertexCache cache(scene, files);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing was refused";
  }

  std::vector<glm::vec3> flat_, lifted_;
  Scene scene_;
  VertexCacheFiles files_{"cache.bin", "cache_rest.off"};
};

TEST_F(VertexCacheTest, FindsItsVerticesInTheBakedOrder) {
  const VertexCache cache(scene_, files_);
  ASSERT_EQ(cache.frameCount(), 2u);
  EXPECT_EQ(cache.bounds().upper, glm::vec3(1, 1, 1));
  const auto shapes = cache.at(1.0);
  ASSERT_EQ(shapes.size(), 1u);
  EXPECT_EQ(shapes[0].primitive, 1u);
  EXPECT_EQ(shapes[0].positions, (std::vector<glm::vec3>{{1, 1, 1}, {0, 0, 0}, {0, 0, 1}, {1, 1, 0}, {0, 0, 0}}));
  for (const auto& n : shapes[0].normals) EXPECT_LE(glm::distance(n, glm::normalize(glm::vec3(-1, 1, 0))), 1e-6f);
}

TEST_F(VertexCacheTest, GoesForthAndBackAndBetween) {
  const VertexCache cache(scene_, files_);
  for (const auto& [frame, height] : {std::pair{0.0, 0.0f}, {0.25, 0.25f}, {1.5, 0.5f}, {2.0, 0.0f}, {3.0, 1.0f}, {-0.5, 0.5f}})
    EXPECT_FLOAT_EQ(cache.at(frame)[0].positions[0].y, height) << frame;
}

// A corner that is bent in the bake stays so: it has another normal there.
TEST_F(VertexCacheTest, KeepsCreases) {
  scene_.primitives[1].normals[4] = glm::vec3(0, 0, 1);
  std::vector<glm::vec3> folded = flat_;
  folded[1].y = 1.0f;
  writeFrames("cache_folded.bin", folded);
  const auto normals = VertexCache(scene_, {"cache_folded.bin", "cache_rest.off"}).at(0.0)[0].normals;
  EXPECT_LE(glm::distance(normals[1], glm::vec3(0, 1, 0)), 1e-6f);
  EXPECT_LE(glm::distance(normals[4], glm::normalize(glm::vec3(-1, 1, 1))), 1e-6f);
}

TEST_F(VertexCacheTest, RefusesWhatDoesNotFit) {
  using testing::HasSubstr;
  writeFrames("cache_cut.bin", {flat_[0], flat_[1], flat_[2]});
  EXPECT_THAT(refusal(scene_, {"cache_cut.bin", "cache_rest.off"}), HasSubstr("are no whole frames of 4 vertices"));
  write("cache_empty.bin", "");
  EXPECT_THAT(refusal(scene_, {"cache_empty.bin", "cache_rest.off"}), HasSubstr("are no whole frames"));
  auto bad = flat_;
  bad[2].z = kUndefined;
  writeFrames("cache_bad.bin", bad);
  EXPECT_THAT(refusal(scene_, {"cache_bad.bin", "cache_rest.off"}), HasSubstr("vertex 2 of frame 0 is not finite"));
  EXPECT_THAT(refusal(scene_, {"cache_none.bin", "cache_rest.off"}), HasSubstr("cache_none.bin"));
  write("cache_rest.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3\n");
  EXPECT_THAT(refusal(scene_, {"cache.bin", "cache_rest.obj"}), HasSubstr("cache_rest.obj: keeps no order of vertices"));
  Scene refined = scene_;
  refined.primitives[1].positions[0] = {0.5f, 0, 0.5f};
  EXPECT_THAT(refusal(refined, files_), HasSubstr("1 of 5 baked vertices are none of it"));
  refined.primitives.pop_back();
  EXPECT_THAT(refusal(refined, files_), HasSubstr("none of its vertices is in the baked scene"));
}

}  // namespace
}  // namespace chiaro
