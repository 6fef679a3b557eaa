#pragma once
/// Accessors of a glTF file as plain arrays. Every index, size, stride and value is checked here, and nowhere else.

#include <cstdint>
#include <string>
#include <vector>

#include "assets/scene/gltf_library.h"

namespace chiaro {

/// What an attribute may be made of, besides FLOAT (glTF 2.0, 3.7.2.1 and KHR_mesh_quantization).
enum class Integers { none, normalizedUnsigned, normalizedSigned, any };

class GltfAccessors {
 public:
  /// `where` names the file in errors.
  GltfAccessors(const tinygltf::Model& model, std::string where) : model_(model), where_(std::move(where)) {}

  /// #elements by `components`, row-major, all finite; normalized integers become [-1,1] or [0,1]. `what` says in errors
  /// which attribute of which primitive it is.
  std::vector<float> floats(int accessor, int components, Integers integers, const std::string& what) const;

  /// Scalars of an unsigned type.
  std::vector<std::uint32_t> indices(int accessor, const std::string& what) const;

  /// The bytes of a whole buffer view. Throws when it does not lie in its buffer.
  std::vector<std::uint8_t> bufferView(int view, const std::string& what) const;

 private:
  struct Elements {
    const std::uint8_t* data = nullptr;
    std::size_t stride = 0;
  };

  const tinygltf::Accessor& at(int accessor, const std::string& what) const;
  Elements elements(std::int64_t view, std::uint64_t byteOffset, std::uint64_t count, std::size_t elementSize, bool strided,
                    const std::string& what) const;
  template <class Value, class Decode>
  std::vector<Value> read(const tinygltf::Accessor& accessor, int components, Decode decode, const std::string& what) const;
  [[noreturn]] void fail(const std::string& what, const std::string& problem) const;

  const tinygltf::Model& model_;
  std::string where_;
};

}  // namespace chiaro
