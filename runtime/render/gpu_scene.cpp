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

std::size_t at(int i) { return static_cast<std::size_t>(i); }

GLint wrapMode(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: return GL_REPEAT;
    case Wrap::mirroredRepeat: return GL_MIRRORED_REPEAT;
    case Wrap::clampToEdge: return GL_CLAMP_TO_EDGE;
  }
  return GL_REPEAT;
}

/// `values`, resolution^2, with one texel of border that continues across the octahedral seams.
template <class T, class Read>
std::vector<T> withBorder(int resolution, const Read& read) {
  const int side = resolution + 2;
  std::vector<T> bordered(at(side) * at(side));
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const glm::ivec2 texel = lobe32::octahedralWrapTexel(glm::ivec2(x - 1, y - 1), resolution);
      bordered[at(y) * at(side) + at(x)] = read(at(texel.y) * at(resolution) + at(texel.x));
    }
  }
  return bordered;
}

void requireStorage(std::size_t bytes, const char* what) {
  GLint64 limit = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  if (bytes > static_cast<std::size_t>(limit))
    throw Error(ExitCode::failed, "OpenGL", std::string("the ") + what + " need " + std::to_string(bytes >> 20) + " MiB in one buffer, the driver allows " +
                                                std::to_string(limit >> 20), "bake with fewer terms or split the scene");
}

}  // namespace

GpuScene::GpuScene(const BakedScene& baked) : materials_(baked.scene.materials), bounds_(boundsOf(baked.scene)) {
  materials_.emplace_back();
  uploadGeometry(baked.scene);
  uploadTransfer(baked);
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
    draw.material = primitive.material == kNone ? static_cast<int>(materials_.size()) - 1 : primitive.material;
    Bounds bounds;
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      const glm::vec2 uv = primitive.texcoords.empty() ? glm::vec2(0) : primitive.texcoords[v];
      vertices.push_back({glm::vec4(primitive.positions[v], uv.x), glm::vec4(primitive.normals[v], uv.y),
                          primitive.tangents.empty() ? glm::vec4(0) : primitive.tangents[v]});
      bounds.lower = glm::min(bounds.lower, primitive.positions[v]);
      bounds.upper = glm::max(bounds.upper, primitive.positions[v]);
    }
    for (const auto index : primitive.indices) indices.push_back(base + index);
    draw.center = bounds.empty() ? glm::vec3(0) : bounds.center();
    if (draw.indexCount > 0) draws_.push_back(draw);
  }
  if (indices.empty()) throw inputError("scene", "has no triangle", "choose another file");
  requireStorage(vertices.size() * sizeof(VertexBlock), "vertices");
  vertices_ = gl::Buffer(vertices);
  indices_ = gl::Buffer(indices);
  bytes_ += vertices_.size() + indices_.size();
}

void GpuScene::uploadTransfer(const BakedScene& baked) {
  const Transfer& transfer = baked.transfer;
  resolution_ = transfer.resolution;
  termVectors_ = transfer.paddedTerms() / 4;
  directionVectors_ = transfer.directionCount / 4;
  directionSharpness_ = transfer.directionSharpness;
  directions_ = transfer.directions;
  if (transfer.directionCount < 4 || transfer.directionCount > kMaxDirections)
    throw inputError("scene", std::to_string(transfer.directionCount) + " fixed directions, the renderer takes 4 to 64", "bake it again");

  std::vector<std::uint8_t> visibility;
  std::vector<std::int16_t> weights;
  for (const auto& primitive : transfer.primitives) {
    visibility.insert(visibility.end(), primitive.visibility.begin(), primitive.visibility.end());
    weights.insert(weights.end(), primitive.weights.begin(), primitive.weights.end());
  }
  requireStorage(visibility.size(), "visible fractions");
  visibility_ = gl::Buffer(visibility);
  bytes_ += visibility_.size();
  if (termVectors_ == 0) return;

  requireStorage(weights.size() * sizeof(std::int16_t), "PCA weights");
  weights_ = gl::Buffer(weights);
  const int side = resolution_ + 2;
  const std::size_t texels = at(resolution_) * at(resolution_);
  mean_ = withBorder<float>(resolution_, [&](std::size_t texel) { return transfer.mean[texel]; });
  for (int layer = 0; layer < termVectors_; ++layer) {
    const auto bordered = withBorder<glm::vec4>(resolution_, [&](std::size_t texel) {
      glm::vec4 value(0.0f);
      for (int i = 0; i < 4; ++i) {
        const int term = 4 * layer + i;
        if (term < transfer.terms) value[i] = transfer.eigenfunctions[at(term) * texels + texel] * transfer.weightScale[at(term)];
      }
      return value;
    });
    eigen_.insert(eigen_.end(), bordered.begin(), bordered.end());
  }
  meanTexture_ = gl::Texture::make2d(GL_R32F, side, side);
  meanTexture_.upload(0, GL_RED, GL_FLOAT, mean_.data());
  // Half floats: the eigenfunctions are stored as such, and the scale only moves the exponent range.
  eigenTexture_ = gl::Texture::make2dArray(GL_RGBA16F, side, side, termVectors_);
  eigenTexture_.upload(0, GL_RGBA, GL_FLOAT, eigen_.data());
  bytes_ += weights_.size() + at(side) * at(side) * (4 + 8 * at(termVectors_));
}

