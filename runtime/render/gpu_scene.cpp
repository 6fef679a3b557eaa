#include "runtime/render/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "assets/error.h"
#include "assets/image/image.h"
#include "runtime/render/frame_block.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr std::size_t kNoDraw = static_cast<std::size_t>(-1);

std::size_t at(int i) { return static_cast<std::size_t>(i); }

GLint wrapMode(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: return GL_REPEAT;
    case Wrap::mirroredRepeat: return GL_MIRRORED_REPEAT;
    case Wrap::clampToEdge: return GL_CLAMP_TO_EDGE;
  }
  return GL_REPEAT;
}

}  // namespace

GpuScene::GpuScene(const BakedScene& baked)
    : materials_(baked.scene.materials),
      bounds_(boundsOf(baked.scene)),
      transfer_(baked),
      directionSharpness_(baked.transfer.directionSharpness),
      directions_(baked.transfer.directions) {
  materials_.emplace_back();
  uploadGeometry(baked.scene);
  uploadTextures(baked.scene);
  materialBuffer_ = gl::Buffer(materials_.size() * sizeof(MaterialBlock));
  bytes_ += materialBuffer_.size();
  writeMaterials();
}

void GpuScene::uploadGeometry(const Scene& scene) {
  std::vector<VertexBlock> vertices;
  std::vector<std::uint32_t> indices;
  vertices.reserve(scene.vertexCount());
  indices.reserve(3 * scene.triangleCount());
  for (const auto& primitive : scene.primitives) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    GpuDraw draw;
    draw.firstIndex = static_cast<int>(indices.size());
    draw.indexCount = static_cast<int>(primitive.indices.size());
    draw.mesh = primitive.mesh;
    draw.firstVertex = vertices.size();
    draw.vertexCount = primitive.positions.size();
    meshCount_ = std::max(meshCount_, at(primitive.mesh) + 1);
    draw.material = primitive.material == kNone ? static_cast<int>(materials_.size()) - 1 : primitive.material;
    Bounds bounds;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      const glm::vec2 uv = primitive.texcoords.empty() ? glm::vec2(0) : primitive.texcoords[v];
      vertices.push_back({glm::vec4(primitive.positions[v], uv.x), glm::vec4(primitive.normals[v], uv.y),
                          primitive.tangents.empty() ? glm::vec4(0) : primitive.tangents[v]});
      bounds.include(primitive.positions[v]);
    }
    for (const auto index : primitive.indices) indices.push_back(base + index);
    draw.center = bounds.empty() ? glm::vec3(0) : bounds.center();
    primitiveDraws_.push_back(draw.indexCount > 0 ? draws_.size() : kNoDraw);
    if (draw.indexCount > 0) draws_.push_back(draw);
  }
  if (indices.empty()) throw inputError("scene", "has no triangle", "choose another file");
  requireStorage(vertices.size() * sizeof(VertexBlock), "vertices");
  vertices_ = gl::Buffer(vertices);
  indices_ = gl::Buffer(indices);
  bytes_ += vertices_.size() + indices_.size();
}

