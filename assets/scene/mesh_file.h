#pragma once
/// PLY, OFF, STL and OBJ. OpenMesh's readers trust their input, so each format first has its header and sizes checked and
/// brought into the one form its reader is known to read well.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "assets/scene/mesh_importer.h"
#include "assets/scene/warnings.h"

namespace chiaro {

/// What a mesh without materials is made of: base colour .8, roughness .5, not metallic.
Material defaultMeshMaterial();

/// Each fills the importer from a whole file. Throws Error (unreadableInput).
void readPly(std::span<const std::uint8_t> bytes, const std::string& where, Warnings& warnings, MeshImporter& importer);
void readOff(std::span<const std::uint8_t> bytes, const std::string& where, MeshImporter& importer);
void readStl(std::span<const std::uint8_t> bytes, const std::string& where, MeshImporter& importer);

/// A Scene of one mesh made of what the importer holds, with the default material.
Scene sceneFromMesh(MeshImporter& importer, const std::string& name, Warnings& warnings);

/// OBJ with its materials: one primitive per material.
Scene readObjScene(std::span<const std::uint8_t> bytes, const std::filesystem::path& path, Warnings& warnings);

}  // namespace chiaro
