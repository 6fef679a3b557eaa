#pragma once
/// From a scene to its compressed radiance transfer.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "assets/scene/scene.h"
#include "assets/transfer/transfer.h"
#include "precompute/mesh/refine.h"

namespace chiaro {

/// How transfer is compressed (docs/format.md).
enum class Compression {
  pca,        ///< the paper's: global principal components of the SSDF
  clustered,  ///< the same by clusters, each with components of its own
  joint,      ///< clusters of the SSDF together with visibility prefiltered for broad lobes
};

struct BakeSettings {
  Compression compression = Compression::joint;
  int resolution = 64;              ///< octahedral texels a side of the traced and stored sphere, 16..256
  /// Of what is traced where visibility changes: `resolution` times a power of two; 0: four times `resolution`, at most 256. The pca form
  /// traces `resolution`.
  int samplingResolution = 0;
  /// Radians, at most pi / 2: tracing starts fine enough that no occluder of this angular diameter is missed, however many rays it takes;
  /// 0: what falls between the coarse texels altogether may be. Must be wider than what samplingResolution itself may miss.
  float leastOccluder = 0.0f;
  int terms = 0;                    ///< weights a lookup fetches at most, 1..256 (fewer where fewer do); 0: 24, or 48 in the pca form
  int clusters = 0;                 ///< clustered forms: 1..4096; 0: by the number of vertices
  int functions = 0;                ///< clustered forms: that all clusters share, 1..1024; 0: by the number of vertices
  int weightBits = 8;               ///< clustered forms: 8 or 16
  int functionBits = 0;             ///< clustered forms: 16, 8, 4; 0: steps that follow from the bytes
  /// clustered forms: bytes a vertex, all counted, that the steps of rounding are chosen to fit, within a hundredth; 0: 104, yet never so coarsely that it
  /// shows in small scenes; negative: no limit
  double bytesPerVertex = 0.0;
  /// clustered forms: as few bytes a vertex as keep the mean error of the visible fraction at or below this for lobes of every sharpness
  /// measured (BakeReport::error); functions and clusters are chosen too. 0: off
  double targetError = 0.0;
  int directionCount = 32;          ///< fixed broad lobes per vertex, a multiple of 4, 8..64
  float directionSharpness = 32.0f;
  float creaseAngle = 1.0471976f;   ///< radians; sharper edges are split where the file has no normals
  RefineSettings refine{};          ///< off unless its error is above 0
  std::uint32_t seed = 0;
  int threads = 0;                  ///< 0: all cores. The result never depends on it.
};

/// What the input mesh needed before it could be baked; all counts.
struct RepairReport {
  std::size_t weldedVertices = 0;        ///< vertices merged with an identical one
  std::size_t isolatedVertices = 0;      ///< used by no triangle: dropped
  std::size_t degenerateTriangles = 0;   ///< zero area or a repeated corner: dropped
  std::size_t duplicateTriangles = 0;    ///< same corners, same winding: dropped
  std::size_t trianglesTurned = 0;       ///< of an inside-out mesh without normals: winding reversed
  std::size_t nonManifoldEdges = 0;      ///< kept; split for the half-edge mesh
  std::size_t boundaryEdges = 0;
  std::size_t normalsComputed = 0;       ///< vertices that got a normal
  std::size_t normalsRepaired = 0;       ///< zero or not unit in the file
  std::size_t tangentsComputed = 0;
};

struct BakeReport {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t verticesResumed = 0;  ///< taken from an earlier bake's journal
  std::uint64_t raysTraced = 0;     ///< with those of the earlier bake
  int terms = 0;
  double bytesPerVertex = 0.0;
  bool missedTarget = false;  ///< even the most bytes leave a larger error than BakeSettings::targetError
  struct { double visibility = 0, ssdf = 0, compression = 0, total = 0; } seconds;
  RepairReport repairs;
  RefineReport refinement;
  /// Error of what is stored, measured against the traced signal over all vertices (names in docs/programs.md):
  /// "ssdf_rms_radians", "ssdf_sign_share", "ssdf_quantisation_rms_radians", "visible_fraction_mean_abs_<lambda>", ...
  std::vector<std::pair<std::string, double>> error;
};

/// Where a bake keeps what it works on. None of it changes the result.
struct BakeStorage {
  /// File for what is finished so far (precompute/journal/journal.h), made beside the output. Stays when the bake is stopped, and a later
  /// one goes on from it; stays when the bake is done, too, until the caller has the result safe and removes it. Empty: none.
  std::filesystem::path journal;
  bool fresh = false;           ///< start anew whatever is in the journal
  std::string program;          ///< name and version of what bakes; another one starts anew
  std::size_t memoryLimit = 0;  ///< bytes that the process may have resident; what does not fit is read back from the journal. 0: no limit
  std::function<void(const std::string&)> notice{};  ///< one line about what was found in the journal; may be empty
};

/// stage name, share done in [0,1]. Called from one thread at a time.
using ProgressHandler = std::function<void(const std::string& stage, double done)>;

/// `settings` with every automatic value that does not depend on the scene filled in. Throws Error (usage) for one out of range.
BakeSettings resolvedSettings(const BakeSettings& settings);

/// Repairs, refines where asked to, traces, transforms, compresses. Same bytes for any thread count, any memory limit, and however often it
/// was stopped and resumed. Throws Error: a scene with no triangle, a memory limit that is too low (usage, before the long work), a journal
/// that cannot be written (unwritableOutput). What `progress` throws stops the bake at the end of a block.
BakedScene bake(Scene scene, const BakeSettings& settings, BakeReport& report, const ProgressHandler& progress = {}, const BakeStorage& storage = {});

/// Only the repair, welding, normals and tangents of the above (the reference renderer and the viewer see the same mesh).
Scene prepareScene(Scene scene, float creaseAngle, RepairReport& report);

}  // namespace chiaro
