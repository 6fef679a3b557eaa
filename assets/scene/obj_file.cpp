#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <string_view>
#include <unordered_map>

#include "assets/error.h"
#include "assets/scene/mesh_file.h"
#include "assets/scene/obj_material.h"
#include "assets/scene/openmesh_stream.h"
#include "assets/scene/primitive_normals.h"

namespace chiaro {
namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view takeWord(std::string_view& text) {
  text = trimmed(text);
  std::size_t end = 0;
  while (end < text.size() && !isSpace(text[end])) ++end;
  const auto word = text.substr(0, end);
  text.remove_prefix(end);
  return word;
}

template <class Number>
bool parse(std::string_view text, Number& value) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && result.ec == std::errc() && result.ptr == text.data() + text.size();
}

/// What OpenMesh's reader may safely be given: statements it understands, all numbers finite, all indices in range. It drops
/// bad vertices silently (shifting every later index) and reads freed memory on a corner without a vertex.
class ObjCheck {
 public:
  ObjCheck(std::string_view file, std::string where) : where_(std::move(where)) {
    countVertices(file);
    positions_ = texcoords_ = normals_ = 0;
    forEachLine(file, [&](std::string_view line) { statement(line); });
  }

  std::string text;                        ///< the statements, one a line
  std::vector<std::string> libraries;      ///< mtllib
  std::vector<std::string> materialNames;  ///< by number; 0 is none
  std::vector<int> materialOfFace;         ///< a number for each face statement that OpenMesh will add

 private:
  template <class Action>
  void forEachLine(std::string_view all, Action action) {
    line_ = 0;
    std::string joined;
    while (!all.empty()) {
      const std::size_t end = std::min(all.find('\n'), all.size());
      std::string_view line = trimmed(all.substr(0, end));
      all.remove_prefix(std::min(end + 1, all.size()));
      ++line_;
      if (!line.empty() && line.back() == '\\') {
        joined.append(line.substr(0, line.size() - 1)).append(" ");
        continue;
      }
      if (!joined.empty()) {
        joined.append(line);
        action(trimmed(joined));
        joined.clear();
      } else if (!line.empty()) {
        action(line);
      }
    }
    if (!joined.empty()) action(trimmed(joined));
  }

  Error fail(const std::string& problem) const {
    return inputError(where_ + ":" + std::to_string(line_), problem, "export the mesh again");
  }

  void countVertices(std::string_view all) {
    forEachLine(all, [&](std::string_view line) {
      const auto keyword = takeWord(line);
      positions_ += keyword == "v";
      texcoords_ += keyword == "vt";
      normals_ += keyword == "vn";
    });
    allPositions_ = positions_;
    allTexcoords_ = texcoords_;
    allNormals_ = normals_;
    if (allPositions_ > 0x7FFFFFFF) throw fail("has more than 2^31 vertices");
  }

  void statement(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const auto keyword = takeWord(line);
    if (keyword == "v") {
      ++positions_;
      numbers("v", line, 3);
    } else if (keyword == "vt") {
      ++texcoords_;
      textureCoordinate(line);
    } else if (keyword == "vn") {
      ++normals_;
      numbers("vn", line, 3);
    } else if (keyword == "f") {
      face(line);
    } else if (keyword == "usemtl") {
      material_ = numberOf(std::string(trimmed(line)));
    } else if (keyword == "mtllib") {
      libraries.emplace_back(trimmed(line));
    }
  }

  void numbers(const char* keyword, std::string_view line, int count) {
    text += keyword;
    for (int i = 0; i < count; ++i) {
      const auto word = takeWord(line);
      float value = 0.0f;
      if (!parse(word, value) || !std::isfinite(value))
        throw fail("\"" + std::string(keyword) + "\" is not followed by " + std::to_string(count) + " finite numbers");
      text.append(" ").append(word);
    }
    text += '\n';
  }

  void textureCoordinate(std::string_view line) {
    // The second coordinate may be left out (it is then 0).
    std::string padded(line);
    std::string_view rest = line;
    takeWord(rest);
    if (trimmed(rest).empty()) padded += " 0";
    numbers("vt", padded, 2);
  }

  /// 1-based; negative counts back from the last one read.
  long resolve(std::string_view word, long soFar, long all, const char* kind) const {
    long index = 0;
    if (!parse(word, index)) throw fail("\"" + std::string(word) + "\" is not an index");
    if (index < 0) index += soFar + 1;
    if (index < 1 || index > all)
      throw fail(std::string("a face names ") + kind + " " + std::string(word) + ", but there are only " + std::to_string(all));
    return index;
  }

  void face(std::string_view line) {
    text += 'f';
    std::vector<long> distinct;
    while (!trimmed(line).empty()) {
      const auto corner = takeWord(line);
      const std::size_t slash = corner.find('/');
      const long vertex = resolve(corner.substr(0, slash), positions_, allPositions_, "vertex");
      if (std::find(distinct.begin(), distinct.end(), vertex) == distinct.end()) distinct.push_back(vertex);
      text.append(" ").append(std::to_string(vertex));
      if (slash == std::string_view::npos) continue;
      const auto rest = corner.substr(slash + 1);
      const auto texcoord = rest.substr(0, rest.find('/'));
      const auto normal = rest.find('/') == std::string_view::npos ? std::string_view() : rest.substr(rest.find('/') + 1);
      text += '/';
      if (!texcoord.empty()) text += std::to_string(resolve(texcoord, texcoords_, allTexcoords_, "texture coordinate"));
      if (!normal.empty()) text.append("/").append(std::to_string(resolve(normal, normals_, allNormals_, "normal")));
    }
    text += '\n';
    // OpenMesh leaves out repeated vertices, and then polygons without three of them.
    if (distinct.size() >= 3) materialOfFace.push_back(material_);
  }

