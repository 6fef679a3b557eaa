#include "precompute/journal/fingerprint.h"

#include <xxhash.h>

#include <memory>
#include <span>
#include <type_traits>

namespace chiaro {
namespace {

class Hash {
 public:
  Hash() : state_(XXH3_createState()) { XXH3_128bits_reset(state_.get()); }

  template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) {
    XXH3_128bits_update(state_.get(), &value, sizeof value);
  }
  /// Of elements without padding.
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.size());
    if (!values.empty()) XXH3_128bits_update(state_.get(), values.data(), values.size() * sizeof(T));
  }
  void add(const std::string& text) {
    add(text.size());
    XXH3_128bits_update(state_.get(), text.data(), text.size());
  }

  Fingerprint result() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return {hash.low64, hash.high64};
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

/// Where an alpha mask has holes.
void addMask(const Scene& scene, const Material& material, Hash& hash) {
  hash.add(material.alphaCutoff);
  hash.add(material.baseColorFactor.a);
  if (material.baseColorTexture == kNone) return;
  const auto& transform = material.baseColorTransform;
  for (const float x : {transform.offset.x, transform.offset.y, transform.rotation, transform.scale.x, transform.scale.y}) hash.add(x);
  const auto& texture = scene.textures[static_cast<std::size_t>(material.baseColorTexture)];
  hash.add(texture.wrapS);
  hash.add(texture.wrapT);
  hash.add(texture.nearest);
  if (texture.image != kNone) hash.add(scene.images[static_cast<std::size_t>(texture.image)].bytes);
}

}  // namespace

Fingerprint fingerprintOf(const Scene& scene, const BakeSettings& settings, const std::string& program) {
  Hash hash;
  hash.add(program);
  hash.add(settings.compression);
  hash.add(settings.resolution);
  hash.add(settings.samplingResolution);
  hash.add(settings.leastOccluder);
  hash.add(settings.directionCount);
  hash.add(settings.directionSharpness);
  if (settings.compression != Compression::pca) {
    hash.add(settings.functions);
    hash.add(settings.bytesPerVertex);  // these two choose the number of functions
    hash.add(settings.targetError > 0.0);
    hash.add(settings.seed);
  }
  hash.add(scene.primitives.size());
  for (const auto& primitive : scene.primitives) {
    hash.add(primitive.positions);
    hash.add(primitive.normals);
    hash.add(primitive.indices);
    const auto& material = materialOf(scene, primitive);
    hash.add(material.doubleSided);
    hash.add(material.alphaMode);
    if (material.alphaMode != AlphaMode::mask) continue;
    hash.add(primitive.texcoords);
    addMask(scene, material, hash);
  }
  return hash.result();
}

}  // namespace chiaro