void GpuScene::uploadTextures(const Scene& scene) {
  const std::uint8_t one[4] = {255, 255, 255, 255};
  white_ = gl::Texture::make2d(GL_RGBA8, 1, 1);
  white_.upload(0, GL_RGBA, GL_UNSIGNED_BYTE, one);
  std::map<std::pair<int, bool>, int> made;  // (texture, sRGB) -> index
  const auto make = [&](int texture, bool srgb) {
    if (texture == kNone) return kNone;
    const auto [found, isNew] = made.try_emplace({texture, srgb}, static_cast<int>(textures_.size()));
    if (!isNew) return found->second;
    const Texture& description = scene.textures[at(texture)];
    const EncodedImage& encoded = scene.images[at(description.image)];
    const Image8 image = decodeImage8(encoded.bytes, encoded.name.empty() ? "image " + std::to_string(description.image) : encoded.name);
    auto gpu = gl::Texture::make2d(srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width, image.height, 0);
    gpu.upload(0, GL_RGBA, GL_UNSIGNED_BYTE, image.texels.data());
    gpu.generateMipmaps();
    gpu.filter(GL_LINEAR_MIPMAP_LINEAR, description.nearest ? GL_NEAREST : GL_LINEAR);
    glTextureParameteri(gpu.id(), GL_TEXTURE_WRAP_S, wrapMode(description.wrapS));
    glTextureParameteri(gpu.id(), GL_TEXTURE_WRAP_T, wrapMode(description.wrapT));
    bytes_ += image.texels.size() * 4 / 3;
    textures_.push_back(std::move(gpu));
    return found->second;
  };
  for (const auto& material : materials_) {
    materialTextures_.push_back({make(material.baseColorTexture, true), make(material.metallicRoughnessTexture, false),
                                 make(material.normalTexture, false), make(material.emissiveTexture, true),
                                 make(material.anisotropyTexture, false), make(material.specularTexture, false),
                                 make(material.specularColorTexture, true), make(material.clearcoatTexture, false),
                                 make(material.clearcoatRoughnessTexture, false), make(material.sheenColorTexture, true),
                                 make(material.sheenRoughnessTexture, false)});
  }
}

void GpuScene::setShape(std::size_t primitive, std::span<const glm::vec3> positions, std::span<const glm::vec3> normals) {
  if (primitive >= primitiveDraws_.size()) throw Error(ExitCode::failed, "setShapes", "there is no primitive " + std::to_string(primitive), "pass those of the scene");
  if (primitiveDraws_[primitive] == kNoDraw) return;
  GpuDraw& draw = draws_[primitiveDraws_[primitive]];
  if (positions.size() != draw.vertexCount || normals.size() != draw.vertexCount)
    throw Error(ExitCode::failed, "setShapes", std::to_string(positions.size()) + " positions and " + std::to_string(normals.size()) + " normals for " + std::to_string(draw.vertexCount) + " vertices",
                "pass one per vertex");
  if (!before_) {
    std::vector<glm::vec4> rest;
    for (const auto& vertex : vertices_.read<VertexBlock>()) rest.push_back(vertex.positionU);
    before_ = gl::Buffer(rest);
    bytes_ += before_.size();
  }
  Shape& shape = shapes_[primitive];
  const std::size_t offset = draw.firstVertex * sizeof(VertexBlock);
  if (shape.vertices.empty()) {
    shape.vertices.resize(draw.vertexCount);
    vertices_.readBytes(offset, shape.vertices.data(), draw.vertexCount * sizeof(VertexBlock));
  }
  Bounds bounds;
  for (std::size_t v = 0; v < draw.vertexCount; ++v) {
    shape.vertices[v].positionU = glm::vec4(positions[v], shape.vertices[v].positionU.w);
    shape.vertices[v].normalV = glm::vec4(normals[v], shape.vertices[v].normalV.w);
    bounds.include(positions[v]);
  }
  draw.center = bounds.center();
  shape.moved = true;
  vertices_.write(offset, std::span<const VertexBlock>(shape.vertices));
}

void GpuScene::keepShapes() {
  for (auto& [primitive, shape] : shapes_) {
    if (!shape.moved) continue;
    std::vector<glm::vec4> positions;
    for (const auto& vertex : shape.vertices) positions.push_back(vertex.positionU);
    before_.write(draws_[primitiveDraws_[primitive]].firstVertex * sizeof(glm::vec4), std::span<const glm::vec4>(positions));
    shape.moved = false;
  }
}

void GpuScene::setMaterials(const std::vector<Material>& materials) {
  if (materials.size() + 1 != materials_.size())
    throw Error(ExitCode::failed, "setMaterials", std::to_string(materials.size()) + " materials for a scene with " + std::to_string(materials_.size() - 1), "pass one per scene material");
  std::copy(materials.begin(), materials.end(), materials_.begin());
  writeMaterials();
}

