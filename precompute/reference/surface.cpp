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

SurfaceReader::SurfaceReader(const Scene& scene, bool energyCompensation) : scene_(&scene), energyCompensation_(energyCompensation) {
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
    decode(material.specularTexture, TextureEncoding::linear);
    decode(material.specularColorTexture, TextureEncoding::srgb);
    decode(material.clearcoatTexture, TextureEncoding::linear);
    decode(material.clearcoatRoughnessTexture, TextureEncoding::linear);
    decode(material.sheenColorTexture, TextureEncoding::srgb);
    decode(material.sheenRoughnessTexture, TextureEncoding::linear);
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

  readBrdf(material, texcoord, anisotropy, surface);
  surface.brdf.coatNormal = shadingNormalTowards(surface.interpolatedNormal, wo) * surface.worldFromTangent;
  const glm::dvec3 local = wo * surface.worldFromTangent;
  if (surface.brdf.sheen != glm::dvec3(0.0)) surface.brdf.sheenAlbedo = sheenAlbedo(surface.brdf.sheenAlpha, std::max(local.z, 1e-3));
  if (energyCompensation_) surface.brdf.gain = multipleScatteringGain(surface.brdf, local);
  surface.emission = glm::dvec3(material.emissiveFactor) *
                     glm::dvec3(lookUp(material.emissiveTexture, material.emissiveTransform, TextureEncoding::srgb, texcoord)) *
                     (1.0 - coatWeight(surface.brdf, local));
  return surface;
}

void SurfaceReader::readBrdf(const Material& material, glm::vec2 texcoord, double anisotropy, Surface& surface) const {
  const auto read = [&](int texture, const TextureTransform& transform, TextureEncoding encoding) {
    return lookUp(texture, transform, encoding, texcoord);
  };
  const glm::dvec4 baseColor =
      glm::dvec4(material.baseColorFactor) * read(material.baseColorTexture, material.baseColorTransform, TextureEncoding::srgb);
  const glm::dvec4 metallicRoughness = read(material.metallicRoughnessTexture, material.metallicRoughnessTransform, TextureEncoding::linear);
  const double metallic = static_cast<double>(material.metallicFactor) * metallicRoughness.z;
  Brdf& brdf = surface.brdf;
  brdf.model = material.reflectance;

  glm::dvec2 alpha(0.0);
  if (material.reflectanceWidth) {
    alpha = glm::dvec2(*material.reflectanceWidth);
    if (hasExponent(material.reflectance)) alpha = glm::sqrt(2.0 / (alpha + 2.0));
    alpha *= metallicRoughness.y * metallicRoughness.y;
  } else {
    const double roughness = static_cast<double>(material.roughnessFactor) * metallicRoughness.y;
    alpha = glm::dvec2(roughness * roughness);
    if (!isRound(material.reflectance)) alpha.x = std::lerp(std::max(alpha.y, kMinAlpha), 1.0, anisotropy * anisotropy);
  }
  brdf.alphaX = std::clamp(alpha.x, kMinAlpha, 1.0);
  brdf.alphaY = std::clamp(alpha.y, kMinAlpha, 1.0);

  const double specular = static_cast<double>(material.specularFactor) *
                          read(material.specularTexture, material.specularTransform, TextureEncoding::linear).w;
  const double ior = static_cast<double>(material.ior);
  const double atNormal = ior == 0.0 ? 1.0 : (ior - 1.0) * (ior - 1.0) / ((ior + 1.0) * (ior + 1.0));
  const glm::dvec3 tint = glm::dvec3(material.specularColorFactor) *
                          glm::dvec3(read(material.specularColorTexture, material.specularColorTransform, TextureEncoding::srgb));
  brdf.diffuse = glm::dvec3(baseColor) * (1.0 - metallic);
  brdf.f0 = glm::mix(glm::min(atNormal * tint, 1.0) * specular, glm::dvec3(baseColor), metallic);
  brdf.f90 = glm::dvec3(std::lerp(specular, 1.0, metallic));
  if (material.reflectanceF0) {
    brdf.f0 = glm::dvec3(*material.reflectanceF0);
    brdf.f90 = glm::dvec3(1.0);
  }

  if (material.sheenColorFactor != glm::vec3(0.0f)) {
    brdf.sheen = glm::dvec3(material.sheenColorFactor) *
                 glm::dvec3(read(material.sheenColorTexture, material.sheenColorTransform, TextureEncoding::srgb));
    const double roughness = static_cast<double>(material.sheenRoughness) *
                             read(material.sheenRoughnessTexture, material.sheenRoughnessTransform, TextureEncoding::linear).w;
    brdf.sheenAlpha = std::clamp(roughness * roughness, kMinSheenAlpha, 1.0);
  }
  if (material.clearcoatFactor > 0.0f) {
    brdf.coat = static_cast<double>(material.clearcoatFactor) *
                read(material.clearcoatTexture, material.clearcoatTransform, TextureEncoding::linear).x;
    const double roughness = static_cast<double>(material.clearcoatRoughness) *
                             read(material.clearcoatRoughnessTexture, material.clearcoatRoughnessTransform, TextureEncoding::linear).y;
    brdf.coatAlpha = std::clamp(roughness * roughness, kMinAlpha, 1.0);
  }
  if (material.alphaMode == AlphaMode::blend) surface.opacity = std::clamp(baseColor.w, 0.0, 1.0);
}

}  // namespace chiaro::reference
