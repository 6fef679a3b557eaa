#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/transfer/coded_lists.h"
#include "assets/transfer/gltf_writer.h"
#include "assets/transfer/transfer.h"
#include "assets/transfer/transfer_format.h"

namespace chiaro {
namespace {

constexpr int kShort = 5122, kUnsignedByte = 5121;
constexpr std::uint64_t kLargestGlb = 0xFFFFFFFFu;

/// Everything a reader will check, so that a bug shows before the file exists.
class FitCheck {
 public:
  FitCheck(const BakedScene& baked, std::string where)
      : scene_(baked.scene), transfer_(baked.transfer), coded_(baked.coded), where_(std::move(where)) {}

  void run() const {
    require(scene_.primitives.size() == transfer_.primitives.size(), "the transfer has other primitives than the scene");
    require(!scene_.primitives.empty(), "the scene is empty");
    checkShared();
    for (std::size_t i = 0; i < scene_.primitives.size(); ++i) checkPrimitive(i);
    require(!coded_ || holds(*coded_, transfer_), "its coded lists are not those of its transfer");
    const auto inRange = [](int index, std::size_t count) {
      return index == kNone || (index >= 0 && static_cast<std::size_t>(index) < count);
    };
    for (const auto& texture : scene_.textures)
      require(inRange(texture.image, scene_.images.size()), "a texture names an image that does not exist");
    for (const auto& m : scene_.materials)
      for (const int texture : {m.baseColorTexture, m.metallicRoughnessTexture, m.normalTexture, m.occlusionTexture,
                                m.emissiveTexture, m.anisotropyTexture, m.specularTexture, m.specularColorTexture, m.clearcoatTexture,
                                m.clearcoatRoughnessTexture, m.sheenColorTexture, m.sheenRoughnessTexture})
        require(inRange(texture, scene_.textures.size()), "material " + m.name + " names a texture that does not exist");
    for (const auto& image : scene_.images) require(!image.bytes.empty(), "image " + image.name + " is empty");
  }

 private:
  void require(bool ok, const std::string& problem) const {
    if (!ok) throw Error(ExitCode::failed, where_, "cannot be written: " + problem, "this is a bug, please report it");
  }

  void checkShared() const {
    const auto& t = transfer_;
    const auto texels = static_cast<std::size_t>(std::max(t.resolution, 0)) * static_cast<std::size_t>(std::max(t.resolution, 0));
    require(t.resolution >= 0 && t.resolution <= kMostTransferResolution, "the resolution is out of range");
    require(t.terms >= 0 && t.terms <= kMostTransferTerms, "the number of terms is out of range");
    require(t.directionCount >= 0 && t.directionCount <= kMostTransferDirections && t.directionCount % 4 == 0,
            "the number of directions is out of range or not a multiple of 4");
    require(t.directions.size() == static_cast<std::size_t>(t.directionCount), "the directions are not as many as they say");
    require(std::isfinite(t.directionSharpness) && t.directionSharpness >= 0.0f, "the direction sharpness is out of range");
    for (const auto& d : t.directions) require(std::abs(glm::length(d) - 1.0f) <= 1e-3f, "a direction is not unit");
    if (!t.clustered.empty()) {
      checkClustered();
      return;
    }
    require(t.clustered.levels.empty(), "there are levels without clusters");
    require(t.mean.size() == texels || (t.mean.empty() && t.terms == 0), "the mean has the wrong size");
    require(t.eigenfunctions.size() == texels * static_cast<std::size_t>(t.terms), "the eigenfunctions have the wrong size");
    require(t.weightScale.size() == static_cast<std::size_t>(t.terms), "the weight scales have the wrong size");
    require(t.terms == 0 || t.resolution > 0, "there are terms without a resolution");
    for (const float v : t.mean) require(std::isfinite(v), "the mean is not finite");
    for (const float v : t.eigenfunctions) require(std::abs(v) <= 65504.0f, "an eigenfunction is not finite as a half");
    for (const float v : t.weightScale) require(v > 0.0f && std::isfinite(v), "a weight scale is not positive and finite");
  }

