#include "assets/scene/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "assets/error.h"

namespace chiaro {
namespace {

/// An accessor without a buffer view is all zeros, so its size is bounded by nothing but this.
constexpr std::uint64_t kMostElementsWithoutData = 1u << 24;

template <class T>
T load(const std::uint8_t* data) {
  T value;
  std::memcpy(&value, data, sizeof value);
  return value;
}

float decodeFloat(int componentType, bool normalized, const std::uint8_t* data) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = load<std::int8_t>(data);
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float value = load<std::uint8_t>(data);
      return normalized ? value / 255.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = load<std::int16_t>(data);
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float value = load<std::uint16_t>(data);
      return normalized ? value / 65535.0f : value;
    }
    default:
      return load<float>(data);
  }
}

std::uint32_t decodeIndex(int componentType, const std::uint8_t* data) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(data);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(data);
    default:
      return load<std::uint32_t>(data);
  }
}

std::size_t componentSize(int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

bool isIndexType(int componentType) {
  return componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

bool isAllowed(int componentType, bool normalized, Integers integers) {
  if (componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) return true;
  const bool isUnsigned =
      componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  const bool isSigned = componentType == TINYGLTF_COMPONENT_TYPE_BYTE || componentType == TINYGLTF_COMPONENT_TYPE_SHORT;
  switch (integers) {
    case Integers::none:
      return false;
    case Integers::normalizedUnsigned:
      return isUnsigned && normalized;
    case Integers::normalizedSigned:
      return isSigned && normalized;
    case Integers::any:
      return isUnsigned || isSigned;
  }
  return false;
}

int componentsOf(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

void GltfAccessors::fail(const std::string& what, const std::string& problem) const {
  throw inputError(where_, what + " " + problem, "export the file again");
}

const tinygltf::Accessor& GltfAccessors::at(int accessor, const std::string& what) const {
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= model_.accessors.size())
    fail(what, "names accessor " + std::to_string(accessor) + ", which does not exist");
  return model_.accessors[static_cast<std::size_t>(accessor)];
}

GltfAccessors::Elements GltfAccessors::elements(std::int64_t view, std::uint64_t byteOffset, std::uint64_t count,
                                                std::size_t elementSize, bool strided, const std::string& what) const {
  if (view < 0 || static_cast<std::uint64_t>(view) >= model_.bufferViews.size())
    fail(what, "names buffer view " + std::to_string(view) + ", which does not exist");
  const auto& bufferView = model_.bufferViews[static_cast<std::size_t>(view)];
  if (bufferView.buffer < 0 || static_cast<std::size_t>(bufferView.buffer) >= model_.buffers.size())
    fail(what, "is in buffer " + std::to_string(bufferView.buffer) + ", which does not exist");
  const auto& buffer = model_.buffers[static_cast<std::size_t>(bufferView.buffer)].data;
  // Each comparison is arranged so that nothing in it can overflow.
  if (bufferView.byteLength > buffer.size() || bufferView.byteOffset > buffer.size() - bufferView.byteLength)
    fail(what, "is in buffer view " + std::to_string(view) + ", which reaches beyond its buffer");
  const std::size_t stride = strided && bufferView.byteStride != 0 ? bufferView.byteStride : elementSize;
  if (stride < elementSize || stride > 255) fail(what, "has a byte stride of " + std::to_string(stride));
  if (count > 0 && (byteOffset > bufferView.byteLength || bufferView.byteLength - byteOffset < elementSize ||
                    (bufferView.byteLength - byteOffset - elementSize) / stride < count - 1))
    fail(what, "reaches beyond the end of buffer view " + std::to_string(view));
  return {buffer.data() + bufferView.byteOffset + byteOffset, stride};
}

template <class Value, class Decode>
std::vector<Value> GltfAccessors::read(const tinygltf::Accessor& accessor, int components, Decode decode,
                                       const std::string& what) const {
  const std::size_t width = componentSize(accessor.componentType);
  const std::size_t perElement = static_cast<std::size_t>(components);
  const std::size_t elementSize = width * perElement;
  if (accessor.count == 0) fail(what, "is empty");
  std::vector<Value> values;
  const auto copyElement = [&](const std::uint8_t* source, std::size_t target) {
    for (std::size_t c = 0; c < perElement; ++c) values[target * perElement + c] = decode(accessor, source + c * width);
  };

  if (accessor.bufferView >= 0) {
    const Elements source = elements(accessor.bufferView, accessor.byteOffset, accessor.count, elementSize, true, what);
    values.resize(accessor.count * perElement);
    for (std::size_t i = 0; i < accessor.count; ++i) copyElement(source.data + i * source.stride, i);
  } else {
    if (accessor.count > kMostElementsWithoutData) fail(what, "has " + std::to_string(accessor.count) + " elements and no data");
    values.resize(accessor.count * perElement);
  }

  if (accessor.sparse.isSparse) {
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::int64_t>(sparse.count);
    const auto indexOffset = static_cast<std::int64_t>(sparse.indices.byteOffset);
    const auto valueOffset = static_cast<std::int64_t>(sparse.values.byteOffset);
    if (count < 0 || static_cast<std::uint64_t>(count) > accessor.count || indexOffset < 0 || valueOffset < 0 ||
        !isIndexType(sparse.indices.componentType))
      fail(what, "has a malformed sparse part");
    const std::size_t n = static_cast<std::size_t>(count);
    const Elements where = elements(sparse.indices.bufferView, static_cast<std::uint64_t>(indexOffset), n,
                                    componentSize(sparse.indices.componentType), false, what);
    const Elements source =
        elements(sparse.values.bufferView, static_cast<std::uint64_t>(valueOffset), n, elementSize, false, what);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t target = decodeIndex(sparse.indices.componentType, where.data + i * where.stride);
      if (target >= accessor.count) fail(what, "has a sparse index out of range");
      copyElement(source.data + i * source.stride, target);
    }
  }
  return values;
}

std::vector<float> GltfAccessors::floats(int index, int components, Integers integers, const std::string& what) const {
  const auto& accessor = at(index, what);
  if (componentsOf(accessor.type) != components) fail(what, "has the wrong number of components");
  if (!isAllowed(accessor.componentType, accessor.normalized, integers))
    fail(what, "has component type " + std::to_string(accessor.componentType) + ", which is not allowed for it");
  auto values = read<float>(
      accessor, components,
      [](const tinygltf::Accessor& a, const std::uint8_t* data) { return decodeFloat(a.componentType, a.normalized, data); },
      what);
  const auto bad = std::find_if_not(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
  if (bad != values.end()) fail(what, "is not finite at element " + std::to_string((bad - values.begin()) / components));
  return values;
}

std::vector<std::uint32_t> GltfAccessors::indices(int index, const std::string& what) const {
  const auto& accessor = at(index, what);
  if (componentsOf(accessor.type) != 1 || !isIndexType(accessor.componentType)) fail(what, "is not an unsigned integer scalar");
  return read<std::uint32_t>(
      accessor, 1, [](const tinygltf::Accessor& a, const std::uint8_t* data) { return decodeIndex(a.componentType, data); },
      what);
}

std::vector<std::uint8_t> GltfAccessors::bufferView(int view, const std::string& what) const {
  const Elements source = elements(view, 0, 0, 1, false, what);
  return {source.data, source.data + model_.bufferViews[static_cast<std::size_t>(view)].byteLength};
}

}  // namespace chiaro
