#include "assets/scene/openmesh_stream.h"

#include <OpenMesh/Core/System/omstream.hh>
#include <sstream>

#include "assets/error.h"

namespace chiaro {
namespace {

/// OpenMesh reports to its own stream, and its readers may leave that disabled when an exception passes through them.
class QuietOpenMesh {
 public:
  QuietOpenMesh() : error_(omerr().is_enabled()), log_(omlog().is_enabled()) {
    omerr().disable();
    omlog().disable();
  }
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;
  ~QuietOpenMesh() {
    if (error_) omerr().enable();
    if (log_) omlog().enable();
  }

 private:
  bool error_, log_;
};

}  // namespace

void runReader(OpenMesh::IO::BaseReader& reader, std::string content, OpenMesh::IO::Options options, StreamChecks checks,
               const std::string& where, MeshImporter& importer) {
  const QuietOpenMesh quiet;
  std::istringstream stream(std::move(content), std::ios::in | std::ios::binary);
  if (checks == StreamChecks::strict) stream.exceptions(std::ios::failbit | std::ios::badbit);
  bool ok = false;
  try {
    ok = reader.read(stream, importer, options);
  } catch (const std::ios_base::failure&) {
    ok = false;
  }
  if (!ok)
    throw inputError(where,
                     "is truncated or malformed after " + std::to_string(importer.n_vertices()) + " vertices and " +
                         std::to_string(importer.n_faces()) + " faces",
                     "export the mesh again");
}

}  // namespace chiaro