std::vector<float> GpuScene::eigenAt(glm::vec3 direction) const {
  std::vector<float> values(1 + 4 * at(termVectors_), 0.0f);
  if (termVectors_ == 0) return values;
  const int side = resolution_ + 2;
  const glm::vec2 p = lobe32::octahedralEncode(direction) * static_cast<float>(resolution_) + 0.5f;
  const glm::ivec2 cell = glm::clamp(glm::ivec2(glm::floor(p)), glm::ivec2(0), glm::ivec2(side - 2));
  const glm::vec2 f = p - glm::vec2(cell);
  const std::array<float, 4> share{(1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y};
  for (int corner = 0; corner < 4; ++corner) {
    const std::size_t texel = at(cell.y + corner / 2) * at(side) + at(cell.x + corner % 2);
    values[0] += share[at(corner)] * mean_[texel];
    for (int layer = 0; layer < termVectors_; ++layer) {
      const glm::vec4 value = eigen_[at(layer) * at(side) * at(side) + texel];
      for (int i = 0; i < 4; ++i) values[at(1 + 4 * layer + i)] += share[at(corner)] * value[i];
    }
  }
  return values;
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
                                 make(material.anisotropyTexture, false)});
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
    block.anisotropy = glm::vec4(std::cos(m.anisotropyRotation), std::sin(m.anisotropyRotation), 0, 0);
    int present = 0;
    for (int t = 0; t < 5; ++t)
      if (materialTextures_[i][at(t)] != kNone) present |= 1 << t;
    // An override of the parameters drops the texture by setting its index to none.
    if (m.baseColorTexture == kNone) present &= ~1;
    if (m.metallicRoughnessTexture == kNone) present &= ~2;
    if (m.normalTexture == kNone) present &= ~4;
    if (m.emissiveTexture == kNone) present &= ~8;
    if (m.anisotropyTexture == kNone) present &= ~16;
    block.textures = glm::ivec4(present, static_cast<int>(m.alphaMode), m.doubleSided ? 1 : 0, 0);
    const std::array<const TextureTransform*, 5> transforms{&m.baseColorTransform, &m.metallicRoughnessTransform, &m.normalTransform,
                                                            &m.emissiveTransform, &m.anisotropyTransform};
    for (std::size_t t = 0; t < transforms.size(); ++t) {
      const glm::mat2 linear = transforms[t]->linear();
      block.textureLinear[t] = glm::vec4(linear[0], linear[1]);
      block.textureOffset[t] = glm::vec4(transforms[t]->offset, 0, 0);
    }
    blocks.push_back(block);
  }
  materialBuffer_.write(0, std::span<const MaterialBlock>(blocks));
}

void GpuScene::bindBuffers() const {
  vertices_.bindBase(GL_SHADER_STORAGE_BUFFER, 0);
  indices_.bindBase(GL_SHADER_STORAGE_BUFFER, 1);
  materialBuffer_.bindBase(GL_SHADER_STORAGE_BUFFER, 2);
  if (weights_) weights_.bindBase(GL_SHADER_STORAGE_BUFFER, 3);
  visibility_.bindBase(GL_SHADER_STORAGE_BUFFER, 4);
}

void GpuScene::bindTextures(int material) const {
  for (int unit = 0; unit < 5; ++unit) {
    const int texture = materialTextures_[at(material)][at(unit)];
    (texture == kNone ? white_ : textures_[at(texture)]).bind(static_cast<GLuint>(unit));
  }
}

void GpuScene::bindTransferTextures() const {
  if (termVectors_ == 0) return;
  eigenTexture_.bind(7);
  meanTexture_.bind(8);
}

}  // namespace chiaro
