#include "assets/transfer/gltf_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "assets/scene/glb.h"
#include "assets/transfer/transfer_format.h"

namespace chiaro {
namespace {

enum ComponentType { kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };

void appendWord(std::vector<std::uint8_t>& out, std::size_t word) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
}

int push(Json& root, const char* list, Json value) {
  auto& array = root[list];
  array.push_back(std::move(value));
  return static_cast<int>(array.size() - 1);
}

template <int Size>
Json list(const glm::vec<Size, float>& v) {
  Json out = Json::array();
  for (int i = 0; i < Size; ++i) out.push_back(v[i]);
  return out;
}

Json list(const glm::mat4& m) {
  Json out = Json::array();
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      out.push_back(m[c][r] + 0.0f);  // no -0: the product of transforms that a reader forms loses its sign
  return out;
}

/// The least power of two that brings the largest component to 1 or less: dividing by it loses no bit.
float powerOfTwoOver(glm::vec3 color) {
  int exponent = 0;
  const float largest = std::max({color.x, color.y, color.z});
  if (largest <= 1.0f) return 1.0f;
  const float mantissa = std::frexp(largest, &exponent);
  return std::ldexp(1.0f, mantissa == 0.5f ? exponent - 1 : exponent);
}

class SceneWriter {
 public:
  SceneWriter(const Scene& scene, GltfWriter& writer) : scene_(scene), writer_(writer), json_(writer.json) {}

  void writeImages() {
    for (std::size_t i = 0; i < scene_.images.size(); ++i) {
      const auto& image = scene_.images[i];
      Json out = Json::object();
      if (!image.name.empty()) out["name"] = image.name;
      out["bufferView"] = writer_.addArray(image.bytes, "image " + (image.name.empty() ? std::to_string(i) : image.name));
      out["mimeType"] = image.mimeType;
      push(json_, "images", std::move(out));
    }
  }

  void writeTextures() {
    for (const auto& texture : scene_.textures) {
      Json out = Json::object();
      Json sampler{{"magFilter", texture.nearest ? 9728 : 9729},
                   {"minFilter", 9987},
                   {"wrapS", wrap(texture.wrapS)},
                   {"wrapT", wrap(texture.wrapT)}};
      const auto& known = json_["samplers"];
      const auto found = std::find(known.begin(), known.end(), sampler);
      out["sampler"] =
          found != known.end() ? static_cast<int>(found - known.begin()) : push(json_, "samplers", std::move(sampler));
      if (texture.image != kNone) out["source"] = texture.image;
      push(json_, "textures", std::move(out));
    }
  }

  void writeMaterials() {
    for (const auto& material : scene_.materials) {
      Json pbr = Json::object();
      pbr["baseColorFactor"] = list(material.baseColorFactor);
      addTexture(pbr, "baseColorTexture", material.baseColorTexture, material.baseColorTransform);
      pbr["metallicFactor"] = material.metallicFactor;
      pbr["roughnessFactor"] = material.roughnessFactor;
      addTexture(pbr, "metallicRoughnessTexture", material.metallicRoughnessTexture, material.metallicRoughnessTransform);
      Json out = Json::object();
      if (!material.name.empty()) out["name"] = material.name;
      out["pbrMetallicRoughness"] = std::move(pbr);
      if (addTexture(out, "normalTexture", material.normalTexture, material.normalTransform))
        out["normalTexture"]["scale"] = material.normalScale;
      if (addTexture(out, "occlusionTexture", material.occlusionTexture, material.occlusionTransform))
        out["occlusionTexture"]["strength"] = material.occlusionStrength;
      addTexture(out, "emissiveTexture", material.emissiveTexture, material.emissiveTransform);
      writeEmission(material, out);
      if (material.alphaMode == AlphaMode::mask) out["alphaMode"] = "MASK", out["alphaCutoff"] = material.alphaCutoff;
      if (material.alphaMode == AlphaMode::blend) out["alphaMode"] = "BLEND";
      if (material.doubleSided) out["doubleSided"] = true;
      writeAnisotropy(material, out);
      writeSpecular(material, out);
      writeClearcoat(material, out);
      writeSheen(material, out);
      writeReflectance(material, out);
      push(json_, "materials", std::move(out));
    }
  }