  void checkClustered() const {
    const auto& t = transfer_;
    const auto& c = t.clustered;
    require(t.resolution > 0, "there are clusters without a resolution");
    require(c.levels.size() <= kMostTransferLevels, "there are too many levels");
    for (const auto& level : c.levels)
      require(level.resolution > 0 && level.resolution <= kMostTransferResolution && std::isfinite(level.sharpness) && level.sharpness > 0.0f,
              "a level is out of range");
    for (std::size_t l = 1; l < c.levels.size(); ++l) require(c.levels[l].sharpness > c.levels[l - 1].sharpness, "the levels do not get sharper");
    require(isGeometric(c.levels), "the levels are not spaced evenly");
    require(t.mean.size() == t.columns(), "the mean has the wrong size");
    for (const float v : t.mean) require(std::isfinite(v), "the mean is not finite");
    require(t.eigenfunctions.empty() && t.weightScale.empty(), "there are global components beside clusters");
    require(c.weightBits == 8 || c.weightBits == 16, "weights are neither 8 nor 16 bits");
    require(c.ssdfSoftness >= 0.0f && std::isfinite(c.ssdfSoftness), "the SSDF's softness is not a number above 0");
    require(c.mapScales.empty() || c.mapScales.size() == mapsOf(c), "the map scales have the wrong size");
    for (const float v : c.mapScales) require(v > 0.0f && std::isfinite(v), "a map scale is not positive and finite");
    require(c.functions.columnScale == columnScales(t), "the functions' column scales are not those of the maps");
    require(c.clusters.size() <= kMostTransferClusters && c.functions.count() <= kMostTransferFunctions, "there are too many clusters or functions");
    std::size_t bytes = 0;
    require(c.functions.scale.size() == c.functions.count(), "the function scales have the wrong size");
    for (std::size_t f = 0; f < c.functions.count(); ++f) {
      require(isFunctionKind(c.functions.bits[f]), "a function has an unknown number of bits");
      require(std::isfinite(c.functions.scale[f]) && c.functions.scale[f] > 0.0f, "a function scale is not positive and finite");
      bytes += PackedFunctions::bytesOf(c.functions.bits[f], t.columns());
    }
    require(c.functions.data.size() == bytes, "the functions have the wrong size");
    require(c.functions.inRange(t.columns()), "a function has a value out of range");
    for (const float v : c.functions.unpack(t.columns())) require(std::isfinite(v), "a function is not finite");
    for (const auto& cluster : c.clusters) {
      require(cluster.terms >= 0 && cluster.terms <= t.terms, "a cluster has too many terms");
      require(cluster.terms == 0 || c.functions.count() > 0, "a cluster has terms without functions");
      require(cluster.mean.size() == c.functions.count() && cluster.components.size() == c.functions.count() * static_cast<std::size_t>(cluster.terms) &&
                  cluster.weightScale.size() == static_cast<std::size_t>(cluster.terms),
              "a cluster has the wrong size");
      require(std::isfinite(cluster.meanScale) && cluster.meanScale >= 0.0f, "a cluster's mean is not finite");
      for (const float v : cluster.weightScale) require(v > 0.0f && std::isfinite(v), "a weight scale is not positive and finite");
      for (const auto q : cluster.mean) require(q >= -32767, "a cluster's mean is out of range");
      for (const auto q : cluster.components) require(q >= -127, "a component is out of range");
    }
  }

  void checkClusteredVertices(const ClusteredVertices& v, std::size_t count, const std::string& label) const {
    const auto& c = transfer_.clustered;
    require(v.cluster.size() == count, label + " does not have one cluster a vertex");
    for (const auto cluster : v.cluster) require(cluster < c.clusters.size(), label + " names a cluster that does not exist");
    require(v.weights.size() == v.firstWeights(c.clusters).back(), label + " has the wrong number of weights");
    const int most = c.weightBits == 8 ? 127 : 32767;
    for (const auto q : v.weights) require(std::abs(static_cast<int>(q)) <= most, label + " has a weight out of range");
  }

