#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <charconv>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include "assets/error.h"
#include "assets/scene/mesh_file.h"
#include "assets/scene/openmesh_stream.h"

namespace chiaro {
namespace {

constexpr std::size_t kLongestHeader = 1u << 16;

struct Property {
  bool isList = false;
  std::string countType, type, name;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format;
  std::vector<Element> elements;
  std::size_t size = 0;  // in bytes, with the line end after end_header
};

const std::map<std::string, std::size_t>& typeSizes() {
  static const std::map<std::string, std::size_t> kSizes{
      {"char", 1}, {"uchar", 1}, {"int8", 1},  {"uint8", 1},  {"short", 2}, {"ushort", 2},  {"int16", 2},  {"uint16", 2},
      {"int", 4},  {"uint", 4},  {"int32", 4}, {"uint32", 4}, {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  return kSizes;
}

/// The names that every version of OpenMesh's reader knows.
std::string commonCountType(const std::string& type) {
  const std::size_t size = typeSizes().at(type);
  return size == 1 ? "uint8" : size == 2 ? "uint16" : "int";
}

std::string commonName(const std::string& name) {
  if (name == "texture_u" || name == "s") return "u";
  if (name == "texture_v" || name == "t") return "v";
  return name;
}

Header parseHeader(std::string_view text, const std::string& where) {
  const auto fail = [&](const std::string& problem) {
    return inputError(where, "its PLY header " + problem, "export the mesh again");
  };
  Header header;
  std::size_t offset = 0;
  for (int lineNumber = 0;; ++lineNumber) {
    const std::size_t end = text.substr(0, kLongestHeader).find('\n', offset);
    if (end == std::string_view::npos) throw fail("has no end");
    std::istringstream line{std::string(text.substr(offset, end - offset))};
    offset = end + 1;
    std::string keyword;
    line >> keyword;
    if (lineNumber == 0) {
      if (keyword != "ply" && keyword != "PLY") throw fail("is missing (the file does not start with \"ply\")");
    } else if (keyword == "format") {
      line >> header.format;
    } else if (keyword == "element") {
      Element element;
      std::string count;
      line >> element.name >> count;
      const auto parsed = std::from_chars(count.data(), count.data() + count.size(), element.count);
      if (parsed.ec != std::errc() || parsed.ptr != count.data() + count.size() || count.empty())
        throw fail("has a malformed element count \"" + count + "\"");
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) throw fail("has a property before its first element");
      Property property;
      line >> property.type;
      if (property.type == "list") {
        property.isList = true;
        line >> property.countType >> property.type;
        if (typeSizes().count(property.countType) == 0 || property.countType[0] == 'f' || property.countType[0] == 'd')
          throw fail("has a list counted by \"" + property.countType + "\"");
      }
      line >> property.name;
      if (typeSizes().count(property.type) == 0) throw fail("has an unknown type \"" + property.type + "\"");
      header.elements.back().properties.push_back(std::move(property));
    } else if (keyword == "end_header") {
      header.size = offset;
      return header;
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      throw fail("has an unknown line \"" + keyword + "\"");
    }
  }
}

bool isFloat(const Property& property) { return property.type[0] == 'f' || property.type[0] == 'd'; }
bool isVertexIndices(const Property& property) { return property.name == "vertex_index" || property.name == "vertex_indices"; }

/// Refuses what OpenMesh's reader would silently read wrong.
void requireReadable(const Header& header, std::size_t bodySize, const std::string& where) {
  const auto fail = [&](const std::string& problem) {
    return inputError(where, problem, "export the mesh again, as plain triangles");
  };
  if (header.format != "ascii" && header.format != "binary_little_endian" && header.format != "binary_big_endian")
    throw fail("has an unknown PLY format \"" + header.format + "\"");
  bool sawVertices = false, sawFaces = false;
  std::uint64_t smallest = 0;
  for (const auto& element : header.elements) {
    const bool isFace = element.name == "face", isVertex = element.name == "vertex";
    if ((isVertex && sawVertices) || (isFace && !sawVertices)) throw fail("its faces come before its vertices");
    std::uint64_t size = 0;
    bool sawIndices = false;
    int coordinates = 0;
    for (const auto& property : element.properties) {
      const bool ascii = header.format == "ascii";
      size += ascii ? 1 : typeSizes().at(property.isList ? property.countType : property.type);
      if (property.isList) {
        if (!isFace || !isVertexIndices(property))
          throw fail("has a list \"" + property.name + "\" in its " + element.name + " element, which is not supported");
        if (isFloat(property)) throw fail("has vertex indices of type " + property.type);
        sawIndices = true;
      } else if (isVertex && (property.name == "x" || property.name == "y" || property.name == "z")) {
        if (!ascii && !isFloat(property)) throw fail("has positions of type " + property.type + ", which is not supported");
        ++coordinates;
      }
    }
    if (isVertex && coordinates != 3) throw fail("has no x, y and z for its vertices");
    if (isFace && !sawIndices) throw fail("has faces without vertex indices");
    if (isFace && !isVertexIndices(element.properties.front()))
      throw fail("has face properties before the vertex indices, which is not supported");
    // Bounds the memory that a corrupt count could ask for.
    if (size > 0 && element.count > (bodySize - std::min<std::uint64_t>(smallest, bodySize)) / size)
      throw fail("is truncated: " + std::to_string(element.count) + " \"" + element.name + "\" elements do not fit into it");
    smallest += element.count * size;
    sawVertices = sawVertices || isVertex;
    if (isFace) {
      sawFaces = true;
      break;  // nothing behind the faces is read
    }
  }
  if (!sawVertices) throw fail("has no vertices");
  if (!sawFaces) throw fail("has no faces");
}

std::string canonicalHeader(const Header& header) {
  std::string out = "ply\nformat " + header.format + " 1.0\n";
  for (const auto& element : header.elements) {
    out += "element " + element.name + " " + std::to_string(element.count) + "\n";
    for (const auto& property : element.properties) {
      out += "property ";
      if (property.isList) out += "list " + commonCountType(property.countType) + " ";
      out += property.type + " ";
      // Names outside vertices mean nothing to us, and a repeated keyword as a name must not confuse the reader.
      out += element.name == "vertex" ? commonName(property.name) : property.isList ? "vertex_indices" : "unused";
      out += "\n";
    }
    if (element.name == "face") break;
  }
  return out + "end_header\n";
}

}  // namespace

void readPly(std::span<const std::uint8_t> bytes, const std::string& where, Warnings& warnings, MeshImporter& importer) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const Header header = parseHeader(text, where);
  const std::string_view body = text.substr(header.size);
  requireReadable(header, body.size(), where);
  for (const auto& element : header.elements)
    for (const auto& property : element.properties)
      if (element.name == "vertex" && property.name == "red") warnings.say("vertex colours are ignored");

  OpenMesh::IO::Options options = OpenMesh::IO::Options::VertexNormal;
  options += OpenMesh::IO::Options::VertexTexCoord;
  std::string content = canonicalHeader(header);
  content += body;
  runReader(OpenMesh::IO::PLYReader(), std::move(content), options, StreamChecks::strict, where, importer);
}

}  // namespace chiaro