  std::vector<Json::json_pointer> writeMeshes(const std::vector<std::size_t>& order) {
    std::vector<Json::json_pointer> places;
    int current = kNone;
    for (const std::size_t index : order) {
      const auto& primitive = scene_.primitives[index];
      const auto& name = scene_.meshNames[static_cast<std::size_t>(primitive.mesh)];
      if (primitive.mesh != current || places.empty()) {
        current = primitive.mesh;
        Json mesh = Json::object(), node = Json::object();
        if (!name.empty()) mesh["name"] = node["name"] = name;
        mesh["primitives"] = Json::array();
        node["mesh"] = push(json_, "meshes", std::move(mesh));
        nodeOf_[current] = addNode(std::move(node));
      }
      auto& mesh = json_["meshes"].back();
      const std::string label = "mesh " + (name.empty() ? std::to_string(json_["meshes"].size() - 1) : name) + ", primitive " +
                                std::to_string(mesh["primitives"].size());
      mesh["primitives"].push_back(primitiveJson(primitive, label));
      places.emplace_back("/meshes/" + std::to_string(json_["meshes"].size() - 1) + "/primitives/" +
                          std::to_string(mesh["primitives"].size() - 1));
    }
    return places;
  }

  void writeCameras() {
    for (const auto& camera : scene_.cameras) {
      Json out = Json::object(), node = Json::object();
      if (!camera.name.empty()) out["name"] = node["name"] = camera.name;
      if (camera.perspective) {
        out["type"] = "perspective";
        out["perspective"] = {{"yfov", camera.verticalFov}, {"znear", camera.nearPlane}, {"zfar", camera.farPlane}};
      } else {
        out["type"] = "orthographic";
        out["orthographic"] = {{"xmag", camera.verticalExtent},
                               {"ymag", camera.verticalExtent},
                               {"znear", camera.nearPlane},
                               {"zfar", camera.farPlane}};
      }
      node["camera"] = push(json_, "cameras", std::move(out));
      addMatrix(node, camera.worldFromCamera);
      addNode(std::move(node));
    }
  }

  void writeLights() {
    if (scene_.lights.empty()) return;
    use("KHR_lights_punctual");
    auto& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
    for (const auto& light : scene_.lights) {
      // A colour must be in [0,1]; the rest of it moves into the intensity.
      const float scale = powerOfTwoOver(light.color);
      Json out = Json::object(), node = Json::object();
      if (!light.name.empty()) out["name"] = node["name"] = light.name;
      const bool round = light.type == LightType::point || light.type == LightType::sphere;
      const bool coned = light.type == LightType::spot || light.type == LightType::disk;
      out["type"] = round ? "point" : coned ? "spot" : "directional";
      out["color"] = list(light.color / scale);
      out["intensity"] = light.intensity * scale;
      if (light.type != LightType::directional && std::isfinite(light.range)) out["range"] = light.range;
      if (coned) out["spot"] = {{"innerConeAngle", light.innerConeAngle}, {"outerConeAngle", light.outerConeAngle}};
      addArea(out, light);
      node["extensions"]["KHR_lights_punctual"]["light"] = lights.size();
      lights.push_back(std::move(out));
      addMatrix(node, poseOf(light));
      addNode(std::move(node));
    }
  }

  void finish() {
    for (const auto& name : used_) json_["extensionsUsed"].push_back(name);
  }

 private:
  void addArea(Json& out, const Light& light) {
    const bool sized = light.type == LightType::sphere || light.type == LightType::disk;
    if (!sized && !(light.type == LightType::directional && light.angle > 0.0f)) return;
    use("CHIARO_lights_area");
    out["extensions"]["CHIARO_lights_area"] = sized ? Json{{"radius", light.radius}} : Json{{"angle", light.angle}};
  }

  static int wrap(Wrap mode) { return mode == Wrap::repeat ? 10497 : mode == Wrap::mirroredRepeat ? 33648 : 33071; }

  bool addTexture(Json& object, const char* key, int texture, const TextureTransform& transform) {
    if (texture == kNone) return false;
    object[key]["index"] = texture;
    if (transform == TextureTransform()) return true;
    use("KHR_texture_transform");
    auto& extension = object[key]["extensions"]["KHR_texture_transform"];
    extension["offset"] = list(transform.offset);
    extension["rotation"] = transform.rotation;
    extension["scale"] = list(transform.scale);
    return true;
  }

  void use(const char* extension) { used_.insert(extension); }

