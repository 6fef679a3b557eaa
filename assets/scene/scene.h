#pragma once
/// The scene as every room sees it: triangles in world space with their materials, cameras and lights.
///
/// Frames and units: metres, radians, +Y up, right-handed (glTF 2.0). Colours are linear Rec.709. Node transforms are
/// applied on load, because the transfer of a static scene is tied to where each vertex stands in the world.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "assets/scene/reflectance.h"

namespace chiaro {

inline constexpr int kNone = -1;  ///< "no such texture, material, ..." in every index below

/// An image as its file holds it, so that a baked scene carries the artist's own bytes.
struct EncodedImage {
  std::string name;
  std::string mimeType;             ///< image/png or image/jpeg
  std::vector<std::uint8_t> bytes;
};

enum class Wrap { repeat, mirroredRepeat, clampToEdge };

struct Texture {
  int image = kNone;                ///< index into Scene::images
  Wrap wrapS = Wrap::repeat;
  Wrap wrapT = Wrap::repeat;
  bool nearest = false;             ///< magnification without interpolation
};

/// KHR_texture_transform: scaled, then turned, then moved.
struct TextureTransform {
  glm::vec2 offset{0.0f};
  float rotation = 0.0f;  ///< radians; a positive one turns the coordinates from +U towards -V, the image the other way
  glm::vec2 scale{1.0f};

  bool operator==(const TextureTransform&) const = default;
  glm::mat2 linear() const;  ///< all but the offset
  glm::vec2 operator()(glm::vec2 texcoord) const { return linear() * texcoord + offset; }
};

enum class AlphaMode { opaque, mask, blend };

/// glTF 2.0 metallic-roughness material with KHR_materials_anisotropy, _specular, _ior, _clearcoat, _sheen and CHIARO_materials_reflectance; a texture
/// is an index into Scene::textures and reads TEXCOORD_0 through the transform beside it. Colour textures are sRGB-encoded, the others linear.
struct Material {
  std::string name;
  glm::vec4 baseColorFactor{1.0f};
  int baseColorTexture = kNone;
  TextureTransform baseColorTransform;
  float metallicFactor = 1.0f;
  float roughnessFactor = 1.0f;          ///< perceptual roughness; alpha = roughness^2
  int metallicRoughnessTexture = kNone;  ///< G roughness, B metallic
  TextureTransform metallicRoughnessTransform;
  int normalTexture = kNone;             ///< tangent space, +Y up (OpenGL)
  TextureTransform normalTransform;
  float normalScale = 1.0f;
  int occlusionTexture = kNone;          ///< carried through; unused, as the transfer knows the occlusion itself
  TextureTransform occlusionTransform;
  float occlusionStrength = 1.0f;
  glm::vec3 emissiveFactor{0.0f};        ///< times KHR_materials_emissive_strength
  int emissiveTexture = kNone;
  TextureTransform emissiveTransform;
  AlphaMode alphaMode = AlphaMode::opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  float anisotropyStrength = 0.0f;       ///< 0..1: alpha along the rotated tangent is mix(alpha, 1, strength^2)
  float anisotropyRotation = 0.0f;       ///< radians, counter-clockwise from the tangent
  int anisotropyTexture = kNone;         ///< RG direction in [-1,1], B strength
  TextureTransform anisotropyTransform;

  float ior = 1.5f;                      ///< at least 1; 0 stands for infinity
  float specularFactor = 1.0f;           ///< 0..1, of a dielectric's F0 and F90
  int specularTexture = kNone;           ///< A
  TextureTransform specularTransform;
  glm::vec3 specularColorFactor{1.0f};   ///< of a dielectric's F0; may exceed 1
  int specularColorTexture = kNone;      ///< RGB
  TextureTransform specularColorTransform;
  float clearcoatFactor = 0.0f;          ///< 0..1: a second GGX layer of F0 .04 on the mesh's own normal
  int clearcoatTexture = kNone;          ///< R
  TextureTransform clearcoatTransform;
  float clearcoatRoughness = 0.0f;       ///< perceptual
  int clearcoatRoughnessTexture = kNone; ///< G
  TextureTransform clearcoatRoughnessTransform;
  glm::vec3 sheenColorFactor{0.0f};      ///< 0..1: fuzz over the base, under the coat; 0 is none
  int sheenColorTexture = kNone;         ///< RGB
  TextureTransform sheenColorTransform;
  float sheenRoughness = 0.0f;           ///< perceptual
  int sheenRoughnessTexture = kNone;     ///< A
  TextureTransform sheenRoughnessTransform;

