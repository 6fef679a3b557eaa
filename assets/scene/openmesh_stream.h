#pragma once
/// How this room calls OpenMesh's readers.

#include <OpenMesh/Core/IO/Options.hh>
#include <OpenMesh/Core/IO/reader/BaseReader.hh>
#include <string>

#include "assets/scene/mesh_importer.h"

namespace chiaro {

/// strict: the first malformed or missing value ends the reading (readers loop over counts without looking at their
/// stream). Text readers that end by running into the end of the file cannot be strict.
enum class StreamChecks { strict, lenient };

/// Runs one reader over `content`. Silences its messages. Throws Error (unreadableInput).
void runReader(OpenMesh::IO::BaseReader& reader, std::string content, OpenMesh::IO::Options options, StreamChecks checks,
               const std::string& where, MeshImporter& importer);

}  // namespace chiaro
