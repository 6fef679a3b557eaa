#include "assets/scene/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/image/image.h"

namespace chiaro {
namespace {

std::string named(const std::string& kind, std::size_t index, const std::string& name) {
  return kind + " " + std::to_string(index) + (name.empty() ? "" : " (" + name + ")");
}

/// %20 and the like (RFC 3986, 2.1).
std::string percentDecoded(const std::string& uri) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
      out += static_cast<char>(16 * hex(uri[i + 1]) + hex(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

std::string mimeTypeOf(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= 4 && bytes[0] == 0x89 && bytes[1] == 'P' && bytes[2] == 'N' && bytes[3] == 'G') return "image/png";
  if (bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF) return "image/jpeg";
  return {};
}

class MaterialReader {
 public:
  MaterialReader(const tinygltf::Model& model, const std::filesystem::path& path, Warnings& warnings, Scene& scene)
      : model_(model), path_(path), warnings_(warnings), scene_(scene) {}

  void readImages(const GltfAccessors& accessors, ImageBytes& fetched) {
    fetched.resize(model_.images.size());
    for (std::size_t i = 0; i < model_.images.size(); ++i) {
      const auto& image = model_.images[i];
      const std::string label = named("image", i, image.name.empty() ? image.uri : image.name);
      EncodedImage out;
      out.name = image.name;
      if (image.bufferView >= 0) {
        out.bytes = accessors.bufferView(image.bufferView, label);
      } else if (!fetched[i].empty()) {
        out.bytes = std::move(fetched[i]);
      } else {
        out.bytes = readExternal(label, image.uri);
      }
      out.mimeType = mimeTypeOf(out.bytes);
      if (out.mimeType.empty()) throw inputError(path_.string(), label + " is neither PNG nor JPEG", "convert it to one of them");
      decodedSize(out.bytes, path_.string() + ": " + label);
      scene_.images.push_back(std::move(out));
    }
  }

  void readTextures() {
    for (std::size_t i = 0; i < model_.textures.size(); ++i) {
      const auto& source = model_.textures[i];
      const std::string label = named("texture", i, source.name);
      Texture texture;
      texture.image = checked(source.source, model_.images.size(), label + " names image ");
      if (texture.image == kNone) warnings_.say(label + " has no PNG or JPEG image and is left out");
      const int sampler = checked(source.sampler, model_.samplers.size(), label + " names sampler ");
      if (sampler != kNone) {
        const auto& s = model_.samplers[static_cast<std::size_t>(sampler)];
        texture.wrapS = wrap(s.wrapS, label);
        texture.wrapT = wrap(s.wrapT, label);
        texture.nearest = s.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
      }
      scene_.textures.push_back(texture);
    }
  }

  void readMaterials() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      const auto& source = model_.materials[i];
      const auto& pbr = source.pbrMetallicRoughness;
      label_ = named("material", i, source.name);
      Material material;
      material.name = source.name;
      for (std::size_t c = 0; c < 4 && pbr.baseColorFactor.size() == 4; ++c)
        material.baseColorFactor[static_cast<int>(c)] = within(pbr.baseColorFactor[c], 0, 1, "baseColorFactor");
      material.baseColorTexture = texture(pbr.baseColorTexture, material.baseColorTransform);
      material.metallicFactor = within(pbr.metallicFactor, 0, 1, "metallicFactor");
      material.roughnessFactor = within(pbr.roughnessFactor, 0, 1, "roughnessFactor");
      material.metallicRoughnessTexture = texture(pbr.metallicRoughnessTexture, material.metallicRoughnessTransform);
      material.normalTexture = texture(source.normalTexture, material.normalTransform);
      material.normalScale = static_cast<float>(source.normalTexture.scale);
      material.occlusionTexture = texture(source.occlusionTexture, material.occlusionTransform);
      material.occlusionStrength = within(source.occlusionTexture.strength, 0, 1, "occlusionTexture.strength");
      readEmission(source, material);
      material.emissiveTexture = texture(source.emissiveTexture, material.emissiveTransform);
      material.alphaMode = source.alphaMode == "MASK"    ? AlphaMode::mask
                           : source.alphaMode == "BLEND" ? AlphaMode::blend
                                                         : AlphaMode::opaque;
      material.alphaCutoff = static_cast<float>(source.alphaCutoff);
      material.doubleSided = source.doubleSided;
      readAnisotropy(source, material);
      readSpecular(source, material);
      readClearcoat(source, material);
      readSheen(source, material);
      readReflectance(source, material);
      scene_.materials.push_back(std::move(material));
    }
  }