  void writeEmission(const Material& material, Json& out) {
    if (material.emissiveFactor == glm::vec3(0.0f)) return;
    const float strength = powerOfTwoOver(material.emissiveFactor);
    out["emissiveFactor"] = list(material.emissiveFactor / strength);
    if (strength == 1.0f) return;
    use("KHR_materials_emissive_strength");
    out["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  }

  void writeAnisotropy(const Material& material, Json& out) {
    if (material.anisotropyStrength == 0.0f && material.anisotropyRotation == 0.0f && material.anisotropyTexture == kNone) return;
    use("KHR_materials_anisotropy");
    auto& extension = out["extensions"]["KHR_materials_anisotropy"];
    extension["anisotropyStrength"] = material.anisotropyStrength;
    extension["anisotropyRotation"] = material.anisotropyRotation;
    addTexture(extension, "anisotropyTexture", material.anisotropyTexture, material.anisotropyTransform);
  }

  void writeSpecular(const Material& material, Json& out) {
    if (material.ior != 1.5f) {
      use("KHR_materials_ior");
      out["extensions"]["KHR_materials_ior"]["ior"] = material.ior;
    }
    if (material.specularFactor == 1.0f && material.specularTexture == kNone && material.specularColorFactor == glm::vec3(1.0f) &&
        material.specularColorTexture == kNone)
      return;
    use("KHR_materials_specular");
    auto& extension = out["extensions"]["KHR_materials_specular"];
    extension["specularFactor"] = material.specularFactor;
    addTexture(extension, "specularTexture", material.specularTexture, material.specularTransform);
    extension["specularColorFactor"] = list(material.specularColorFactor);
    addTexture(extension, "specularColorTexture", material.specularColorTexture, material.specularColorTransform);
  }

  void writeClearcoat(const Material& material, Json& out) {
    if (material.clearcoatFactor == 0.0f) return;  // and with it everything else of a coat
    use("KHR_materials_clearcoat");
    auto& extension = out["extensions"]["KHR_materials_clearcoat"];
    extension["clearcoatFactor"] = material.clearcoatFactor;
    addTexture(extension, "clearcoatTexture", material.clearcoatTexture, material.clearcoatTransform);
    extension["clearcoatRoughnessFactor"] = material.clearcoatRoughness;
    addTexture(extension, "clearcoatRoughnessTexture", material.clearcoatRoughnessTexture, material.clearcoatRoughnessTransform);
  }

  void writeSheen(const Material& material, Json& out) {
    if (material.sheenColorFactor == glm::vec3(0.0f)) return;  // and with it everything else of a sheen
    use("KHR_materials_sheen");
    auto& extension = out["extensions"]["KHR_materials_sheen"];
    extension["sheenColorFactor"] = list(material.sheenColorFactor);
    addTexture(extension, "sheenColorTexture", material.sheenColorTexture, material.sheenColorTransform);
    extension["sheenRoughnessFactor"] = material.sheenRoughness;
    addTexture(extension, "sheenRoughnessTexture", material.sheenRoughnessTexture, material.sheenRoughnessTransform);
  }

  void writeReflectance(const Material& material, Json& out) {
    if (material.reflectance == Reflectance::ggx && !material.reflectanceWidth && !material.reflectanceF0) return;
    use("CHIARO_materials_reflectance");
    auto& extension = out["extensions"]["CHIARO_materials_reflectance"];
    extension["model"] = reflectanceNames()[static_cast<std::size_t>(material.reflectance)];
    if (material.reflectanceWidth) extension["width"] = list(*material.reflectanceWidth);
    if (material.reflectanceF0) extension["specularColor"] = list(*material.reflectanceF0);
  }

  Json primitiveJson(const Primitive& primitive, const std::string& label) {
    using Target = GltfWriter::Target;
    const std::size_t count = primitive.positions.size();
    Json attributes = Json::object();
    const auto vertexArray = [&](const char* name, const auto& values, const char* type) {
      if (values.empty()) return;
      attributes[name] =
          writer_.addAccessor(writer_.addArray(values, name + (" of " + label), Target::vertices), kFloat, type, count);
    };
    vertexArray("POSITION", primitive.positions, "VEC3");
    glm::vec3 lower = primitive.positions.front(), upper = lower;
    for (const auto& p : primitive.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
    auto& accessor = json_["accessors"].back();
    accessor["min"] = list(lower);
    accessor["max"] = list(upper);
    vertexArray("NORMAL", primitive.normals, "VEC3");
    vertexArray("TANGENT", primitive.tangents, "VEC4");
    vertexArray("TEXCOORD_0", primitive.texcoords, "VEC2");
    Json out = Json::object();
    out["attributes"] = std::move(attributes);
    out["indices"] = writeIndices(primitive, label);
    if (primitive.material != kNone) out["material"] = primitive.material;
    if (!primitive.name.empty()) out["extras"]["name"] = primitive.name;
    return out;
  }

  int writeKeys(const auto& values, const std::string& name, const char* type) {
    return writer_.addAccessor(writer_.addArray(values, name), kFloat, type, values.size());
  }

 public:
  /// One animation; meshes stand in the world, so that a node's transform is its motion.
  void writeMotions() {
    if (scene_.motions.empty()) return;
    Json animation = Json::object();
    for (const auto& motion : scene_.motions) {
      const auto shown = nodeOf_.find(motion.mesh);
      if (shown == nodeOf_.end()) continue;  // nothing is left of it
      const std::string label = " of motion " + std::to_string(motion.mesh);
      std::vector<glm::vec4> rotations;
      for (const auto& q : motion.rotations) rotations.emplace_back(q.x, q.y, q.z, q.w);
      const int times = writeKeys(motion.times, "times" + label, "SCALAR");
      json_["accessors"].back()["min"] = Json::array({motion.times.front()});
      json_["accessors"].back()["max"] = Json::array({motion.times.back()});
      const auto channel = [&](const char* path, int output) {
        const int sampler = push(animation, "samplers", {{"input", times}, {"output", output}});
        push(animation, "channels", {{"sampler", sampler}, {"target", {{"node", shown->second}, {"path", path}}}});
      };
      channel("rotation", writeKeys(rotations, "rotations" + label, "VEC4"));
      channel("translation", writeKeys(motion.shifts, "shifts" + label, "VEC3"));
    }
    if (!animation.empty()) push(json_, "animations", std::move(animation));
  }

 private:
  int writeIndices(const Primitive& primitive, const std::string& label) {
    using Target = GltfWriter::Target;
    // 65535 is no index in 16 bits: it restarts strips (glTF 2.0, 3.7.2.1).
    if (primitive.positions.size() > 65535)
      return writer_.addAccessor(writer_.addArray(primitive.indices, "indices of " + label, Target::indices), kUnsignedInt,
                                 "SCALAR", primitive.indices.size());
    const std::vector<std::uint16_t> narrow(primitive.indices.begin(), primitive.indices.end());
    return writer_.addAccessor(writer_.addArray(narrow, "indices of " + label, Target::indices), kUnsignedShort, "SCALAR",
                               narrow.size());
  }

  static glm::mat4 poseOf(const Light& light) {
    const glm::dvec3 back = -glm::dvec3(light.direction);
    const glm::dvec3 helper = std::abs(back.y) > 0.9 * glm::length(back) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(helper, back));
    const glm::dvec3 up = glm::normalize(glm::cross(back, right));
    return {glm::vec4(glm::vec3(right), 0), glm::vec4(glm::vec3(up), 0), glm::vec4(-light.direction, 0),
            glm::vec4(light.position, 1)};
  }

  static void addMatrix(Json& node, const glm::mat4& matrix) {
    if (matrix != glm::mat4(1.0f)) node["matrix"] = list(matrix);
  }

  int addNode(Json node) {
    const int index = push(json_, "nodes", std::move(node));
    json_["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  const Scene& scene_;
  GltfWriter& writer_;
  Json& json_;
  std::set<std::string> used_;
  std::map<int, int> nodeOf_;  // of meshes
};

}  // namespace

int GltfWriter::addBufferView(std::span<const std::uint8_t> bytes, const std::string& name, Target target) {
  binary_.resize(aligned4(binary_.size()));
  Json view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target != Target::none) view["target"] = static_cast<int>(target);
  view["name"] = name;
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  checksums_.push_back(checksumOf(bytes));
  return push(json, "bufferViews", std::move(view));
}

int GltfWriter::addAccessor(int bufferView, int componentType, const char* type, std::size_t count, bool normalized) {
  Json accessor{{"bufferView", bufferView}, {"componentType", componentType}, {"count", count}, {"type", type}};
  if (normalized) accessor["normalized"] = true;
  return push(json, "accessors", std::move(accessor));
}

std::vector<std::uint8_t> GltfWriter::container(const std::string& json, const std::vector<std::uint8_t>& binary) {
  const std::size_t jsonSize = aligned4(json.size()), binarySize = aligned4(binary.size());
  std::vector<std::uint8_t> out;
  out.reserve(28 + jsonSize + binarySize);
  appendWord(out, kGlbMagic);
  appendWord(out, kGlbVersion);
  appendWord(out, 12 + 8 + jsonSize + (binary.empty() ? 0 : 8 + binarySize));
  appendWord(out, jsonSize);
  appendWord(out, kGlbJsonChunk);
  out.insert(out.end(), json.begin(), json.end());
  out.resize(20 + jsonSize, ' ');
  if (binary.empty()) return out;
  appendWord(out, binarySize);
  appendWord(out, kGlbBinaryChunk);
  out.insert(out.end(), binary.begin(), binary.end());
  out.resize(28 + jsonSize + binarySize, 0);
  return out;
}

std::vector<std::size_t> primitiveOrder(const Scene& scene) {
  std::vector<std::size_t> order(scene.primitives.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scene.primitives[a].mesh < scene.primitives[b].mesh; });
  return order;
}

std::vector<Json::json_pointer> writeScene(const Scene& scene, const std::vector<std::size_t>& order, GltfWriter& writer) {
  writer.json["scene"] = 0;
  writer.json["scenes"] = Json::array({Json::object()});
  SceneWriter sceneWriter(scene, writer);
  auto places = sceneWriter.writeMeshes(order);
  sceneWriter.writeCameras();
  sceneWriter.writeLights();
  sceneWriter.writeMotions();
  sceneWriter.writeImages();
  sceneWriter.writeTextures();
  sceneWriter.writeMaterials();
  sceneWriter.finish();
  return places;
}

}  // namespace chiaro