  void checkPrimitive(std::size_t index) const {
    const auto& p = scene_.primitives[index];
    const auto& t = transfer_.primitives[index];
    const std::string label = "primitive " + std::to_string(index) + " (" + p.name + ")";
    const std::size_t count = p.positions.size();
    require(count > 0 && !p.indices.empty() && p.indices.size() % 3 == 0, label + " has no triangles");
    require(p.normals.size() == count, label + " does not have one normal a vertex");
    require(p.tangents.empty() || p.tangents.size() == count, label + " does not have one tangent a vertex");
    require(p.texcoords.empty() || p.texcoords.size() == count, label + " does not have one texture coordinate a vertex");
    require(p.mesh >= 0 && static_cast<std::size_t>(p.mesh) < scene_.meshNames.size(),
            label + " names a mesh that does not exist");
    require(p.material == kNone || (p.material >= 0 && static_cast<std::size_t>(p.material) < scene_.materials.size()),
            label + " names a material that does not exist");
    for (const auto i : p.indices) require(i < count, label + " has an index out of range");
    for (const auto& v : p.positions)
      require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), label + " has a position that is not finite");
    for (const auto& v : p.normals) require(std::abs(glm::length(v) - 1.0f) <= 1e-3f, label + " has a normal that is not unit");
    for (const auto& v : p.tangents)
      require(std::abs(glm::length(glm::vec3(v)) - 1.0f) <= 1e-3f && std::abs(v.w) == 1.0f,
              label + " has a tangent that is not unit");
    for (const auto& v : p.texcoords)
      require(std::isfinite(v.x) && std::isfinite(v.y), label + " has a texture coordinate that is not finite");
    const auto padded = static_cast<std::size_t>(transfer_.paddedTerms());
    if (!transfer_.clustered.empty()) checkClusteredVertices(t.clustered, count, label);
    require(t.weights.size() == count * padded, label + " has the wrong number of weights");
    require(t.visibility.size() == count * static_cast<std::size_t>(transfer_.directionCount),
            label + " has the wrong number of visible fractions");
    for (std::size_t v = 0; padded > 0 && v < count; ++v)
      for (std::size_t k = static_cast<std::size_t>(transfer_.terms); k < padded; ++k)
        require(t.weights[v * padded + k] == 0, label + " has weights that are not 0 behind the last term");
  }

  const Scene& scene_;
  const Transfer& transfer_;
  const std::optional<CodedLists>& coded_;
  std::string where_;
};

/// More than the file will take, found before it is put together.
std::uint64_t upperBound(const BakedScene& baked, const CodedLists& coded) {
  const auto& t = baked.transfer;
  std::uint64_t size = std::uint64_t{1} << 20;
  const auto perVertex = static_cast<std::uint64_t>(2 * t.paddedTerms() + t.directionCount + 48);
  for (const auto& p : baked.scene.primitives) size += p.positions.size() * perVertex + p.indices.size() * 4 + 4096;
  for (const auto& image : baked.scene.images) size += image.bytes.size() + 1024;
  for (const auto& c : t.clustered.clusters) size += 6 + 4 * c.weightScale.size();
  return size + coded.bytes() + 5 * t.clustered.functions.count() + t.mean.size() * 4 + t.eigenfunctions.size() * 2;
}

/// Columns 4g..4g+3 of a row-major matrix.
template <class T>
std::vector<T> columnsOf4(const std::vector<T>& rows, std::size_t width, std::size_t group) {
  std::vector<T> out;
  const std::size_t count = rows.size() / width;
  out.reserve(4 * count);
  for (std::size_t v = 0; v < count; ++v) {
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(v * width + 4 * group);
    out.insert(out.end(), first, first + 4);
  }
  return out;
}

void addVertexTransfer(const Transfer& transfer, const PrimitiveTransfer& values, std::size_t vertexCount,
                       const Json::json_pointer& place, GltfWriter& writer) {
  const auto add = [&](const std::string& name, const auto& rows, std::size_t width, int componentType) {
    for (std::size_t g = 0; 4 * g < width; ++g) {
      const std::string attribute = name + std::to_string(g);
      const int view =
          writer.addArray(columnsOf4(rows, width, g), attribute + " of " + place.to_string(), GltfWriter::Target::vertices);
      writer.json[place]["attributes"][attribute] = writer.addAccessor(view, componentType, "VEC4", vertexCount, true);
    }
  };
  add("_SSDF_", values.weights, static_cast<std::size_t>(transfer.paddedTerms()), kShort);
  if (!transfer.fractionsInRow()) add("_VISIBILITY_", values.visibility, static_cast<std::size_t>(transfer.directionCount), kUnsignedByte);
}

