#pragma once
/// The triangles of a scene, ready to be asked what a ray meets. The only door to Embree 3 and 4.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include "assets/scene/scene.h"

namespace chiaro {

struct RayHit {
  float distance = 0.0f;             ///< along the unit direction
  std::uint32_t primitive = 0;       ///< index into Scene::primitives
  std::uint32_t triangle = 0;        ///< index of the triangle within it
  glm::vec2 barycentric{0.0f};       ///< weights of corners 1 and 2; corner 0 has 1 - u - v
  glm::vec3 geometricNormal{0.0f};   ///< unit, by the winding of the triangle
};

/// Thread safe once built. Robust Embree mode: a ray never slips between two triangles that share an edge.
/// Alpha-masked triangles are hit only where their base colour's alpha reaches the cutoff. Alpha-blended ones occlude nothing
/// (`occluded`), but are met by `intersect`.
class RayScene {
 public:
  /// Keeps a reference to `scene` (texture lookups of masked materials): it must outlive this object.
  explicit RayScene(const Scene& scene);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// Nearest hit with distance in (tnear, tfar); false when there is none.
  bool intersect(glm::vec3 origin, glm::vec3 direction, float tnear, float tfar, RayHit& hit) const;

  bool occluded(glm::vec3 origin, glm::vec3 direction, float tnear, float tfar) const;

  /// Sixteen rays at once from one origin; bit i of `active` asks for ray i. Returns a bit per occluded ray.
  /// x, y, z: 16 floats each, 64-byte aligned.
  std::uint32_t occluded16(glm::vec3 origin, const float* x, const float* y, const float* z, std::uint32_t active, float tnear, float tfar) const;

  /// How far to move a ray's origin off a surface at `position`: large enough to clear the rounding of the position and of
  /// Embree's intersection at any scene scale, small enough to be invisible (about 1e-5 of the larger of the scene's
  /// diagonal and the position's distance from the world's origin times float epsilon's headroom).
  float surfaceOffset(glm::vec3 position) const;

 private:
  friend class OcclusionPacket;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Packets of rays that share an origin and have no end: what they have in common is written once. For one thread.
class OcclusionPacket {
 public:
  explicit OcclusionPacket(const RayScene& rays);
  ~OcclusionPacket();
  OcclusionPacket(OcclusionPacket&&) noexcept;
  OcclusionPacket& operator=(OcclusionPacket&&) noexcept;

  /// Of the packets to come. Nothing occludes from one that is not finite.
  void setOrigin(glm::vec3 origin);

  /// RayScene::occluded16 of finite directions.
  std::uint32_t operator()(const float* x, const float* y, const float* z, std::uint32_t active);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chiaro
