#pragma once
/// A mesh that changes shape, from a vertex cache: where every vertex of a mesh file is, frame after frame.

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

/// What a primitive of a scene looks like at a time: as many as it has vertices, world space, normals of unit length.
struct PrimitiveShape {
  std::size_t primitive = 0;  ///< into Scene::primitives
  std::vector<glm::vec3> positions, normals;
};

struct VertexCacheFiles {
  std::filesystem::path frames;  ///< raw little-endian float32 x y z of each vertex of `rest` in its order, frame after frame; empty: no cache
  std::filesystem::path rest;    ///< the mesh file that was baked, .ply or .off
};

class VertexCache {
 public:
  /// `scene` holds the vertices of `rest` wherever these stood then, in any order and as often as it likes; other primitives of it rest. Throws Error
  /// (input) for files that are missing, damaged, of another number of vertices or not finite, and where a primitive has some of the vertices and not all.
  VertexCache(const Scene& scene, const VertexCacheFiles& files);

  std::size_t frameCount() const { return frameCount_; }
  /// Forth through all frames and back again, over and over; linear between two. Normals are made as a bake makes them: vertices of one place and
  /// one baked normal share the mean of their triangles', weighted by the corners' angles.
  std::vector<PrimitiveShape> at(double frame) const;
  /// What all frames cover.
  const Bounds& bounds() const { return bounds_; }

 private:
  void readRest(const std::filesystem::path& file);
  void readFrames(const std::filesystem::path& file);
  void find(const Scene& scene, const std::string& where);

  struct Part {
    std::size_t primitive = 0;
    std::vector<std::uint32_t> vertices;  // of the mesh file
    std::vector<std::uint32_t> smooth;    // the first vertex of the primitive that shares the normal of this one
    std::vector<std::uint32_t> indices;
  };
  static std::vector<glm::vec3> normalsOf(const Part& part, const std::vector<glm::vec3>& positions);
  std::vector<glm::vec3> rest_;
  std::vector<glm::vec3> frames_;
  std::size_t frameCount_ = 0;
  std::vector<Part> parts_;
  Bounds bounds_;
};

}  // namespace chiaro
