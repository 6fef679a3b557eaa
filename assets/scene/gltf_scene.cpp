#include "assets/scene/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <set>
#include <string>

#include "assets/error.h"
#include "assets/scene/glb.h"
#include "assets/scene/gltf_accessor.h"
#include "assets/scene/gltf_material.h"
#include "assets/scene/gltf_motion.h"
#include "assets/scene/primitive_normals.h"
#include "assets/scene/warnings.h"

namespace chiaro {
namespace {

constexpr std::size_t kLargestFile = 0xFFFFFFFFu;  // TinyGLTF takes 32 bit lengths
constexpr int kDeepestNode = 512;

const std::set<std::string> kSupported{"KHR_lights_punctual",   "KHR_materials_emissive_strength", "KHR_materials_anisotropy",
                                       "KHR_mesh_quantization", "KHR_texture_transform",           "CHIARO_radiance_transfer",
                                       "KHR_materials_ior",     "KHR_materials_specular",          "KHR_materials_clearcoat",
                                       "KHR_materials_sheen",
                                       "CHIARO_materials_reflectance", "CHIARO_lights_area"};

std::string named(const std::string& kind, int index, const std::string& name) {
  return kind + " " + std::to_string(index) + (name.empty() ? "" : " (" + name + ")");
}

/// Keeps encoded images. Those in buffer views are left alone: TinyGLTF does not check that these lie inside their buffer.
bool keepEncoded(tinygltf::Image* image, const int index, std::string*, std::string*, int, int, const unsigned char* bytes,
                 int size, void* user) {
  auto& images = *static_cast<ImageBytes*>(user);
  if (image->bufferView >= 0 || index < 0) return true;
  if (images.size() <= static_cast<std::size_t>(index)) images.resize(static_cast<std::size_t>(index) + 1);
  images[static_cast<std::size_t>(index)].assign(bytes, bytes + size);
  return true;
}

tinygltf::Model parse(std::span<const std::uint8_t> bytes, const std::filesystem::path& path, ImageBytes& images) {
  const std::string where = path.string();
  if (bytes.size() > kLargestFile) throw inputError(where, "is larger than 4 GiB", "split it");
  const bool binary = startsLikeGlb(bytes);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  requireShallowJson(binary ? parseGlb(bytes, where).json : std::string_view(text, bytes.size()), where);

  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keepEncoded, &images);
  tinygltf::Model model;
  std::string error, warning;
  const auto length = static_cast<unsigned int>(bytes.size());
  bool ok = false;
  try {
    const std::string folder = path.parent_path().string();
    ok = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), length, folder)
                : loader.LoadASCIIFromString(&model, &error, &warning, text, length, folder);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!ok) throw inputError(where, "is not a readable glTF file: " + (error.empty() ? warning : error), "export it again");
  if (model.asset.version.rfind("2.", 0) != 0)
    throw inputError(where, "has glTF version " + model.asset.version + ", not 2.0", "convert it to glTF 2.0");
  return model;
}

bool isFinite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

/// Already-unit vectors keep their bits, so that a file written by Chiaro reads back unchanged.
glm::vec3 unit(glm::dvec3 v) {
  const double squared = glm::dot(v, v);
  return std::abs(squared - 1.0) <= 1e-6 ? glm::vec3(v) : glm::vec3(v / std::sqrt(squared));
}

struct LinearPart {
  glm::dmat3 linear;
  glm::dmat3 cofactor;  ///< the inverse transpose times the determinant; takes normals along, and exists for every scale
  int rank;             ///< 3, 2 for what is flattened into a plane, or 1 for less
};