 private:
  std::vector<std::uint8_t> readExternal(const std::string& label, const std::string& uri) const {
    if (uri.empty()) throw inputError(path_.string(), label + " has neither a file nor a buffer view", "export the file again");
    const auto file = path_.parent_path() / percentDecoded(uri);
    try {
      auto bytes = readFile(file);
      if (bytes.empty()) throw inputError(file.string(), "is empty", "");
      return bytes;
    } catch (const Error& error) {
      throw inputError(path_.string(), label + " cannot be read (" + error.what() + ")",
                       "put the image where the glTF file expects it");
    }
  }

  int checked(int index, std::size_t count, const std::string& what) const {
    if (index == -1) return kNone;
    if (index < 0 || static_cast<std::size_t>(index) >= count)
      throw inputError(path_.string(), what + std::to_string(index) + ", which does not exist", "export the file again");
    return index;
  }

  Wrap wrap(int mode, const std::string& label) const {
    switch (mode) {
      case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return Wrap::repeat;
      case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Wrap::mirroredRepeat;
      case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Wrap::clampToEdge;
      default:
        throw inputError(path_.string(), label + " has an unknown wrap mode " + std::to_string(mode), "export the file again");
    }
  }

  template <class TextureInfo>
  int texture(const TextureInfo& info, TextureTransform& transform) {
    const int index = checked(info.index, scene_.textures.size(), label_ + " names texture ");
    if (index == kNone || scene_.textures[static_cast<std::size_t>(index)].image == kNone) return kNone;
    const auto moved = info.extensions.find("KHR_texture_transform");
    const bool isMoved = moved != info.extensions.end();
    const int set = isMoved ? static_cast<int>(gltfNumber(moved->second, "texCoord", info.texCoord)) : info.texCoord;
    if (set != 0) {
      warnings_.say(label_ + " reads a texture through TEXCOORD_" + std::to_string(set) +
                    "; only TEXCOORD_0 is kept, so it is left out");
      return kNone;
    }
    if (isMoved) transform = transformFrom(moved->second);
    return index;
  }

  TextureTransform transformFrom(const tinygltf::Value& value) const {
    TextureTransform transform;
    const auto pair = [&](const char* key, glm::vec2& out) {
      if (!value.IsObject() || !value.Has(key) || value.Get(key).ArrayLen() != 2) return;
      for (int c = 0; c < 2; ++c) out[c] = static_cast<float>(value.Get(key).Get(c).GetNumberAsDouble());
    };
    pair("offset", transform.offset);
    pair("scale", transform.scale);
    transform.rotation = static_cast<float>(gltfNumber(value, "rotation", 0.0));
    const glm::vec4 all(transform.offset, transform.scale);
    if (!std::isfinite(all.x + all.y + all.z + all.w + transform.rotation))
      throw inputError(path_.string(), label_ + " moves a texture by what a float cannot hold", "export the file again");
    return transform;
  }

  float within(double value, double lower, double upper, const char* what) {
    const double clamped = std::clamp(value, lower, upper);
    if (clamped != value)
      warnings_.say(label_ + " has " + what + " " + std::to_string(value) + ", taken as " + std::to_string(clamped));
    return static_cast<float>(clamped);
  }

