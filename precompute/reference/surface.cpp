#include "precompute/reference/surface.h"

#include <algorithm>
#include <cmath>

#include "precompute/reference/shading_normal.h"

namespace chiaro::reference {
namespace {

/// Corner values of a triangle weighted by barycentrics.
template <class T>
auto interpolate(const std::vector<T>& values, const std::uint32_t* corner, glm::vec2 barycentric) {
  const double u = static_cast<double>(barycentric.x);
  const double v = static_cast<double>(barycentric.y);
  using Result = glm::vec<T::length(), double, glm::defaultp>;
  return (1.0 - u - v) * Result(values[corner[0]]) + u * Result(values[corner[1]]) + v * Result(values[corner[2]]);
}

/// Normalised, or `fallback` where there is nothing to normalise.
glm::dvec3 directionOr(glm::dvec3 v, glm::dvec3 fallback) {
  const double length = glm::length(v);
  return length > 1e-12 ? v / length : fallback;
}

/// Any unit vector perpendicular to a unit normal.
glm::dvec3 anyPerpendicular(glm::dvec3 normal) {
  const glm::dvec3 axis = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(axis - normal * glm::dot(normal, axis));
}

glm::dvec3 perpendicularPart(glm::dvec3 v, glm::dvec3 normal) {
  return directionOr(v - normal * glm::dot(normal, v), anyPerpendicular(normal));
}

}  // namespace

SurfaceReader::SurfaceReader(const Scene& scene) : scene_(&scene) {
  const auto decode = [&](int texture, TextureEncoding encoding) {
    if (texture == kNone || textures_.contains({texture, encoding})) return;
    textures_.emplace(std::pair(texture, encoding), TextureSampler(scene, texture, encoding));
  };
  for (const Material& material : scene.materials) {
    decode(material.baseColorTexture, TextureEncoding::srgb);
    decode(material.emissiveTexture, TextureEncoding::srgb);
    decode(material.metallicRoughnessTexture, TextureEncoding::linear);
    decode(material.normalTexture, TextureEncoding::linear);
    decode(material.anisotropyTexture, TextureEncoding::linear);
  }
}

glm::dvec4 SurfaceReader::lookUp(int texture, const TextureTransform& transform, TextureEncoding encoding,
                                 glm::vec2 texcoord) const {
  return texture == kNone ? glm::dvec4(1.0) : glm::dvec4(textures_.at({texture, encoding}).at(transform(texcoord)));
}

bool SurfaceReader::isCulled(const RayHit& hit, glm::vec3 direction) const {
  return !materialOf(*scene_, scene_->primitives[hit.primitive]).doubleSided && glm::dot(hit.geometricNormal, direction) > 0.0f;
}

Surface SurfaceReader::at(const RayHit& hit, glm::dvec3 wo) const {
  const Primitive& primitive = scene_->primitives[hit.primitive];
  const Material& material = materialOf(*scene_, primitive);
  const std::uint32_t* corner = &primitive.indices[3 * static_cast<std::size_t>(hit.triangle)];
  const glm::vec2 texcoord = texcoordAt(primitive, hit.triangle, hit.barycentric);

  Surface surface;
  surface.position = interpolate(primitive.positions, corner, hit.barycentric);
  const glm::dvec3 geometricNormal(hit.geometricNormal);
  const bool front = glm::dot(geometricNormal, wo) >= 0.0;
  const double side = front ? 1.0 : -1.0;

  const glm::dvec3 normal = primitive.normals.empty()
                                ? geometricNormal
                                : directionOr(interpolate(primitive.normals, corner, hit.barycentric), geometricNormal);
  glm::dvec3 tangent = anyPerpendicular(normal);
  double handedness = 1.0;
  if (!primitive.tangents.empty()) {
    tangent = perpendicularPart(glm::dvec3(interpolate(primitive.tangents, corner, hit.barycentric)), normal);
    handedness = primitive.tangents[corner[0]].w < 0.0f ? -1.0 : 1.0;
  }
  const glm::dvec3 bitangent = glm::cross(normal, tangent) * handedness;

  glm::dvec3 shadingNormal = normal;
  if (material.normalTexture != kNone) {
    glm::dvec3 mapped =
        2.0 * glm::dvec3(lookUp(material.normalTexture, material.normalTransform, TextureEncoding::linear, texcoord)) - 1.0;
    mapped *= glm::dvec3(material.normalScale, material.normalScale, 1.0);
    shadingNormal = directionOr(mapped.x * tangent + mapped.y * bitangent + mapped.z * normal, normal);
  }

  double anisotropy = static_cast<double>(material.anisotropyStrength);
  glm::dvec2 stretch(1.0, 0.0);
  if (material.anisotropyTexture != kNone) {
    const glm::dvec4 value = lookUp(material.anisotropyTexture, material.anisotropyTransform, TextureEncoding::linear, texcoord);
    stretch = 2.0 * glm::dvec2(value) - 1.0;
    anisotropy *= value.z;
  }
  const double c = std::cos(static_cast<double>(material.anisotropyRotation));
  const double s = std::sin(static_cast<double>(material.anisotropyRotation));
  const glm::dvec3 stretchDirection = (c * stretch.x - s * stretch.y) * tangent + (s * stretch.x + c * stretch.y) * bitangent;

  surface.geometricNormal = side * geometricNormal;
  surface.interpolatedNormal = side * normal;
  const glm::dvec3 seen = shadingNormalTowards(side * shadingNormal, wo);
  const glm::dvec3 along = perpendicularPart(stretchDirection, seen);
  surface.worldFromTangent = glm::dmat3(along, glm::cross(seen, along), seen);

  const glm::dvec4 baseColor = glm::dvec4(material.baseColorFactor) *
                               lookUp(material.baseColorTexture, material.baseColorTransform, TextureEncoding::srgb, texcoord);
  const glm::dvec4 metallicRoughness =
      lookUp(material.metallicRoughnessTexture, material.metallicRoughnessTransform, TextureEncoding::linear, texcoord);
  const double metallic = static_cast<double>(material.metallicFactor) * metallicRoughness.z;
  const double roughness = static_cast<double>(material.roughnessFactor) * metallicRoughness.y;
  const double alpha = std::clamp(roughness * roughness, kMinAlpha, 1.0);
  surface.brdf.diffuse = glm::dvec3(baseColor) * (1.0 - metallic);
  surface.brdf.f0 = glm::mix(glm::dvec3(0.04), glm::dvec3(baseColor), metallic);
  surface.brdf.alphaX = std::lerp(alpha, 1.0, anisotropy * anisotropy);
  surface.brdf.alphaY = alpha;
  surface.emission = glm::dvec3(material.emissiveFactor) *
                     glm::dvec3(lookUp(material.emissiveTexture, material.emissiveTransform, TextureEncoding::srgb, texcoord));
  if (material.alphaMode == AlphaMode::blend) surface.opacity = std::clamp(baseColor.w, 0.0, 1.0);
  return surface;
}

}  // namespace chiaro::reference