LinearPart linearPart(const glm::dmat4& world) {
  constexpr double kNothing = 1e-12;  // relative; a rotation leaves this much of a zero scale, and its sign means nothing
  const glm::dmat3 m(world);
  LinearPart part{m, glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])), 3};
  const double size = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
  if (std::abs(glm::determinant(m)) > kNothing * size * size * size) return part;
  const auto longer = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::dot(a, a) < glm::dot(b, b); };
  const glm::dvec3 widest = std::max({part.cofactor[0], part.cofactor[1], part.cofactor[2]}, longer);
  part.rank = glm::length(widest) > kNothing * size * size ? 2 : 1;
  if (part.rank == 1) return part;
  // Every normal becomes the plane's, on the side that it was: without the rounding error that would turn those of its edges.
  const glm::dvec3 normal = glm::normalize(widest);
  part.cofactor = glm::outerProduct(normal, glm::transpose(part.cofactor) * normal);
  return part;
}

/// The file's index list, or 0, 1, 2, ...; strips and fans become lists (glTF 2.0, 3.7.2.1).
std::vector<std::uint32_t> triangleList(const std::vector<std::uint32_t>& in, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return in;
  std::vector<std::uint32_t> out;
  for (std::size_t i = 2; i < in.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      out.insert(out.end(), {in[i - 1], in[i], in[0]});
    } else {
      const std::size_t odd = i % 2;
      out.insert(out.end(), {in[i - 2], in[i - 1 + odd], in[i - odd]});
    }
  }
  return out;
}

class SceneReader {
 public:
  SceneReader(const tinygltf::Model& model, ImageBytes images, const std::filesystem::path& path, const WarningHandler& warn)
      : model_(model), path_(path), where_(path.string()), accessors_(model, where_), warnings_(warn) {
    checkExtensions();
    readGltfMaterials(model_, accessors_, std::move(images), path_, warnings_, scene_);
    reached_.assign(model_.nodes.size(), false);
    for (const int root : roots()) visit(root, glm::dmat4(1.0), 0);
    limitInfiniteCameras();
    scene_.motions = readGltfMotions(model_, accessors_, meshes_, where_, warnings_);
  }

  Scene take() { return std::move(scene_); }

 private:
  void checkExtensions() {
    for (const auto& name : model_.extensionsRequired)
      if (kSupported.count(name) == 0)
        throw inputError(where_, "requires the glTF extension " + name + ", which is not supported",
                         "export it without that extension");
    for (const auto& name : model_.extensionsUsed)
      if (kSupported.count(name) == 0) warnings_.say("the glTF extension " + name + " is ignored");
    quantized_ = std::count(model_.extensionsUsed.begin(), model_.extensionsUsed.end(), "KHR_mesh_quantization") != 0;
  }

  std::vector<int> roots() const {
    if (!model_.scenes.empty()) {
      const int index = std::max(model_.defaultScene, 0);
      if (static_cast<std::size_t>(index) >= model_.scenes.size())
        throw inputError(where_, "its default scene " + std::to_string(index) + " does not exist", "export it again");
      return model_.scenes[static_cast<std::size_t>(index)].nodes;
    }
    std::vector<bool> isChild(model_.nodes.size(), false);
    for (const auto& node : model_.nodes)
      for (const int child : node.children)
        if (child >= 0 && static_cast<std::size_t>(child) < isChild.size()) isChild[static_cast<std::size_t>(child)] = true;
    std::vector<int> found;
    for (std::size_t i = 0; i < isChild.size(); ++i)
      if (!isChild[i]) found.push_back(static_cast<int>(i));
    return found;
  }

