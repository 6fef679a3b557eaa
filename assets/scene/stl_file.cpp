#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "assets/error.h"
#include "assets/scene/mesh_file.h"
#include "assets/scene/openmesh_stream.h"

namespace chiaro {
namespace {

constexpr std::size_t kBinaryHeader = 84;
constexpr std::size_t kBinaryTriangle = 50;

/// OpenMesh's text reader takes a malformed number for 0 and a missing triangle for the end.
void requireWholeText(std::string_view text, const std::string& where) {
  const auto fail = [&](int line, const std::string& problem) {
    return inputError(where + ":" + std::to_string(line), problem, "export the mesh again");
  };
  std::istringstream lines{std::string(text)};
  std::string line;
  int number = 0, expected = 0;
  bool ended = false;
  while (std::getline(lines, line)) {
    ++number;
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    for (char& c : keyword) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (keyword == "outer") {
      if (expected != 0) throw fail(number, "a triangle has fewer than three vertices");
      expected = 3;
    } else if (keyword == "vertex") {
      std::string value;
      for (int c = 0; c < 3; ++c) {
        words >> value;
        float parsed = 0.0f;
        const auto result = std::from_chars(value.data(), value.data() + value.size(), parsed);
        if (words.fail() || result.ec != std::errc() || result.ptr != value.data() + value.size() || !std::isfinite(parsed))
          throw fail(number, "a vertex is not three finite numbers");
      }
      if (expected == 0) throw fail(number, "a vertex stands outside a triangle");
      --expected;
    } else if (expected != 0) {
      throw fail(number, "a triangle is not three lines of vertices");
    }
    ended = ended || keyword == "endsolid";
  }
  if (!ended) throw fail(number, "the file is truncated: it has no \"endsolid\"");
}

}  // namespace

void readStl(std::span<const std::uint8_t> bytes, const std::string& where, MeshImporter& importer) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::uint64_t count = 0;
  if (bytes.size() >= kBinaryHeader)
    for (std::size_t i = 0; i < 4; ++i) count |= static_cast<std::uint64_t>(bytes[80 + i]) << (8 * i);
  // Binary files may start with "solid" too, so only the size tells.
  const bool binary = bytes.size() >= kBinaryHeader && bytes.size() == kBinaryHeader + kBinaryTriangle * count;
  OpenMesh::IO::Options options = OpenMesh::IO::Options::Default;
  if (binary) {
    options += OpenMesh::IO::Options::Binary;
  } else if (text.substr(0, 5) == "solid" && text.find("facet") != std::string_view::npos) {
    requireWholeText(text, where);
  } else {
    throw inputError(where,
                     "is neither a text STL file nor a whole binary one (" + std::to_string(count) + " triangles take " +
                         std::to_string(kBinaryHeader + kBinaryTriangle * count) + " bytes, it has " +
                         std::to_string(bytes.size()) + ")",
                     "export the mesh again");
  }
  runReader(OpenMesh::IO::STLReader(), std::string(text), options, binary ? StreamChecks::strict : StreamChecks::lenient, where,
            importer);
}

}  // namespace chiaro
