#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "assets/error.h"
#include "assets/file.h"
#include "assets/scene/glb.h"
#include "assets/scene/gltf_scene.h"
#include "assets/transfer/coded_lists.h"
#include "assets/transfer/transfer.h"
#include "assets/transfer/transfer_format.h"

namespace chiaro {
namespace {

using nlohmann::json;

const std::string kBakeAgain = "the file is damaged, bake it again";
constexpr std::int64_t kShort = 5122, kUnsignedByte = 5121;

class BakedReader {
 public:
  BakedReader(std::span<const std::uint8_t> bytes, const std::filesystem::path& path)
      : bytes_(bytes), path_(path), where_(path.string()) {}

  BakedScene read() {
    openContainer();
    findExtension();
    checkJson();
    checkBufferViews();
    readShared();
    baked_.scene = readGltfScene(bytes_, path_, {});
    readVertices();
    return std::move(baked_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw inputError(where_, what, kBakeAgain); }

  [[noreturn]] void failUnbaked() const {
    throw inputError(where_, "has no radiance transfer in it", "run chiaro-precompute on it first and open what that writes");
  }

  // The container and its JSON --------------------------------------------------------------------------------------

  void openContainer() {
    const auto* text = reinterpret_cast<const char*>(bytes_.data());
    const std::string_view head(text, std::min<std::size_t>(bytes_.size(), 64));
    const std::size_t first = head.find_first_not_of(" \t\r\n");
    // A text glTF or a mesh is a likely mistake, and has no transfer in it.
    const bool isText = first != std::string_view::npos && head[first] == '{';
    if (isText || (!startsLikeGlb(bytes_) && path_.extension() != ".glb")) failUnbaked();
    chunks_ = parseGlb(bytes_, where_);
    requireShallowJson(chunks_.json, where_);
    root_ = json::parse(chunks_.json.begin(), chunks_.json.end(), nullptr, false);
    if (root_.is_discarded() || !root_.is_object()) fail("its JSON chunk is malformed");
  }

  const json& member(const json& object, const char* name, const std::string& owner) const {
    if (!object.is_object() || !object.contains(name)) fail(owner + " has no \"" + name + "\"");
    return object[name];
  }

  std::int64_t integer(const json& object, const char* name, std::int64_t lower, std::int64_t upper,
                       const std::string& owner) const {
    const json& value = member(object, name, owner);
    const bool fits = value.is_number_unsigned()
                          ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())
                          : value.is_number_integer();
    if (!fits || value.get<std::int64_t>() < lower || value.get<std::int64_t>() > upper)
      fail("\"" + std::string(name) + "\" of " + owner + " is not an integer from " + std::to_string(lower) + " to " +
           std::to_string(upper));
    return value.get<std::int64_t>();
  }

  std::string text(const json& object, const char* name, const std::string& owner) const {
    const json& value = member(object, name, owner);
    if (!value.is_string()) fail("\"" + std::string(name) + "\" of " + owner + " is not text");
    return value.get<std::string>();
  }

  const json& listOf(const json& object, const char* name, const std::string& owner) const {
    const json& value = member(object, name, owner);
    if (!value.is_array()) fail("\"" + std::string(name) + "\" of " + owner + " is not a list");
    return value;
  }

  void findExtension() {
    if (!root_.contains("extensions") || !root_["extensions"].is_object() || !root_["extensions"].contains(kTransferExtension))
      failUnbaked();
    extension_ = &root_["extensions"][kTransferExtension];
    if (!extension_->is_object()) fail(std::string(kTransferExtension) + " is not an object");
    const std::int64_t version = integer(*extension_, "version", 0, std::numeric_limits<std::int32_t>::max(), kTransferExtension);
    if (version != kTransferVersion)
      throw inputError(
          where_,
          "has transfer version " + std::to_string(version) + ", this program reads version " + std::to_string(kTransferVersion),
          version > kTransferVersion ? "update Chiaro" : "bake it again");
    const std::string parameterization = text(*extension_, "parameterization", kTransferExtension);
    if (parameterization != kTransferParameterization) fail("has the unknown parameterization \"" + parameterization + "\"");
  }