  void readEmission(const tinygltf::Material& source, Material& material) {
    double strength = 1.0;
    if (const auto found = source.extensions.find("KHR_materials_emissive_strength"); found != source.extensions.end())
      strength = std::max(0.0, gltfNumber(found->second, "emissiveStrength", 1.0));
    for (std::size_t c = 0; c < 3 && source.emissiveFactor.size() == 3; ++c)
      material.emissiveFactor[static_cast<int>(c)] =
          within(source.emissiveFactor[c], 0, 1, "emissiveFactor") * static_cast<float>(strength);
    if (!std::isfinite(material.emissiveFactor.x + material.emissiveFactor.y + material.emissiveFactor.z))
      throw inputError(path_.string(), label_ + " emits more light than a float can hold", "lower its emissiveStrength");
  }

  void readAnisotropy(const tinygltf::Material& source, Material& material) {
    const auto found = source.extensions.find("KHR_materials_anisotropy");
    if (found == source.extensions.end() || !found->second.IsObject()) return;
    const auto& value = found->second;
    material.anisotropyStrength = within(gltfNumber(value, "anisotropyStrength", 0.0), 0, 1, "anisotropyStrength");
    material.anisotropyRotation = static_cast<float>(gltfNumber(value, "anisotropyRotation", 0.0));
    material.anisotropyTexture = textureOf(value, "anisotropyTexture", material.anisotropyTransform);
  }

  void readSpecular(const tinygltf::Material& source, Material& material) {
    if (const auto* value = extension(source, "KHR_materials_ior")) {
      const double ior = gltfNumber(*value, "ior", 1.5);
      material.ior = ior == 0.0 ? 0.0f : within(ior, 1.0, 1e6, "ior");
    }
    const auto* value = extension(source, "KHR_materials_specular");
    if (value == nullptr) return;
    material.specularFactor = within(gltfNumber(*value, "specularFactor", 1.0), 0, 1, "specularFactor");
    material.specularTexture = textureOf(*value, "specularTexture", material.specularTransform);
    if (const auto color = numbers<3>(*value, "specularColorFactor"))
      for (int c = 0; c < 3; ++c) material.specularColorFactor[c] = within((*color)[static_cast<std::size_t>(c)], 0, 1e6, "specularColorFactor");
    material.specularColorTexture = textureOf(*value, "specularColorTexture", material.specularColorTransform);
  }

  void readClearcoat(const tinygltf::Material& source, Material& material) {
    const auto* value = extension(source, "KHR_materials_clearcoat");
    if (value == nullptr) return;
    material.clearcoatFactor = within(gltfNumber(*value, "clearcoatFactor", 0.0), 0, 1, "clearcoatFactor");
    if (material.clearcoatFactor == 0.0f) return;
    material.clearcoatTexture = textureOf(*value, "clearcoatTexture", material.clearcoatTransform);
    material.clearcoatRoughness = within(gltfNumber(*value, "clearcoatRoughnessFactor", 0.0), 0, 1, "clearcoatRoughnessFactor");
    material.clearcoatRoughnessTexture = textureOf(*value, "clearcoatRoughnessTexture", material.clearcoatRoughnessTransform);
    if (value->Has("clearcoatNormalTexture"))
      warnings_.say(label_ + " has a clearcoatNormalTexture, which is left out: its coat follows the mesh");
  }

  void readSheen(const tinygltf::Material& source, Material& material) {
    const auto* value = extension(source, "KHR_materials_sheen");
    if (value == nullptr) return;
    if (const auto color = numbers<3>(*value, "sheenColorFactor"))
      for (int c = 0; c < 3; ++c) material.sheenColorFactor[c] = within((*color)[static_cast<std::size_t>(c)], 0, 1, "sheenColorFactor");
    if (material.sheenColorFactor == glm::vec3(0.0f)) return;
    material.sheenColorTexture = textureOf(*value, "sheenColorTexture", material.sheenColorTransform);
    material.sheenRoughness = within(gltfNumber(*value, "sheenRoughnessFactor", 0.0), 0, 1, "sheenRoughnessFactor");
    material.sheenRoughnessTexture = textureOf(*value, "sheenRoughnessTexture", material.sheenRoughnessTransform);
  }

