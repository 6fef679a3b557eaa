#include "assets/scene/vertex_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/scene/load_scene.h"
#include "assets/scene/triangle.h"

namespace chiaro {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are read as they lie in the file");

using Place = std::array<float, 3>;
Place placeOf(glm::vec3 p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }  // -0 is 0

}  // namespace

VertexCache::VertexCache(const Scene& scene, const VertexCacheFiles& files) {
  readRest(files.rest);
  readFrames(files.frames);
  find(scene, files.rest.string());
}

void VertexCache::readRest(const std::filesystem::path& file) {
  const std::string kind = lowerCaseExtension(file);
  if (kind != ".ply" && kind != ".off") throw inputError(file.string(), "keeps no order of vertices when it is read", "give a .ply or .off file");
  const Scene mesh = loadScene(file);
  if (mesh.primitives.size() != 1)
    throw inputError(file.string(), "has " + std::to_string(mesh.primitives.size()) + " meshes, so that its vertices have no order", "give a file of one mesh");
  rest_ = mesh.primitives.front().positions;
}

void VertexCache::readFrames(const std::filesystem::path& file) {
  const auto bytes = readFile(file);
  const std::size_t frame = rest_.size() * sizeof(glm::vec3);
  if (bytes.empty() || bytes.size() % frame != 0)
    throw inputError(file.string(), std::to_string(bytes.size()) + " bytes are no whole frames of " + std::to_string(rest_.size()) + " vertices (" + std::to_string(frame) + " each)",
                     "give the frames of that very mesh");
  frameCount_ = bytes.size() / frame;
  frames_.resize(frameCount_ * rest_.size());
  std::memcpy(frames_.data(), bytes.data(), bytes.size());
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(frames_[i][c]))
        throw inputError(file.string(), "vertex " + std::to_string(i % rest_.size()) + " of frame " + std::to_string(i / rest_.size()) + " is not finite", "write it again");
    bounds_.include(frames_[i]);
  }
}

void VertexCache::find(const Scene& scene, const std::string& where) {
  std::map<Place, std::uint32_t> first;
  for (std::uint32_t v = 0; v < rest_.size(); ++v) first.try_emplace(placeOf(rest_[v]), v);
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    Part part{p, {}, {}, scene.primitives[p].indices};
    std::size_t missing = 0;
    for (const auto& position : scene.primitives[p].positions) {
      const auto found = first.find(placeOf(position));
      missing += found == first.end();
      part.vertices.push_back(found == first.end() ? 0 : found->second);
    }
    if (missing == part.vertices.size()) continue;
    if (missing > 0)
      throw inputError(where, std::to_string(missing) + " of " + std::to_string(part.vertices.size()) + " baked vertices are none of it", "bake that file, without --refine");
    std::map<std::pair<std::uint32_t, Place>, std::uint32_t> smooth;
    for (std::uint32_t v = 0; v < part.vertices.size(); ++v)
      part.smooth.push_back(smooth.try_emplace({part.vertices[v], placeOf(scene.primitives[p].normals[v])}, v).first->second);
    parts_.push_back(std::move(part));
  }
  if (parts_.empty()) throw inputError(where, "none of its vertices is in the baked scene", "give the mesh file that was baked");
}

std::vector<glm::vec3> VertexCache::normalsOf(const Part& part, const std::vector<glm::vec3>& positions) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0.0));
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return positions[part.indices[i + k % 3]]; };
    const glm::dvec3 normal = triangleNormal(at(0), at(1), at(2));
    for (std::size_t k = 0; k < 3; ++k) sums[part.smooth[part.indices[i + k]]] += normal * cornerAngle(at(k), at(k + 1), at(k + 2));
  }
  std::vector<glm::vec3> normals;
  for (const std::uint32_t first : part.smooth) {
    const double length = glm::length(sums[first]);
    normals.push_back(length > 0.0 ? glm::vec3(sums[first] / length) : glm::vec3(0, 1, 0));
  }
  return normals;
}

std::vector<PrimitiveShape> VertexCache::at(double frame) const {
  const double last = static_cast<double>(frameCount_ - 1);
  double t = last > 0.0 ? std::fmod(std::abs(frame), 2.0 * last) : 0.0;
  if (t > last) t = 2.0 * last - t;
  const std::size_t a = static_cast<std::size_t>(t), b = std::min(a + 1, frameCount_ - 1);
  const float share = static_cast<float>(t - static_cast<double>(a));
  std::vector<glm::vec3> positions(rest_.size());
  for (std::size_t v = 0; v < rest_.size(); ++v) positions[v] = glm::mix(frames_[a * rest_.size() + v], frames_[b * rest_.size() + v], share);
  std::vector<PrimitiveShape> shapes;
  for (const auto& part : parts_) {
    PrimitiveShape shape{part.primitive, {}, {}};
    for (const std::uint32_t v : part.vertices) shape.positions.push_back(positions[v]);
    shape.normals = normalsOf(part, shape.positions);
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace chiaro