Json clusteredOf(const BakedScene& baked, const CodedLists& coded, const std::vector<std::size_t>& order, GltfWriter& writer) {
  const auto& c = baked.transfer.clustered;
  Json out = Json::object();
  out["levels"] = Json::array();
  for (const auto& level : c.levels) out["levels"].push_back({{"sharpness", level.sharpness}, {"resolution", level.resolution}});
  if (!c.mapScales.empty()) out["mapScales"] = c.mapScales;
  if (c.ssdfSoftness > 0.0f) out["ssdfSoftness"] = c.ssdfSoftness;
  out["functionCount"] = c.functions.count();
  if (c.functions.count() > 0) {
    out["functionBits"] = writer.addArray(c.functions.bits, "function bits");
    out["functionScales"] = writer.addArray(c.functions.scale, "function scales");
    out["functions"] = writer.addArray(coded.functions, "functions");
  }
  std::vector<std::uint16_t> terms;
  std::vector<float> meanScales, weightScales;
  for (const auto& cluster : c.clusters) {
    terms.push_back(static_cast<std::uint16_t>(cluster.terms));
    meanScales.push_back(cluster.meanScale);
    weightScales.insert(weightScales.end(), cluster.weightScale.begin(), cluster.weightScale.end());
  }
  out["clusterCount"] = c.clusters.size();
  out["clusterTerms"] = writer.addArray(terms, "cluster terms");
  if (c.functions.count() > 0) {
    out["clusterMeanScales"] = writer.addArray(meanScales, "cluster mean scales");
    out["clusterMeans"] = writer.addArray(coded.means, "cluster means");
  }
  if (!weightScales.empty()) {
    out["weightScales"] = writer.addArray(weightScales, "weight scales");
    out["components"] = writer.addArray(coded.components, "components");
  }
  out["weightBits"] = c.weightBits;
  out["primitives"] = Json::array();
  for (const auto p : order) {
    const std::string of = " of primitive " + std::to_string(out["primitives"].size());
    Json primitive = {{"clusters", writer.addArray(coded.clusters[p], "clusters" + of)}};
    if (!coded.weights[p].empty()) primitive["weights"] = writer.addArray(coded.weights[p], "weights" + of);
    out["primitives"].push_back(primitive);
  }
  return out;
}

Json extensionOf(const BakedScene& baked, const CodedLists& coded, const std::vector<std::size_t>& order, GltfWriter& writer) {
  const Transfer& transfer = baked.transfer;
  Json out = Json::object();
  out["version"] = kTransferVersion;
  out["parameterization"] = kTransferParameterization;
  out["resolution"] = transfer.resolution;
  out["terms"] = transfer.terms;
  out["directionCount"] = transfer.directionCount;
  out["directionSharpness"] = transfer.directionSharpness;
  if (!transfer.directions.empty()) out["directions"] = writer.addArray(transfer.directions, "directions");
  if (!transfer.mean.empty()) out["mean"] = writer.addArray(transfer.mean, "mean");
  if (!transfer.clustered.empty()) {
    out["clustered"] = clusteredOf(baked, coded, order, writer);
  } else if (transfer.terms > 0) {
    std::vector<std::uint16_t> halves;
    halves.reserve(transfer.eigenfunctions.size());
    for (const float value : transfer.eigenfunctions) halves.push_back(Imath::half(value).bits());
    out["eigenfunctions"] = writer.addArray(halves, "eigenfunctions");
    out["weightScales"] = writer.addArray(transfer.weightScale, "weight scales");
  }
  out["facts"] = Json::object();
  // JSON has no NaN and no infinity; null reads back as NaN.
  for (const auto& [name, value] : baked.facts) out["facts"][name] = std::isfinite(value) ? Json(value) : Json(nullptr);
  out["checksums"] = writer.checksums();
  out["jsonChecksum"] = kNoChecksum;
  return out;
}

/// The JSON text with its own checksum filled in. Padding belongs to the chunk, so it is summed too.
std::string signedJson(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize(aligned4(text.size()), ' ');
  const std::string sum = checksumOf(std::string_view(text));
  const std::size_t place = text.find(jsonChecksumMember(kNoChecksum));
  return text.replace(place, jsonChecksumMember(sum).size(), jsonChecksumMember(sum));
}

}  // namespace

void writeBakedScene(const std::filesystem::path& path, const BakedScene& baked, const std::string& generator) {
  const std::string where = path.string();
  FitCheck(baked, where).run();
  std::optional<CodedLists> made;
  if (!baked.coded) made = codedLists(baked.transfer);
  const CodedLists& coded = made ? *made : *baked.coded;
  if (upperBound(baked, coded) > kLargestGlb)
    throw Error(ExitCode::failed, where, "the baked scene is larger than 4 GiB, which a .glb cannot hold",
                "bake fewer terms or split the scene");

  GltfWriter writer;
  writer.json["asset"] = {{"version", "2.0"}, {"generator", generator}};
  writer.json["extensionsUsed"] = {kTransferExtension};
  const auto order = primitiveOrder(baked.scene);
  const auto places = writeScene(baked.scene, order, writer);
  for (std::size_t i = 0; i < order.size(); ++i)
    addVertexTransfer(baked.transfer, baked.transfer.primitives[order[i]], baked.scene.primitives[order[i]].positions.size(),
                      places[i], writer);
  writer.json["extensions"][kTransferExtension] = extensionOf(baked, coded, order, writer);
  writer.json["buffers"] = Json::array({{{"byteLength", aligned4(writer.binary().size())}}});
  writeFileAtomically(path, GltfWriter::container(signedJson(writer.json), writer.binary()));
}

}  // namespace chiaro
