#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "assets/error.h"
#include "assets/scene/mesh_file.h"
#include "assets/scene/openmesh_stream.h"

namespace chiaro {
namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

/// Words of each line that holds any, comments left out.
class Lines {
 public:
  Lines(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

  const std::vector<std::string_view>& next() {
    words_.clear();
    while (words_.empty()) {
      if (text_.empty()) throw fail("ends too early");
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++number_;
      line = line.substr(0, line.find('#'));
      for (std::size_t i = 0; i < line.size();) {
        while (i < line.size() && isSpace(line[i])) ++i;
        const std::size_t start = i;
        while (i < line.size() && !isSpace(line[i])) ++i;
        if (i > start) words_.push_back(line.substr(start, i - start));
      }
    }
    return words_;
  }

  Error fail(const std::string& problem) const {
    return inputError(where_ + ":" + std::to_string(number_), problem, "export the mesh again");
  }

  template <class Number>
  Number number(std::size_t word) const {
    Number value{};
    const bool missing = word >= words_.size();
    const std::string_view text = missing ? std::string_view() : words_[word];
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (missing || parsed.ec != std::errc() || parsed.ptr != text.data() + text.size())
      throw fail(missing ? "has too few numbers" : "\"" + std::string(text) + "\" is not a number it can use");
    return value;
  }

  std::size_t bytesLeft() const { return text_.size(); }

 private:
  std::string_view text_;
  std::string where_;
  std::vector<std::string_view> words_;
  int number_ = 0;
};

}  // namespace

void readOff(std::span<const std::uint8_t> bytes, const std::string& where, MeshImporter& importer) {
  Lines lines(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), where);
  auto words = lines.next();
  std::string_view kind = words[0];
  const auto has = [&](std::string_view prefix) {
    const bool found = kind.substr(0, prefix.size()) == prefix;
    if (found) kind.remove_prefix(prefix.size());
    return found;
  };
  const bool texcoords = has("ST");
  has("C");  // colours are ignored
  const bool normals = has("N");
  if (kind != "OFF" || (words.size() > 1 && words[1] == "BINARY"))
    throw inputError(where, "is not a text OFF file with 3D positions", "export the mesh as plain OFF or PLY");
  std::size_t first = 1;  // the counts may follow on the same line
  if (words.size() == 1) {
    words = lines.next();
    first = 0;
  }
  const auto vertexCount = lines.number<std::uint32_t>(first);
  const auto faceCount = lines.number<std::uint32_t>(first + 1);
  if (vertexCount > lines.bytesLeft() / 6 || faceCount > lines.bytesLeft() / 2)
    throw inputError(where,
                     "is truncated: " + std::to_string(vertexCount) + " vertices and " + std::to_string(faceCount) +
                         " faces do not fit into it",
                     "export the mesh again");

  // OpenMesh's text reader takes a face line's colour for the next face; it gets positions and indices only.
  std::string plain = "OFF\n" + std::to_string(vertexCount) + " " + std::to_string(faceCount) + " 0\n";
  std::vector<glm::vec3> vertexNormals;
  std::vector<glm::vec2> vertexTexcoords;
  for (std::uint32_t i = 0; i < vertexCount; ++i) {
    words = lines.next();
    for (std::size_t c = 0; c < 3; ++c) {
      if (!std::isfinite(lines.number<float>(c))) throw lines.fail("a position is not finite");
      plain.append(words[c]).append(c < 2 ? " " : "\n");
    }
    if (normals) vertexNormals.emplace_back(lines.number<float>(3), lines.number<float>(4), lines.number<float>(5));
    if (texcoords) vertexTexcoords.emplace_back(lines.number<float>(words.size() - 2), lines.number<float>(words.size() - 1));
  }
  for (std::uint32_t i = 0; i < faceCount; ++i) {
    words = lines.next();
    const auto corners = lines.number<std::uint32_t>(0);
    if (corners >= words.size()) throw lines.fail("a face has too few vertices");
    plain.append(words[0]);
    for (std::size_t c = 1; c <= corners; ++c) {
      if (lines.number<std::uint32_t>(c) >= vertexCount)
        throw lines.fail("a face names vertex " + std::string(words[c]) + " of " + std::to_string(vertexCount));
      plain.append(" ").append(words[c]);
    }
    plain.append("\n");
  }
  runReader(OpenMesh::IO::OFFReader(), std::move(plain), OpenMesh::IO::Options::Default, StreamChecks::strict, where, importer);
  for (std::size_t i = 0; i < vertexNormals.size(); ++i)
    importer.set_normal(OpenMesh::VertexHandle(static_cast<int>(i)),
                        OpenMesh::Vec3f(vertexNormals[i].x, vertexNormals[i].y, vertexNormals[i].z));
  for (std::size_t i = 0; i < vertexTexcoords.size(); ++i)
    importer.set_texcoord(OpenMesh::VertexHandle(static_cast<int>(i)),
                          OpenMesh::Vec2f(vertexTexcoords[i].x, vertexTexcoords[i].y));
}

}  // namespace chiaro