void GpuScene::writeMaterials() {
  std::vector<MaterialBlock> blocks;
  blocks.reserve(materials_.size());
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    const Material& m = materials_[i];
    MaterialBlock block;
    block.baseColor = m.baseColorFactor;
    block.emissive = glm::vec4(m.emissiveFactor, m.alphaCutoff);
    block.surface = glm::vec4(m.metallicFactor, m.roughnessFactor, m.normalScale, m.anisotropyStrength);
    const glm::vec2 alpha = m.reflectanceWidth ? reflectanceAlpha(m) : glm::vec2(0.0f);
    block.anisotropy = glm::vec4(std::cos(m.anisotropyRotation), std::sin(m.anisotropyRotation), alpha);
    // An override of the parameters drops the texture by setting its index to none.
    const std::array<int, kMaterialTextures> wanted{m.baseColorTexture,     m.metallicRoughnessTexture, m.normalTexture,
                                                    m.emissiveTexture,      m.anisotropyTexture,        m.specularTexture,
                                                    m.specularColorTexture, m.clearcoatTexture,         m.clearcoatRoughnessTexture,
                                                    m.sheenColorTexture,    m.sheenRoughnessTexture};
    int present = 0;
    for (int t = 0; t < kMaterialTextures; ++t)
      if (wanted[at(t)] != kNone && materialTextures_[i][at(t)] != kNone) present |= 1 << t;
    block.textures = glm::ivec4(present, static_cast<int>(m.alphaMode), m.doubleSided ? 1 : 0, lobeKindOf(m.reflectance));
    block.specular = glm::vec4(dielectricF0(m.ior) * m.specularColorFactor, m.specularFactor);
    block.fixedF0 = m.reflectanceF0 ? glm::vec4(*m.reflectanceF0, 1.0f) : glm::vec4(0.0f);
    block.coat = glm::vec4(m.clearcoatFactor, m.clearcoatRoughness, 0, 0);
    block.sheen = glm::vec4(m.sheenColorFactor, m.sheenRoughness);
    const std::array<const TextureTransform*, kMaterialTextures> transforms{
        &m.baseColorTransform,  &m.metallicRoughnessTransform, &m.normalTransform,    &m.emissiveTransform,          &m.anisotropyTransform,
        &m.specularTransform,   &m.specularColorTransform,     &m.clearcoatTransform, &m.clearcoatRoughnessTransform,
        &m.sheenColorTransform, &m.sheenRoughnessTransform};
    for (std::size_t t = 0; t < transforms.size(); ++t) {
      const glm::mat2 linear = transforms[t]->linear();
      block.textureLinear[t] = glm::vec4(linear[0], linear[1]);
      block.textureOffset[t] = glm::vec4(transforms[t]->offset, 0, 0);
    }
    blocks.push_back(block);
  }
  features_ = merged(features_, featuresOf(materials_));
  materialBuffer_.write(0, std::span<const MaterialBlock>(blocks));
}

void GpuScene::bindBuffers() const {
  vertices_.bindBase(GL_SHADER_STORAGE_BUFFER, 0);
  indices_.bindBase(GL_SHADER_STORAGE_BUFFER, 1);
  materialBuffer_.bindBase(GL_SHADER_STORAGE_BUFFER, 2);
  if (before_) before_.bindBase(GL_SHADER_STORAGE_BUFFER, 10);
  transfer_.bind();
}

void GpuScene::bindTextures(int material) const {
  for (int t = 0; t < (features_.layerTextures ? kMaterialTextures : kCommonTextures); ++t) {
    const int texture = materialTextures_[at(material)][at(t)];
    const int unit = t < kCommonTextures ? t : t - kCommonTextures + 17;
    (texture == kNone ? white_ : textures_[at(texture)]).bind(static_cast<GLuint>(unit));
  }
}

}  // namespace chiaro
