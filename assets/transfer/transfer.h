#pragma once
/// The baked radiance transfer of a scene and its file: a binary glTF with the extension CHIARO_radiance_transfer
/// (docs/format.md).
///
/// What is stored for a vertex with unit normal n (Wang et al. 2009, section 4, with the horizon left out):
///  * its SSDF as PCA weights. The SSDF S(w) is the signed angle (radians) from direction w to the nearest edge of what
///    *other* surfaces hide: positive where w is free, negative where it is hidden, clamped to [-pi/2, pi/2]. The vertex's own
///    horizon is not in it: below the horizon S mirrors the directions above (of a one-sided surface; clustered: only as far down
///    as a lobe from above reads) or holds what the back sees (of a double-sided one), and the runtime clips by the normal it
///    shades with. So an unoccluded vertex has S = pi/2 everywhere and costs no error.
///  * its visible fractions: for each of `directionCount` fixed lobes of sharpness `directionSharpness`, the share of the
///    lobe's cosine-weighted light that arrives. Broad lobes and diffuse light read these, sharp lobes the SSDF.

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "assets/scene/scene.h"
#include "assets/transfer/clustered.h"
#include "assets/transfer/coded_lists.h"

namespace chiaro {

inline constexpr std::uint32_t kTransferVersion = 1;

/// Per-vertex part, parallel to Scene::primitives.
struct PrimitiveTransfer {
  /// Global form: #vertices by `Transfer::paddedTerms`, row-major: weight k = weightScale[k] * value / 32767. Padding is 0.
  std::vector<std::int16_t> weights;
  /// #vertices by `Transfer::directionCount`, row-major: visible fraction = value / 255.
  std::vector<std::uint8_t> visibility;
  /// Clustered form; then `weights` is empty.
  ClusteredVertices clustered;
};

struct Transfer {
  int resolution = 0;  ///< octahedral texels a side (lobe/octahedral.glsl), row-major, texel centres at (i + 1/2) / resolution
  int terms = 0;       ///< PCA terms K >= 0 (0: nothing in the scene is occluded); clustered: the most that any cluster has
  int directionCount = 0;  ///< a multiple of 4
  float directionSharpness = 0.0f;
  std::vector<glm::vec3> directions;  ///< `directionCount` unit axes, world space
  std::vector<float> mean;            ///< `columns()`; the SSDF's in radians
  std::vector<float> eigenfunctions;  ///< global form: terms by resolution^2, row-major; stored as half
  std::vector<float> weightScale;     ///< global form: terms; > 0
  ClusteredTransfer clustered;        ///< empty in the global form
  std::vector<PrimitiveTransfer> primitives;

  int paddedTerms() const { return clustered.empty() ? (terms + 3) / 4 * 4 : 0; }
  std::size_t texels() const { return static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution); }
  /// Values of the levels' maps.
  std::size_t levelTexels() const;
  /// Whether the visible fractions are part of a row (and only derived from it in memory), or each vertex' own bytes.
  bool fractionsInRow() const { return !clustered.levels.empty(); }
  /// Values of a row: the SSDF, the levels, and, with levels, the visible fractions.
  std::size_t columns() const;
  /// Weights, visibility, and what all vertices share as stored, over all vertices. coded: of this transfer; without, a clustered one is coded for it,
  /// which takes seconds a million vertices.
  double bytesPerVertex(std::size_t vertexCount, const CodedLists* coded = nullptr) const;
};

/// PackedFunctions::columnScale, from the clustered form's mapScales: columns(), or empty.
std::vector<float> columnScales(const Transfer& transfer);

/// With fractionsInRow(): fills every primitive's visible fractions from its row.
void decodeFractions(Transfer& transfer);

/// What the bake wrote about itself: settings, seconds, error statistics. Flat dotted names ("settings.terms",
/// "error.ssdf_rms_radians"), kept in the file for people and reports.
using TransferFacts = std::map<std::string, double>;

struct BakedScene {
  Scene scene;  ///< every primitive has normals; tangents where a material needs them
  Transfer transfer;
  /// Of `transfer`, where they are there already (a bake makes them to know its size, a file has them): the writer uses them. Whoever changes the transfer must
  /// reset it.
  std::optional<CodedLists> coded;
  TransferFacts facts;
};

/// Throws Error (failed) when the parts do not fit each other (a bug), Error (unwritableOutput) when the disk says no.
/// Atomic. `generator` goes into asset.generator.
void writeBakedScene(const std::filesystem::path& path, const BakedScene& baked, const std::string& generator);

/// Every size, range, index and checksum is checked before use. Throws Error (unreadableInput), which for a glTF without
/// transfer says to run chiaro-precompute first.
BakedScene readBakedScene(const std::filesystem::path& path);

}  // namespace chiaro