  void visit(int index, const glm::dmat4& parent, int depth) {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size())
      throw inputError(where_, "names node " + std::to_string(index) + ", which does not exist", "export it again");
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    const std::string label = named("node", index, node.name);
    if (reached_[static_cast<std::size_t>(index)] || depth > kDeepestNode)
      throw inputError(where_, label + " is reached twice: nodes must form a tree", "export it again");
    reached_[static_cast<std::size_t>(index)] = true;
    ancestors_.push_back(index);
    const glm::dmat4 world = parent * localTransform(node);
    if (!isFinite(world)) throw inputError(where_, label + " has a transform that is not finite", "export it again");
    if (node.mesh != -1) addMesh(node, label, world);
    if (node.camera != -1) addCamera(node, label, world);
    if (const auto light = node.extensions.find("KHR_lights_punctual"); light != node.extensions.end())
      addLight(static_cast<int>(gltfNumber(light->second, "light", -1.0)), label, world);
    if (node.skin != -1) warnings_.say(label + " is skinned: its mesh is taken in its bind pose");
    if (node.extensions.count("EXT_mesh_gpu_instancing") != 0) warnings_.say(label + " is instanced: one instance is taken");
    for (const int child : node.children) visit(child, world, depth + 1);
    ancestors_.pop_back();
  }

  void addMesh(const tinygltf::Node& node, const std::string& label, const glm::dmat4& world) {
    if (node.mesh < 0 || static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
      throw inputError(where_, label + " names mesh " + std::to_string(node.mesh) + ", which does not exist", "export it again");
    const auto& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    // A zero scale is how some exporters hide a node; one axis at zero is a flattened mesh, and to be seen.
    if (linearPart(world).rank < 2) {
      warnings_.say(label + " is scaled to nothing and left out");
      return;
    }
    const int instance = static_cast<int>(scene_.meshNames.size());
    bool any = false;
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      Primitive primitive;
      primitive.mesh = instance;
      const std::string primitiveLabel = "primitive " + std::to_string(p) + " of " + named("mesh", node.mesh, mesh.name);
      if (!readPrimitive(mesh.primitives[p], primitiveLabel, primitive)) continue;
      primitive.name = primitiveName(mesh, p);
      transform(primitive, world, primitiveLabel);
      scene_.primitives.push_back(std::move(primitive));
      any = true;
    }
    if (!any) return;
    scene_.meshNames.push_back(node.name.empty() ? mesh.name : node.name);
    meshes_.push_back({instance, label, ancestors_});
  }

  static std::string primitiveName(const tinygltf::Mesh& mesh, std::size_t index) {
    const auto& extras = mesh.primitives[index].extras;
    if (extras.IsObject() && extras.Has("name") && extras.Get("name").IsString()) return extras.Get("name").Get<std::string>();
    return mesh.primitives.size() == 1 ? mesh.name : mesh.name + "/" + std::to_string(index);
  }

  /// False when there is nothing in it to keep.
  bool readPrimitive(const tinygltf::Primitive& source, const std::string& label, Primitive& out) {
    const int mode = source.mode == -1 ? TINYGLTF_MODE_TRIANGLES : source.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
      warnings_.say(label + " is made of points or lines and left out");
      return false;
    }
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN)
      throw inputError(where_, label + " has an unknown mode " + std::to_string(mode), "export it again");
    const auto accessor = [&](const char* name) {
      const auto found = source.attributes.find(name);
      return found == source.attributes.end() ? kNone : found->second;
    };
    if (accessor("POSITION") == kNone) {
      warnings_.say(label + " has no positions and is left out");
      return false;
    }
    if (source.material != -1 && (source.material < 0 || static_cast<std::size_t>(source.material) >= model_.materials.size()))
      throw inputError(where_, label + " names material " + std::to_string(source.material) + ", which does not exist",
                       "export it again");
    out.material = source.material == -1 ? kNone : source.material;

    const Integers direction = quantized_ ? Integers::normalizedSigned : Integers::none;
    read(accessor("POSITION"), quantized_ ? Integers::any : Integers::none, label + ": POSITION", out.positions);
    read(accessor("NORMAL"), direction, label + ": NORMAL", out.normals);
    read(accessor("TANGENT"), direction, label + ": TANGENT", out.tangents);
    read(accessor("TEXCOORD_0"), quantized_ ? Integers::any : Integers::normalizedUnsigned, label + ": TEXCOORD_0",
         out.texcoords);
    const std::size_t count = out.positions.size();
    requireSameCount(out.normals.size(), count, label + ": NORMAL");
    requireSameCount(out.tangents.size(), count, label + ": TANGENT");
    requireSameCount(out.texcoords.size(), count, label + ": TEXCOORD_0");
    warnAboutOthers(source, label);

    readIndices(source, mode, label, out);
    if (out.indices.empty()) {
      warnings_.say(label + " has no triangles and is left out");
      return false;
    }
    return true;
  }

  void readIndices(const tinygltf::Primitive& source, int mode, const std::string& label, Primitive& out) {
    std::vector<std::uint32_t> indices;
    if (source.indices != -1) {
      indices = accessors_.indices(source.indices, label + ": indices");
    } else {
      indices.resize(out.positions.size());
      for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
    }
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= out.positions.size())
        throw inputError(where_,
                         label + ": index " + std::to_string(i) + " is " + std::to_string(indices[i]) + ", but there are only " +
                             std::to_string(out.positions.size()) + " vertices",
                         "export it again");
    if (mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
      throw inputError(where_, label + " has " + std::to_string(indices.size()) + " indices, which is not a multiple of 3",
                       "export it again");
    out.indices = triangleList(indices, mode);
  }

  template <int Width>
  void read(int accessor, Integers integers, const std::string& what, std::vector<glm::vec<Width, float>>& out) const {
    if (accessor == kNone) return;
    const auto values = accessors_.floats(accessor, Width, integers, what);
    out.resize(values.size() / static_cast<std::size_t>(Width));
    for (std::size_t i = 0; i < out.size(); ++i)
      for (int c = 0; c < Width; ++c) out[i][c] = values[i * static_cast<std::size_t>(Width) + static_cast<std::size_t>(c)];
  }

  void requireSameCount(std::size_t found, std::size_t expected, const std::string& what) const {
    if (found != 0 && found != expected)
      throw inputError(where_, what + " has " + std::to_string(found) + " elements for " + std::to_string(expected) + " vertices",
                       "export it again");
  }

  void warnAboutOthers(const tinygltf::Primitive& source, const std::string& label) {
    static const std::set<std::string> kRead{"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"};
    for (const auto& [name, unused] : source.attributes)
      if (kRead.count(name) == 0 && name.rfind("_SSDF_", 0) != 0 && name.rfind("_VISIBILITY_", 0) != 0)
        warnings_.say("vertex attribute " + name + " is ignored");
    if (!source.targets.empty()) warnings_.say(label + " has morph targets, which are ignored");
  }

  void transform(Primitive& primitive, const glm::dmat4& world, const std::string& label) {
    if (world != glm::dmat4(1.0)) {
      const auto [linear, cofactor, rank] = linearPart(world);
      const double sign = rank == 3 && glm::determinant(linear) < 0.0 ? -1.0 : 1.0;
      for (auto& position : primitive.positions) position = glm::vec3(world * glm::dvec4(position, 1.0));
      for (auto& normal : primitive.normals) normal = direction(sign * (cofactor * glm::dvec3(normal)));
      for (auto& tangent : primitive.tangents)
        tangent = glm::vec4(direction(linear * glm::dvec3(tangent)), static_cast<float>(sign) * tangent.w);
      if (sign < 0.0)
        for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
          std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
    }
    for (const auto& p : primitive.positions)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        throw inputError(where_, label + " stands where a float cannot reach", "scale the scene down");
    if (primitive.normals.empty()) {
      makeFlat(primitive);
    } else if (const auto replaced = normalizeNormals(primitive); replaced != 0) {
      warnings_.say(label + ": " + std::to_string(replaced) + " normals of zero length are computed from the triangles");
    }
    finishTangents(primitive, label);
  }

  /// Unit, or zero where there is no direction.
  static glm::vec3 direction(glm::dvec3 v) {
    const double length = glm::length(v);
    return length > 0.0 ? glm::vec3(v / length) : glm::vec3(0.0f);
  }

  void finishTangents(Primitive& primitive, const std::string& label) {
    for (auto& tangent : primitive.tangents) {
      const glm::dvec3 t(tangent);
      if (!(glm::dot(t, t) > 1e-20) || tangent.w == 0.0f) {
        warnings_.say(label + " has tangents of zero length: all its tangents are computed again");
        primitive.tangents.clear();
        return;
      }
      tangent = glm::vec4(unit(t), tangent.w < 0.0f ? -1.0f : 1.0f);
    }
  }

  void addCamera(const tinygltf::Node& node, const std::string& label, const glm::dmat4& world) {
    if (node.camera < 0 || static_cast<std::size_t>(node.camera) >= model_.cameras.size())
      throw inputError(where_, label + " names camera " + std::to_string(node.camera) + ", which does not exist",
                       "export it again");
    const auto& source = model_.cameras[static_cast<std::size_t>(node.camera)];
    Camera camera;
    camera.name = source.name.empty() ? node.name : source.name;
    camera.worldFromCamera = rigid(world, label);
    camera.perspective = source.type != "orthographic";
    if (camera.perspective) {
      camera.verticalFov = static_cast<float>(source.perspective.yfov);
      camera.nearPlane = static_cast<float>(source.perspective.znear);
      camera.farPlane =
          source.perspective.zfar > 0.0 ? static_cast<float>(source.perspective.zfar) : std::numeric_limits<float>::infinity();
    } else {
      camera.verticalExtent = static_cast<float>(source.orthographic.ymag);
      camera.nearPlane = static_cast<float>(source.orthographic.znear);
      camera.farPlane = static_cast<float>(source.orthographic.zfar);
    }
    const bool ok = camera.perspective ? camera.verticalFov > 0.0f && camera.verticalFov < 3.1415926f && camera.nearPlane > 0.0f
                                       : camera.verticalExtent > 0.0f && camera.nearPlane >= 0.0f;
    if (!ok || !(camera.farPlane > camera.nearPlane))
      throw inputError(where_, "the camera of " + label + " has an angle or a plane out of range", "export it again");
    scene_.cameras.push_back(std::move(camera));
  }

  /// The rotation and place in `world`; a camera has no scale (glTF 2.0, 3.10).
  glm::mat4 rigid(const glm::dmat4& world, const std::string& label) const {
    const glm::dmat3 linear(world);
    if (!(std::abs(glm::determinant(linear)) > 0.0))
      throw inputError(where_, label + " has a camera or light and no orientation (its scale is zero)", "export it again");
    const glm::vec3 back = unit(linear[2]);
    // Gram-Schmidt from the viewing direction, unless it is a rotation already.
    const glm::dmat3 product = glm::transpose(linear) * linear;
    bool orthonormal = glm::determinant(linear) > 0.0;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) orthonormal = orthonormal && std::abs(product[c][r] - (c == r ? 1.0 : 0.0)) <= 1e-6;
    if (orthonormal) return glm::mat4(world);
    const glm::dvec3 b(back);
    glm::dvec3 up = linear[1] - glm::dot(linear[1], b) * b;
    up = glm::normalize(up);
    return glm::mat4(glm::vec4(glm::vec3(glm::cross(up, b)), 0), glm::vec4(glm::vec3(up), 0), glm::vec4(back, 0),
                     glm::vec4(world[3]));
  }

  void limitInfiniteCameras() {
    const Bounds bounds = boundsOf(scene_);
    for (auto& camera : scene_.cameras) {
      if (std::isfinite(camera.farPlane)) continue;
      const float reach =
          bounds.empty() ? 0.0f : glm::length(glm::vec3(camera.worldFromCamera[3]) - bounds.center()) + bounds.diagonal();
      camera.farPlane = std::max(reach, 10.0f * camera.nearPlane);
    }
  }

  void addLight(int index, const std::string& label, const glm::dmat4& world) {
    const auto root = model_.extensions.find("KHR_lights_punctual");
    const bool listed = root != model_.extensions.end() && root->second.IsObject() && root->second.Get("lights").IsArray();
    if (!listed || index < 0 || static_cast<std::size_t>(index) >= root->second.Get("lights").ArrayLen() ||
        !root->second.Get("lights").Get(index).IsObject())
      throw inputError(where_, label + " names light " + std::to_string(index) + ", which does not exist", "export it again");
    const auto& source = root->second.Get("lights").Get(index);
    const std::string type = source.Has("type") && source.Get("type").IsString() ? source.Get("type").Get<std::string>() : "";
    const std::string name = source.Has("name") && source.Get("name").IsString() ? source.Get("name").Get<std::string>() : "";
    Light light;
    light.name = name;
    if (type == "point")
      light.type = LightType::point;
    else if (type == "spot")
      light.type = LightType::spot;
    else if (type != "directional")
      throw inputError(where_, named("light", index, name) + " has an unknown type \"" + type + "\"", "export it again");
    if (source.Has("color") && source.Get("color").ArrayLen() == 3)
      for (int c = 0; c < 3; ++c) light.color[c] = static_cast<float>(source.Get("color").Get(c).GetNumberAsDouble());
    light.intensity = static_cast<float>(gltfNumber(source, "intensity", 1.0));
    light.range = static_cast<float>(gltfNumber(source, "range", std::numeric_limits<double>::infinity()));
    if (light.type == LightType::spot && source.Has("spot")) {
      light.innerConeAngle = static_cast<float>(gltfNumber(source.Get("spot"), "innerConeAngle", 0.0));
      light.outerConeAngle = static_cast<float>(gltfNumber(source.Get("spot"), "outerConeAngle", 0.785398163397448));
    }
    if (source.Has("extensions") && source.Get("extensions").IsObject() && source.Get("extensions").Has("CHIARO_lights_area"))
      readArea(source.Get("extensions").Get("CHIARO_lights_area"), named("light", index, name), light);
    requireSaneLight(light, named("light", index, name));
    const glm::mat4 pose = rigid(world, label);
    light.position = glm::vec3(pose[3]);
    light.direction = -glm::vec3(pose[2]);
    scene_.lights.push_back(std::move(light));
  }

  /// CHIARO_lights_area (docs/format.md).
  void readArea(const tinygltf::Value& area, const std::string& label, Light& light) const {
    const char* member = light.type == LightType::directional ? "angle" : "radius";
    const bool given = area.IsObject() && area.Has(member) && area.Get(member).IsNumber();
    const double size = given ? area.Get(member).GetNumberAsDouble() : -1.0;
    const bool fits = light.type == LightType::directional ? size <= 1.5707964 : std::isfinite(static_cast<float>(size));
    if (!(size >= 0.0) || !fits)
      throw inputError(where_, label + " has a CHIARO_lights_area without " + (light.type == LightType::directional
                           ? "an \"angle\" between 0 and pi/2" : "a \"radius\" of 0 or more"),
                       "give it one, or leave the extension out");
    if (light.type == LightType::directional) {
      light.angle = static_cast<float>(size);
    } else {
      light.type = light.type == LightType::point ? LightType::sphere : LightType::disk;
      light.radius = static_cast<float>(size);
    }
  }

  void requireSaneLight(const Light& light, const std::string& label) const {
    const bool colorOk = light.color.x >= 0.0f && light.color.y >= 0.0f && light.color.z >= 0.0f &&
                         std::isfinite(light.color.x + light.color.y + light.color.z);
    const bool coneOk =
        light.innerConeAngle >= 0.0f && light.innerConeAngle < light.outerConeAngle && light.outerConeAngle <= 1.5707964f;
    if (!colorOk || !coneOk || !(light.intensity >= 0.0f) || !std::isfinite(light.intensity) || !(light.range > 0.0f))
      throw inputError(where_, label + " has a colour, intensity, range or cone out of range", "export it again");
  }

  const tinygltf::Model& model_;
  const std::filesystem::path path_;
  const std::string where_;
  GltfAccessors accessors_;
  Warnings warnings_;
  std::vector<bool> reached_;
  bool quantized_ = false;
  Scene scene_;
  std::vector<int> ancestors_;    // of the node visited, and it
  std::vector<MeshNodes> meshes_;
};

}  // namespace

Scene readGltfScene(std::span<const std::uint8_t> bytes, const std::filesystem::path& path, const WarningHandler& warn) {
  ImageBytes images;
  const tinygltf::Model model = parse(bytes, path, images);
  return SceneReader(model, std::move(images), path, warn).take();
}

}  // namespace chiaro