  Reflectance reflectance = Reflectance::ggx;
  std::optional<glm::vec2> reflectanceWidth;  ///< along tangent and bitangent, widths or exponents; absent: see reflectanceAlpha()
  std::optional<glm::vec3> reflectanceF0;     ///< 0..1, instead of the metallic-roughness F0
};

/// The widths along tangent and bitangent, before any texture, as alpha whatever the model calls them (alphaFromExponent): of
/// `reflectanceWidth`, else roughness^2 with the anisotropy's stretch. A roughness texture multiplies both by G^2.
glm::vec2 reflectanceAlpha(const Material& material);
/// F0 of a dielectric of this index of refraction, KHR_materials_ior.
float dielectricF0(float ior);

/// One draw: an indexed triangle list with one material. Attribute arrays are empty or as long as `positions`.
struct Primitive {
  std::string name;
  int mesh = 0;                            ///< primitives of one source mesh instance share this number (Scene::meshNames)
  int material = kNone;                    ///< index into Scene::materials; kNone is the glTF default material
  std::vector<glm::vec3> positions;        ///< world space, metres
  std::vector<glm::vec3> normals;          ///< unit, world space
  std::vector<glm::vec4> tangents;         ///< xyz unit, world space; w = +-1 handedness: bitangent = cross(n, t) * w
  std::vector<glm::vec2> texcoords;        ///< TEXCOORD_0, (0,0) top left of the image
  std::vector<std::uint32_t> indices;      ///< 3 per triangle, counter-clockwise from the front

  std::size_t triangleCount() const { return indices.size() / 3; }
};

struct Camera {
  std::string name;
  glm::mat4 worldFromCamera{1.0f};  ///< rigid; looks along its -Z, +Y up
  bool perspective = true;
  float verticalFov = 0.8f;         ///< radians (perspective)
  float verticalExtent = 1.0f;      ///< half the height of the view, metres (orthographic)
  float nearPlane = 0.01f;
  float farPlane = 1000.0f;
};

enum class LightType { directional, point, spot, sphere, disk };

/// KHR_lights_punctual, and with CHIARO_lights_area (docs/format.md) lights that have a size. All are seen in reflections only.
///  * directional: a disc of uniform radiance on the sky, of angular radius `angle`; 0 is a direction.
///  * sphere: a point with a radius. From outside its irradiance is a point's at every distance; from inside it shines all around.
///  * disk: faces `direction`, radiance intensity / (pi radius^2) towards the directions that the cones let through, nothing behind. Lambert's
///    cosine makes it weaker off its axis, which KHR's spot is not, down to a radius of 0.
struct Light {
  std::string name;
  LightType type = LightType::directional;
  glm::vec3 color{1.0f};
  float intensity = 1.0f;                 ///< lux on a surface that faces it (directional), candela (others; spot and disk: on the axis)
  float range = std::numeric_limits<float>::infinity();
  float innerConeAngle = 0.0f;            ///< radians (spot, disk)
  float outerConeAngle = 0.785398163f;
  float radius = 0.0f;                    ///< metres (sphere, disk)
  float angle = 0.0f;                     ///< radians, 0 .. pi/2 (directional)
  glm::vec3 position{0.0f};
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< the way the light travels, unit
};

/// How a mesh moves as a rigid body: keys that take it from where the scene has it, a rotation about the origin and then a shift.
struct RigidMotion {
  int mesh = 0;                      ///< of Scene::meshNames
  std::vector<float> times;          ///< seconds, rising, at least one
  std::vector<glm::quat> rotations;  ///< unit, each within half a turn of the one before
  std::vector<glm::vec3> shifts;     ///< metres
};

struct Scene {
  std::vector<std::string> meshNames;
  std::vector<Primitive> primitives;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<EncodedImage> images;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<RigidMotion> motions;  ///< at most one a mesh; played by posesAt()

  std::size_t vertexCount() const;
  std::size_t triangleCount() const;
};

/// The material a primitive without one gets (glTF 2.0, 3.9.6).
const Material& materialOf(const Scene& scene, const Primitive& primitive);

struct Bounds {
  glm::vec3 lower{std::numeric_limits<float>::infinity()};
  glm::vec3 upper{-std::numeric_limits<float>::infinity()};

  bool empty() const { return !(lower.x <= upper.x); }
  void include(glm::vec3 p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
  glm::vec3 center() const { return 0.5f * (lower + upper); }
  float diagonal() const { return empty() ? 0.0f : glm::length(upper - lower); }
};

/// Of all vertices that a triangle uses.
Bounds boundsOf(const Scene& scene);

/// The scene's first camera; without one, a three-quarter view from above that holds the whole scene in a frame of the
/// given width over height.
Camera defaultCamera(const Scene& scene, float aspect);

/// A perspective camera at `eye` that looks at `target` with +Y up (or +Z when it looks along Y). near and far are set
/// from the scene's bounds.
Camera lookAt(glm::vec3 eye, glm::vec3 target, float verticalFov, const Bounds& bounds);

}  // namespace chiaro
