#include "precompute/report/budget/error_mesh.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "assets/transfer/gltf_writer.h"
#include "precompute/reference/view_ray.h"
#include "precompute/report/metrics/magma.h"

namespace chiaro {
namespace {

constexpr int kNormalizedUnsignedShort = 5123;
constexpr std::uint8_t kNothing = 48;  // grey

std::array<std::uint8_t, 3> colorOf(double error) { return magma(error / kVertexErrorRange); }

/// The colours of a vertex in a glTF file are linear.
std::uint16_t linear16(std::uint8_t encoded) {
  const double x = encoded / 255.0;
  return static_cast<std::uint16_t>(std::lround(65535.0 * (x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4))));
}

std::vector<std::size_t> firstVertices(const Scene& scene) {
  std::vector<std::size_t> first{0};
  for (const auto& primitive : scene.primitives) first.push_back(first.back() + primitive.positions.size());
  return first;
}

/// Its triangles alone, in one material.
Scene bare(const Scene& scene) {
  Scene result;
  result.meshNames = scene.meshNames;
  result.primitives = scene.primitives;
  for (auto& primitive : result.primitives) {
    primitive.tangents.clear();
    primitive.texcoords.clear();
    primitive.material = 0;
  }
  Material material;
  material.name = "error";
  material.metallicFactor = 0.0f;
  material.doubleSided = true;
  result.materials.push_back(material);
  return result;
}

}  // namespace

std::vector<std::uint8_t> errorMesh(const Scene& scene, const VertexErrors& errors, const std::string& generator) {
  const Scene plain = bare(scene);
  const auto order = primitiveOrder(plain);
  GltfWriter writer;
  writer.json["asset"] = {{"version", "2.0"},
                          {"generator", generator},
                          {"extras", {{"colors", "magma of the mean |error| of the visible fraction of lobes at each vertex"}, {"error_at_pale_yellow", kVertexErrorRange}}}};
  const auto places = writeScene(plain, order, writer);
  const auto first = firstVertices(plain);
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::vector<std::uint16_t> colors;
    for (auto v = first[order[i]]; v < first[order[i] + 1]; ++v) {
      for (const auto channel : colorOf(static_cast<double>(errors.error[v]))) colors.push_back(linear16(channel));
      colors.push_back(65535);
    }
    const int view = writer.addArray(colors, "COLOR_0 of primitive " + std::to_string(i), GltfWriter::Target::vertices);
    const int accessor = writer.addAccessor(view, kNormalizedUnsignedShort, "VEC4", colors.size() / 4, true);
    writer.json[places[i]]["attributes"]["COLOR_0"] = accessor;
  }
  writer.json["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
  writer.json["extensionsUsed"].push_back("KHR_materials_unlit");
  writer.json["buffers"] = Json::array({{{"byteLength", (writer.binary().size() + 3) / 4 * 4}}});
  return GltfWriter::container(writer.json.dump(), writer.binary());
}

Image8 errorMeshPicture(const Scene& scene, const RayScene& rays, const VertexErrors& errors, const Camera& camera, glm::ivec2 size) {
  const auto first = firstVertices(scene);
  Image8 image{size.x, size.y, {}};
  image.texels.reserve(4 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const auto ray = reference::viewRay(camera, static_cast<double>(size.x) / size.y, (glm::dvec2(x, y) + 0.5) / glm::dvec2(size));
      RayHit hit;
      if (!rays.intersect(ray.origin, ray.direction, ray.near, ray.far, hit)) {
        image.texels.insert(image.texels.end(), {kNothing, kNothing, kNothing, 255});
        continue;
      }
      const auto* corners = &scene.primitives[hit.primitive].indices[3 * static_cast<std::size_t>(hit.triangle)];
      const auto at = [&](std::size_t c) { return static_cast<double>(errors.error[first[hit.primitive] + corners[c]]); };
      const double u = static_cast<double>(hit.barycentric.x), v = static_cast<double>(hit.barycentric.y);
      const double facing = std::abs(static_cast<double>(glm::dot(hit.geometricNormal, ray.direction)));
      for (const auto channel : colorOf((1.0 - u - v) * at(0) + u * at(1) + v * at(2))) image.texels.push_back(static_cast<std::uint8_t>(std::lround(channel * (0.6 + 0.4 * facing))));
      image.texels.push_back(255);
    }
  return image;
}

Camera cameraBefore(const WorstVertex& vertex, const Scene& scene, const RayScene& rays) {
  const auto bounds = boundsOf(scene);
  float distance = 0.125f * bounds.diagonal();
  const auto start = vertex.position + rays.surfaceOffset(vertex.position) * vertex.normal;
  RayHit hit;
  if (rays.intersect(start, vertex.normal, 0.0f, distance, hit)) distance = 0.9f * hit.distance;
  return lookAt(vertex.position + std::max(distance, 1e-3f * bounds.diagonal()) * vertex.normal, vertex.position, 0.8f, bounds);
}

}  // namespace chiaro
