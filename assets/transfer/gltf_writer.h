#pragma once
/// A Scene as glTF JSON plus the binary chunk it points into.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "assets/scene/scene.h"

namespace chiaro {

using Json = nlohmann::ordered_json;

/// The JSON and the bytes grow together. Every buffer view starts on a multiple of 4 and holds one thing.
class GltfWriter {
 public:
  enum class Target { none = 0, vertices = 34962, indices = 34963 };

  Json json = Json::object();

  /// Returns the buffer view's index. `name` tells a person what is in it.
  int addBufferView(std::span<const std::uint8_t> bytes, const std::string& name, Target target = Target::none);
  template <class T>
  int addArray(const std::vector<T>& values, const std::string& name, Target target = Target::none) {
    return addBufferView({reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)}, name, target);
  }
  int addAccessor(int bufferView, int componentType, const char* type, std::size_t count, bool normalized = false);

  const std::vector<std::uint8_t>& binary() const { return binary_; }
  /// XXH64 of each buffer view.
  const std::vector<std::string>& checksums() const { return checksums_; }

  /// The container: header, JSON chunk (padded with spaces), BIN chunk. `bytes` larger than a .glb can be are the caller's to refuse.
  static std::vector<std::uint8_t> container(const std::string& json, const std::vector<std::uint8_t>& binary);

 private:
  std::vector<std::uint8_t> binary_;
  std::vector<std::string> checksums_;
};

/// Primitives in the order they are written: by mesh, else as they stand.
std::vector<std::size_t> primitiveOrder(const Scene& scene);

/// Writes everything of `scene`: one node and mesh for each Scene mesh that has primitives, identity transforms. Returns for each
/// entry of primitiveOrder() where its JSON object is ("/meshes/0/primitives/1").
std::vector<Json::json_pointer> writeScene(const Scene& scene, const std::vector<std::size_t>& order, GltfWriter& writer);

}  // namespace chiaro