  void checkJson() const {
    const std::string sum = text(*extension_, "jsonChecksum", kTransferExtension);
    std::string copy(chunks_.json);
    const std::string signedMember = jsonChecksumMember(sum);
    const std::size_t place = copy.find(signedMember);
    if (sum.size() != kNoChecksum.size() || place == std::string::npos) fail("its \"jsonChecksum\" is malformed");
    copy.replace(place, signedMember.size(), jsonChecksumMember(kNoChecksum));
    if (checksumOf(std::string_view(copy)) != sum) fail("the checksum of its JSON chunk does not match");
  }

  // Buffer views ----------------------------------------------------------------------------------------------------

  std::string viewLabel(std::size_t index) const {
    const json& view = root_["bufferViews"][index];
    const bool named = view.is_object() && view.contains("name") && view["name"].is_string();
    return "bufferView " + std::to_string(index) + (named ? " (" + view["name"].get<std::string>() + ")" : "");
  }

  /// They tile the binary chunk: each starts where the one before ends, rounded up to 4, and what lies between is 0.
  void checkBufferViews() {
    const json& buffers = listOf(root_, "buffers", "the file");
    const auto size = static_cast<std::int64_t>(chunks_.binary.size());
    if (buffers.size() != 1 || (buffers[0].is_object() && buffers[0].contains("uri"))) fail("has not exactly one buffer inside");
    if (integer(buffers[0], "byteLength", 0, std::numeric_limits<std::int64_t>::max(), "the buffer") != size)
      fail("its buffer and its BIN chunk have different lengths");
    const json& views = listOf(root_, "bufferViews", "the file");
    const json& sums = listOf(*extension_, "checksums", kTransferExtension);
    if (sums.size() != views.size())
      fail("has " + std::to_string(sums.size()) + " checksums for " + std::to_string(views.size()) + " buffer views");
    std::int64_t end = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const std::string label = viewLabel(i);
      const std::int64_t offset = integer(views[i], "byteOffset", 0, size, label);
      const std::int64_t length = integer(views[i], "byteLength", 1, size, label);
      integer(views[i], "buffer", 0, 0, label);
      if (offset != static_cast<std::int64_t>(aligned4(static_cast<std::size_t>(end))) || length > size - offset)
        fail(label + " does not lie where it should");
      if (views[i].contains("byteStride")) fail(label + " has a byte stride");
      requireZeros(end, offset);
      views_.push_back(chunks_.binary.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length)));
      if (!sums[i].is_string() || sums[i].get<std::string>() != checksumOf(views_.back()))
        fail("checksum of " + label + " does not match");
      end = offset + length;
    }
    if (size - end >= 4) fail("its BIN chunk holds bytes that no buffer view names");
    requireZeros(end, size);
  }

  void requireZeros(std::int64_t first, std::int64_t last) const {
    for (std::int64_t i = first; i < last; ++i)
      if (chunks_.binary[static_cast<std::size_t>(i)] != 0)
        fail("its padding at byte " + std::to_string(i) + " of the BIN chunk is not 0");
  }

  /// The elements of a whole buffer view that must hold exactly `count` of them.
  template <class T>
  std::vector<T> elements(std::int64_t view, std::size_t count, const std::string& what) const {
    const auto bytes = views_[static_cast<std::size_t>(view)];
    if (bytes.size() != count * sizeof(T))
      fail(what + " takes " + std::to_string(bytes.size()) + " bytes instead of " + std::to_string(count * sizeof(T)));
    std::vector<T> values(count);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  /// The `size` bytes that a whole buffer view holds as an .xz stream, of which `stream` is a copy.
  std::vector<std::uint8_t> unpacked(std::int64_t view, std::size_t size, const std::string& what, std::vector<std::uint8_t>& stream) const {
    const auto& own = views_[static_cast<std::size_t>(view)];
    auto bytes = unpackXz(own, size);
    if (!bytes) fail(what + " does not unpack to " + std::to_string(size) + " bytes");
    stream.assign(own.begin(), own.end());
    return std::move(*bytes);
  }

  std::int64_t viewIndex(const json& object, const char* name, const std::string& owner) const {
    return integer(object, name, 0, static_cast<std::int64_t>(views_.size()) - 1, owner);
  }

  // What all vertices share -----------------------------------------------------------------------------------------

  void requireFinite(const std::vector<float>& values, const std::string& what) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!std::isfinite(values[i])) fail(what + " is not finite at element " + std::to_string(i));
  }

  void readShared() {
    Transfer& t = baked_.transfer;
    const json& e = *extension_;
    t.terms = static_cast<int>(integer(e, "terms", 0, kMostTransferTerms, kTransferExtension));
    t.resolution = static_cast<int>(integer(e, "resolution", t.terms > 0 ? 1 : 0, kMostTransferResolution, kTransferExtension));
    t.directionCount = static_cast<int>(integer(e, "directionCount", 0, kMostTransferDirections, kTransferExtension));
    if (t.directionCount % 4 != 0) fail("\"directionCount\" is not a multiple of 4");
    const json& sharpness = member(e, "directionSharpness", kTransferExtension);
    t.directionSharpness = sharpness.is_number() ? sharpness.get<float>() : -1.0f;
    if (!(t.directionSharpness >= 0.0f) || !std::isfinite(t.directionSharpness))
      fail("\"directionSharpness\" is not a number from 0");
    readDirections();
    if (e.contains("clustered")) {
      readClustered(e["clustered"]);
      readFacts();
      return;
    }
    const auto texels = static_cast<std::size_t>(t.resolution) * static_cast<std::size_t>(t.resolution);
    if (t.terms > 0 || e.contains("mean")) t.mean = elements<float>(viewIndex(e, "mean", kTransferExtension), texels, "the mean");
    requireFinite(t.mean, "the mean");
    if (t.terms > 0) readEigenfunctions(texels);
    readFacts();
  }

  void readDirections() {
    Transfer& t = baked_.transfer;
    if (t.directionCount == 0) return;
    t.directions = elements<glm::vec3>(viewIndex(*extension_, "directions", kTransferExtension),
                                       static_cast<std::size_t>(t.directionCount), "the list of directions");
    for (const auto& d : t.directions) {
      const float error = std::abs(glm::length(d) - 1.0f);
      if (!(error <= 1e-3f)) fail("one of its directions is not a unit vector");
    }
  }

  void readEigenfunctions(std::size_t texels) {
    Transfer& t = baked_.transfer;
    const auto terms = static_cast<std::size_t>(t.terms);
    const auto halves = elements<std::uint16_t>(viewIndex(*extension_, "eigenfunctions", kTransferExtension), terms * texels,
                                                "the eigenfunctions' list");
    t.eigenfunctions.reserve(halves.size());
    for (const auto bits : halves) {
      Imath::half value;
      value.setBits(bits);
      t.eigenfunctions.push_back(value);
    }
    requireFinite(t.eigenfunctions, "the list of eigenfunctions");
    t.weightScale =
        elements<float>(viewIndex(*extension_, "weightScales", kTransferExtension), terms, "the list of weight scales");
    requireFinite(t.weightScale, "the list of weight scales");
    for (const float scale : t.weightScale)
      if (!(scale > 0.0f)) fail("a weight scale is not positive");
  }

  void readClustered(const json& c) {
    Transfer& t = baked_.transfer;
    auto& out = t.clustered;
    const std::string owner = "\"clustered\"";
    baked_.coded.emplace();
    if (t.resolution < 1) fail("\"resolution\" of clustered transfer is not positive");
    const json& levels = listOf(c, "levels", owner);
    if (levels.size() > kMostTransferLevels) fail("has more than " + std::to_string(kMostTransferLevels) + " levels");
    for (const auto& level : levels) {
      const auto& sharpness = member(level, "sharpness", "a level");
      const float value = sharpness.is_number() ? sharpness.get<float>() : -1.0f;
      if (!(value > (out.levels.empty() ? 0.0f : out.levels.back().sharpness)) || !std::isfinite(value)) fail("its levels do not get sharper");
      out.levels.push_back({value, static_cast<int>(integer(level, "resolution", 1, kMostTransferResolution, "a level"))});
    }
    if (!isGeometric(out.levels)) fail("its levels are not spaced evenly");
    const auto columns = t.columns();
    t.mean = elements<float>(viewIndex(*extension_, "mean", kTransferExtension), columns, "the mean");
    requireFinite(t.mean, "the mean");
    readMapScales(c, owner);
    readFunctions(c, columns, owner);
    readClusters(c, owner);
    listOf(c, "primitives", owner);
  }

  void readMapScales(const json& c, const std::string& owner) {
    auto& out = baked_.transfer.clustered;
    if (c.contains("ssdfSoftness")) {
      const auto& softness = c["ssdfSoftness"];
      out.ssdfSoftness = softness.is_number() ? softness.get<float>() : -1.0f;
      if (!(out.ssdfSoftness > 0.0f) || !std::isfinite(out.ssdfSoftness)) fail("\"ssdfSoftness\" is not a number above 0");
    }
    if (!c.contains("mapScales")) return;
    const json& scales = listOf(c, "mapScales", owner);
    if (scales.size() != mapsOf(out))
      fail("has " + std::to_string(scales.size()) + " map scales for " + std::to_string(mapsOf(out)) + " maps");
    for (const json& scale : scales) {
      out.mapScales.push_back(scale.is_number() ? scale.get<float>() : 0.0f);
      if (!(out.mapScales.back() > 0.0f) || !std::isfinite(out.mapScales.back())) fail("a map scale is not positive and finite");
    }
    out.functions.columnScale = columnScales(baked_.transfer);
  }

  void readFunctions(const json& c, std::size_t columns, const std::string& owner) {
    auto& f = baked_.transfer.clustered.functions;
    const auto count = static_cast<std::size_t>(integer(c, "functionCount", 0, static_cast<std::int64_t>(kMostTransferFunctions), owner));
    if (count == 0) return;
    f.bits = elements<std::uint8_t>(viewIndex(c, "functionBits", owner), count, "the list of function bits");
    f.scale = elements<float>(viewIndex(c, "functionScales", owner), count, "the list of function scales");
    requireFinite(f.scale, "the list of function scales");
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!isFunctionKind(f.bits[i])) fail("a function has " + std::to_string(f.bits[i]) + " bits a value");
      if (!(f.scale[i] > 0.0f)) fail("a function scale is not positive");
      bytes += PackedFunctions::bytesOf(f.bits[i], columns);
    }
    f.data = unpacked(viewIndex(c, "functions", owner), bytes, "the list of functions", baked_.coded->functions);
    if (!f.inRange(columns)) fail("a function has a value out of range");
    requireFinite(f.unpack(columns), "the list of functions");
  }

  void readClusters(const json& c, const std::string& owner) {
    Transfer& t = baked_.transfer;
    auto& out = t.clustered;
    const auto count = static_cast<std::size_t>(integer(c, "clusterCount", 1, static_cast<std::int64_t>(kMostTransferClusters), owner));
    const auto functions = out.functions.count();
    out.weightBits = static_cast<int>(integer(c, "weightBits", 8, 16, owner));
    if (out.weightBits != 8 && out.weightBits != 16) fail("\"weightBits\" is neither 8 nor 16");
    const auto terms = elements<std::uint16_t>(viewIndex(c, "clusterTerms", owner), count, "the list of cluster terms");
    std::size_t all = 0;
    for (const auto k : terms) {
      if (k > t.terms) fail("a cluster has more terms than \"terms\"");
      all += k;
    }
    if (t.terms != *std::max_element(terms.begin(), terms.end())) fail("\"terms\" is not the largest number of a cluster's terms");
    std::vector<float> meanScales(count, 0.0f), weightScales;
    std::vector<std::int16_t> means;
    std::vector<std::uint8_t> components;
    if (functions > 0) {
      meanScales = elements<float>(viewIndex(c, "clusterMeanScales", owner), count, "the list of mean scales");
      requireFinite(meanScales, "the list of mean scales");
      means = valuesOfPlanes(unpacked(viewIndex(c, "clusterMeans", owner), 2 * count * functions, "the list of cluster means", baked_.coded->means), 2);
    } else if (all > 0) {
      fail("has cluster terms without functions");
    }
    if (all > 0) {
      weightScales = elements<float>(viewIndex(c, "weightScales", owner), all, "the list of weight scales");
      requireFinite(weightScales, "the list of weight scales");
      components = unpacked(viewIndex(c, "components", owner), all * functions, "the list of components", baked_.coded->components);
    }
    for (const float s : meanScales)
      if (!(s >= 0.0f)) fail("a mean scale is negative");
    for (const float s : weightScales)
      if (!(s > 0.0f)) fail("a weight scale is not positive");
    for (const auto q : means)
      if (q < -32767) fail("a cluster's mean is out of range");
    for (const auto q : components)
      if (q == 128) fail("a component is out of range");  // -128
    const std::int16_t* mean = means.data();
    const std::uint8_t* component = components.data();
    const float* scale = weightScales.data();
    for (std::size_t i = 0; i < count; ++i) {
      out.clusters.push_back({.terms = terms[i], .meanScale = meanScales[i], .mean = {mean, mean + functions},
                              .components = {component, component + terms[i] * functions}, .weightScale = {scale, scale + terms[i]}});
      mean += functions;
      component += terms[i] * functions;
      scale += terms[i];
    }
  }

  ClusteredVertices readClusteredVertices(std::size_t primitive, std::size_t count, const std::string& label) {
    const auto& c = baked_.transfer.clustered;
    const json& list = (*extension_)["clustered"]["primitives"];
    if (list.size() != baked_.scene.primitives.size()) fail("\"clustered\" has other primitives than the scene");
    const json& entry = list[primitive];
    ClusteredVertices out;
    baked_.coded->weights.emplace_back();
    const auto clusters = unpacked(viewIndex(entry, "clusters", label), 2 * count, "the list of clusters of " + label, baked_.coded->clusters.emplace_back());
    for (std::size_t v = 0; v < count; ++v) out.cluster.push_back(static_cast<std::uint16_t>(clusters[v] | clusters[count + v] << 8));
    for (const auto cluster : out.cluster)
      if (cluster >= c.clusters.size()) fail(label + " names cluster " + std::to_string(cluster) + " of " + std::to_string(c.clusters.size()));
    const std::size_t weights = out.firstWeights(c.clusters).back();
    if (weights == 0) return out;
    const int width = c.weightBits / 8;
    const auto byTerm =
        valuesOfPlanes(unpacked(viewIndex(entry, "weights", label), weights * static_cast<std::size_t>(width), "the list of weights of " + label, baked_.coded->weights.back()), width);
    for (const auto q : byTerm)
      if (q < (c.weightBits == 8 ? -127 : -32767)) fail(label + " has a weight out of range");
    out.weights = weightsByVertex(out, c.clusters, byTerm);
    return out;
  }

  void readFacts() {
    const json& facts = member(*extension_, "facts", kTransferExtension);
    if (!facts.is_object()) fail("\"facts\" is not an object");
    for (const auto& [name, value] : facts.items()) {
      if (!value.is_number() && !value.is_null()) fail("the fact \"" + name + "\" is not a number");
      baked_.facts[name] = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
    }
  }

  // What each vertex has --------------------------------------------------------------------------------------------

  /// The scene reader walks nodes; the file's meshes must come out of it one to one, in order.
  void readVertices() {
    std::size_t index = 0;
    const json& meshes = listOf(root_, "meshes", "the file");
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      const std::string meshLabel = "mesh " + std::to_string(m);
      for (const json& primitive : listOf(meshes[m], "primitives", meshLabel)) {
        const std::string label = "primitive " + std::to_string(index) + " (of " + meshLabel + ")";
        if (index >= baked_.scene.primitives.size() || baked_.scene.primitives[index].mesh != static_cast<int>(m))
          fail("its nodes do not show its meshes in order");
        const std::size_t count = baked_.scene.primitives[index].positions.size();
        const json& attributes = member(primitive, "attributes", label);
        if (!attributes.is_object() || !attributes.contains("NORMAL")) fail(label + " has no normals");
        baked_.transfer.primitives.push_back(readPrimitive(attributes, index, count, label));
        ++index;
      }
    }
    if (index != baked_.scene.primitives.size()) fail("its nodes do not show its meshes in order");
    decodeFractions(baked_.transfer);
  }

  PrimitiveTransfer readPrimitive(const json& attributes, std::size_t index, std::size_t count, const std::string& label) {
    const Transfer& t = baked_.transfer;
    PrimitiveTransfer out;
    if (!t.clustered.empty()) out.clustered = readClusteredVertices(index, count, label);
    readColumns(attributes, "_SSDF_", kShort, static_cast<std::size_t>(t.paddedTerms()), count, label, out.weights);
    if (!t.fractionsInRow()) readColumns(attributes, "_VISIBILITY_", kUnsignedByte, static_cast<std::size_t>(t.directionCount), count, label,
                out.visibility);
    const auto padded = static_cast<std::size_t>(t.paddedTerms());
    for (std::size_t v = 0; padded > 0 && v < count; ++v)
      for (std::size_t k = static_cast<std::size_t>(t.terms); k < padded; ++k)
        if (out.weights[v * padded + k] != 0) fail(label + " has weights that are not 0 behind the last term");
    return out;
  }

  template <class T>
  void readColumns(const json& attributes, const std::string& prefix, std::int64_t componentType, std::size_t width,
                   std::size_t count, const std::string& owner, std::vector<T>& out) const {
    const json& accessors = listOf(root_, "accessors", "the file");
    out.resize(count * width);
    for (std::size_t g = 0; 4 * g < width; ++g) {
      const std::string name = prefix + std::to_string(g);
      const std::string label = name + " of " + owner;
      const auto& accessor = accessors[static_cast<std::size_t>(
          integer(attributes, name.c_str(), 0, static_cast<std::int64_t>(accessors.size()) - 1, owner))];
      integer(accessor, "componentType", componentType, componentType, label);
      const std::string type = text(accessor, "type", label);
      if (type != "VEC4" || accessor.contains("sparse") || !accessor.contains("normalized") || accessor["normalized"] != true ||
          (accessor.contains("byteOffset") && accessor["byteOffset"] != 0))
        fail(label + " is not a plain list of four normalized values a vertex");
      integer(accessor, "count", static_cast<std::int64_t>(count), static_cast<std::int64_t>(count), label);
      const auto column = elements<T>(viewIndex(accessor, "bufferView", label), 4 * count, label);
      for (std::size_t v = 0; v < count; ++v)
        for (std::size_t c = 0; c < 4; ++c) out[v * width + 4 * g + c] = column[4 * v + c];
    }
  }

  std::span<const std::uint8_t> bytes_;
  const std::filesystem::path& path_;
  std::string where_;
  GlbChunks chunks_;
  json root_;
  const json* extension_ = nullptr;
  std::vector<std::span<const std::uint8_t>> views_;
  BakedScene baked_;
};

}  // namespace

BakedScene readBakedScene(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  if (bytes.empty()) throw inputError(path.string(), "is empty", "bake it again");
  try {
    return BakedReader(bytes, path).read();
  } catch (const nlohmann::json::exception& exception) {
    throw inputError(path.string(), std::string("its JSON has an unexpected value (") + exception.what() + ")", kBakeAgain);
  } catch (const std::bad_alloc&) {
    throw inputError(path.string(), "does not fit into memory", "use a larger machine");
  } catch (const std::length_error&) {
    throw inputError(path.string(), "does not fit into memory", "use a larger machine");
  }
}

}  // namespace chiaro