  int numberOf(const std::string& name) {
    const auto found = std::find(materialNames.begin(), materialNames.end(), name);
    const auto number = static_cast<int>(found - materialNames.begin()) + 1;
    if (found == materialNames.end()) materialNames.push_back(name);
    return number;
  }

  std::string where_;
  long line_ = 0;
  long positions_ = 0, texcoords_ = 0, normals_ = 0;
  long allPositions_ = 0, allTexcoords_ = 0, allNormals_ = 0;
  int material_ = 0;
};

struct CornerKey {
  std::uint32_t vertex;
  glm::vec2 texcoord;
  glm::vec3 normal;

  bool operator==(const CornerKey& other) const {
    return vertex == other.vertex && texcoord == other.texcoord && normal == other.normal;
  }
};

struct CornerHash {
  std::size_t operator()(const CornerKey& key) const {
    std::size_t hash = key.vertex;
    for (const float value : {key.texcoord.x, key.texcoord.y, key.normal.x, key.normal.y, key.normal.z})
      hash = hash * 0x9E3779B97F4A7C15ull + std::hash<float>{}(value);
    return hash ^ (hash >> 29);
  }
};

/// Vertices of one material's triangles: one for each distinct corner, in order of first use.
Primitive gather(const MeshImporter& importer, const std::vector<std::size_t>& triangles) {
  bool anyTexcoord = false, allNormals = true;
  for (const auto t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      anyTexcoord = anyTexcoord || importer.corners()[3 * t + k].hasTexcoord;
      allNormals = allNormals && importer.corners()[3 * t + k].hasNormal;
    }
  Primitive out;
  std::unordered_map<CornerKey, std::uint32_t, CornerHash> known;
  for (const auto t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& corner = importer.corners()[3 * t + k];
      const CornerKey key{corner.vertex, corner.texcoord, allNormals ? corner.normal : glm::vec3(0.0f)};
      const auto [found, fresh] = known.emplace(key, static_cast<std::uint32_t>(out.positions.size()));
      if (fresh) {
        out.positions.push_back(importer.positions()[corner.vertex]);
        if (allNormals) out.normals.push_back(corner.normal);
        if (anyTexcoord) out.texcoords.emplace_back(corner.texcoord.x, 1.0f - corner.texcoord.y);
      }
      out.indices.push_back(found->second);
    }
  return out;
}

}  // namespace

Scene readObjScene(std::span<const std::uint8_t> bytes, const std::filesystem::path& path, Warnings& warnings) {
  const std::string where = path.string();
  ObjCheck check(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), where);
  MeshImporter importer(where);
  importer.attributesPerCorner = true;
  OpenMesh::IO::Options options = OpenMesh::IO::Options::VertexNormal;
  options += OpenMesh::IO::Options::VertexTexCoord;
  runReader(OpenMesh::IO::OBJReader(), std::move(check.text), options, StreamChecks::lenient, where, importer);
  if (importer.polygons() != check.materialOfFace.size())
    throw inputError(where, "some of its faces could not be read", "export the mesh again");

  Scene scene;
  std::map<std::string, int> byName;
  for (const auto& library : check.libraries) {
    std::error_code error;
    const auto file = path.parent_path() / library;
    if (std::filesystem::is_regular_file(file, error))
      readMaterialLibrary(file, warnings, scene, byName);
    else
      warnings.say("its material library " + library + " does not exist: the default material is used");
  }

  std::map<int, std::vector<std::size_t>> trianglesOf;
  for (std::size_t t = 0; t < importer.polygonOfTriangle().size(); ++t)
    trianglesOf[check.materialOfFace[importer.polygonOfTriangle()[t]]].push_back(t);
  int defaultMaterial = kNone;
  const std::string name = path.stem().string();
  for (const auto& [number, triangles] : trianglesOf) {
    const std::string material = number == 0 ? "" : check.materialNames[static_cast<std::size_t>(number - 1)];
    Primitive primitive = gather(importer, triangles);
    primitive.name = material.empty() ? name : name + "/" + material;
    if (const auto found = byName.find(material); found != byName.end()) {
      primitive.material = found->second;
    } else {
      if (!material.empty() && !byName.empty())
        warnings.say("material " + material + " is not in its library: the default material is used");
      if (defaultMaterial == kNone) {
        defaultMaterial = static_cast<int>(scene.materials.size());
        scene.materials.push_back(defaultMeshMaterial());
      }
      primitive.material = defaultMaterial;
    }
    if (const auto replaced = normalizeNormals(primitive); replaced != 0)
      warnings.say(std::to_string(replaced) + " normals of zero length are computed from the triangles");
    scene.primitives.push_back(std::move(primitive));
  }
  if (!scene.primitives.empty()) scene.meshNames.push_back(name);
  return scene;
}

}  // namespace chiaro