  void readReflectance(const tinygltf::Material& source, Material& material) {
    const auto* value = extension(source, "CHIARO_materials_reflectance");
    if (value == nullptr) return;
    const std::string where = label_ + " has in CHIARO_materials_reflectance ";
    const std::string name = value->Has("model") && value->Get("model").IsString() ? value->Get("model").Get<std::string>() : "";
    const auto model = reflectanceFromName(name);
    if (!model) throw inputError(path_.string(), where + (name.empty() ? "no model" : "the unknown model \"" + name + "\""), "name one of " + reflectanceNameList());
    material.reflectance = *model;
    if (const auto width = numbers<2>(*value, "width")) {
      if (!((*width)[0] > 0.0 && (*width)[1] > 0.0))
        throw inputError(path_.string(), where + "a width that is not above 0", "give two widths or exponents, along tangent and bitangent");
      const bool exponent = hasExponent(*model);
      const auto inRange = [&](double w) {
        return within(w, static_cast<double>(exponent ? kLeastExponent : kLeastWidth), static_cast<double>(exponent ? kMostExponent : kMostWidth), "width");
      };
      material.reflectanceWidth = glm::vec2(inRange((*width)[0]), inRange((*width)[1]));
      if (isRound(*model)) material.reflectanceWidth->y = material.reflectanceWidth->x;
    }
    if (const auto color = numbers<3>(*value, "specularColor")) {
      material.reflectanceF0.emplace(0.0f);
      for (int c = 0; c < 3; ++c) (*material.reflectanceF0)[c] = within((*color)[static_cast<std::size_t>(c)], 0, 1, "specularColor");
    }
  }

  /// An extension of the material, where it is an object.
  static const tinygltf::Value* extension(const tinygltf::Material& source, const char* name) {
    const auto found = source.extensions.find(name);
    return found != source.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
  }

  /// A list of `Size` finite numbers; nothing where it is absent.
  template <std::size_t Size>
  std::optional<std::array<double, Size>> numbers(const tinygltf::Value& object, const char* key) const {
    if (!object.Has(key)) return std::nullopt;
    const auto& list = object.Get(key);
    std::array<double, Size> out{};
    bool good = list.IsArray() && list.ArrayLen() == Size;
    for (std::size_t i = 0; good && i < Size; ++i) {
      const auto& entry = list.Get(static_cast<int>(i));
      good = entry.IsNumber();
      if (good) out[i] = entry.GetNumberAsDouble();
      good = good && std::abs(out[i]) <= 1e30;  // what a float holds; NaN fails
    }
    if (!good) throw inputError(path_.string(), label_ + " has a " + key + " that is not a list of " + std::to_string(Size) + " numbers", "export the file again");
    return out;
  }

  /// A texture that a member of an extension names.
  int textureOf(const tinygltf::Value& object, const char* key, TextureTransform& transform) {
    if (!object.Has(key)) return kNone;
    const auto& reference = object.Get(key);
    tinygltf::TextureInfo info;
    info.index = static_cast<int>(gltfNumber(reference, "index", -2.0));
    info.texCoord = static_cast<int>(gltfNumber(reference, "texCoord", 0.0));
    if (reference.Has("extensions") && reference.Get("extensions").Has("KHR_texture_transform"))
      info.extensions["KHR_texture_transform"] = reference.Get("extensions").Get("KHR_texture_transform");
    return texture(info, transform);
  }

  const tinygltf::Model& model_;
  const std::filesystem::path& path_;
  Warnings& warnings_;
  Scene& scene_;
  std::string label_;  // of the material being read
};

}  // namespace

double gltfNumber(const tinygltf::Value& object, const std::string& key, double fallback) {
  if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) return fallback;
  return object.Get(key).GetNumberAsDouble();
}

void readGltfMaterials(const tinygltf::Model& model, const GltfAccessors& accessors, ImageBytes images,
                       const std::filesystem::path& path, Warnings& warnings, Scene& scene) {
  MaterialReader reader(model, path, warnings, scene);
  reader.readImages(accessors, images);
  reader.readTextures();
  reader.readMaterials();
}

}  // namespace chiaro
