#include "assets/scene/mesh_file.h"
#include "assets/scene/primitive_normals.h"

namespace chiaro {

Material defaultMeshMaterial() {
  Material material;
  material.name = "default";
  material.baseColorFactor = glm::vec4(0.8f, 0.8f, 0.8f, 1.0f);
  material.metallicFactor = 0.0f;
  material.roughnessFactor = 0.5f;
  return material;
}

Scene sceneFromMesh(MeshImporter& importer, const std::string& name, Warnings& warnings) {
  Primitive primitive;
  primitive.name = name;
  primitive.material = 0;
  primitive.positions = importer.positions();
  primitive.normals = std::move(importer.normals());
  primitive.texcoords = std::move(importer.texcoords());
  // glTF counts rows of the image from the top, these formats from the bottom.
  for (auto& texcoord : primitive.texcoords) texcoord.y = 1.0f - texcoord.y;
  primitive.indices.reserve(importer.corners().size());
  for (const auto& corner : importer.corners()) primitive.indices.push_back(corner.vertex);
  if (importer.smallPolygons() != 0)
    warnings.say(std::to_string(importer.smallPolygons()) + " faces with fewer than three vertices are left out");
  if (const auto replaced = normalizeNormals(primitive); replaced != 0)
    warnings.say(std::to_string(replaced) + " normals of zero length are computed from the triangles");

  Scene scene;
  scene.meshNames.push_back(name);
  scene.materials.push_back(defaultMeshMaterial());
  scene.primitives.push_back(std::move(primitive));
  return scene;
}

}  // namespace chiaro
