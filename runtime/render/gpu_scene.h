#pragma once
/// A baked scene in GPU memory.

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <vector>

#include "assets/transfer/transfer.h"
#include "runtime/gl/buffer.h"
#include "runtime/gl/texture.h"
#include "runtime/render/frame_block.h"
#include "runtime/render/gpu_transfer.h"
#include "runtime/render/material_features.h"

namespace chiaro {

struct GpuDraw {
  int firstIndex = 0;
  int indexCount = 0;
  int mesh = 0;           ///< into Scene::meshNames
  std::size_t firstVertex = 0, vertexCount = 0;
  int material = 0;       ///< into the material buffer; the last one is the glTF default
  glm::vec3 center{0.0f};
};

class GpuScene {
 public:
  /// Throws Error when an image cannot be decoded or the driver's limits are too small.
  explicit GpuScene(const BakedScene& baked);

  void setMaterials(const std::vector<Material>& materials);
  /// Of a primitive of the scene, as many as it has vertices. Throws Error (failed).
  void setShape(std::size_t primitive, std::span<const glm::vec3> positions, std::span<const glm::vec3> normals);
  /// At the end of a frame: where vertices are is where they were.
  void keepShapes();
  std::size_t meshCount() const { return meshCount_; }
  /// Geometry, transfer and materials to their binding points.
  void bindBuffers() const;
  /// The textures of a material to units 0..4, and where the scene has such, of specular and coat to 17..20.
  void bindTextures(int material) const;

  const std::vector<GpuDraw>& draws() const { return draws_; }
  const Material& material(int index) const { return materials_[static_cast<std::size_t>(index)]; }
  const MaterialFeatures& features() const { return features_; }
  /// Vertices have a place in the frame before of their own, since setShape() was called.
  bool hasShapes() const { return static_cast<bool>(before_); }
  const GpuTransfer& transfer() const { return transfer_; }
  float directionSharpness() const { return directionSharpness_; }
  const std::vector<glm::vec3>& directions() const { return directions_; }
  const Bounds& bounds() const { return bounds_; }
  std::size_t bytes() const { return bytes_ + transfer_.bytes(); }

 private:
  void uploadGeometry(const Scene& scene);
  void uploadTextures(const Scene& scene);
  void writeMaterials();

  struct Shape {
    std::vector<VertexBlock> vertices;
    bool moved = false;
  };
  std::vector<GpuDraw> draws_;
  std::vector<std::size_t> primitiveDraws_;  // of each primitive of the scene, into draws_
  std::map<std::size_t, Shape> shapes_;      // by primitive
  gl::Buffer before_;                        // positions in the frame before, once any shape was set
  std::size_t meshCount_ = 0;
  std::vector<Material> materials_;  // the scene's, then the default
  std::vector<Light> lights_;
  Bounds bounds_;
  GpuTransfer transfer_;
  float directionSharpness_ = 0.0f;
  std::vector<glm::vec3> directions_;
  gl::Buffer vertices_, indices_, materialBuffer_;
  gl::Texture white_;
  std::vector<gl::Texture> textures_;
  std::vector<std::array<int, kMaterialTextures>> materialTextures_;  // into textures_, or kNone
  MaterialFeatures features_;  // all that setMaterials() has brought up to now
  std::size_t bytes_ = 0;
};

}  // namespace chiaro
