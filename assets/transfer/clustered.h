#pragma once
/// The clustered form of a baked transfer (Sloan et al. 2003): vertices in clusters, each with a mean and a few components of its own.
/// Means and components are themselves sums of functions that all clusters share, so a cluster costs bytes, not maps:
///
///   row(vertex) = mean + sum_d (m_d + sum_k w_k C_kd) function_d,     m, C: the vertex's cluster; w: its weights
///
/// A row holds every map of a vertex, one behind the other: the SSDF, then prefiltered visibility level by level, then (with levels) the
/// visible fractions.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace chiaro {

/// One map of prefiltered visibility (precompute/visibility/prefilter.h).
struct VisibilityLevel {
  float sharpness = 0.0f;
  int resolution = 0;  ///< octahedral texels a side
  bool operator==(const VisibilityLevel&) const = default;
};

/// Whether each level is as many times sharper than the one before as the second than the first (within a thousandth): lookups rely on it.
bool isGeometric(const std::vector<VisibilityLevel>& levels);

/// Functions in one block of bytes, each of a kind that its bits a value name; n = #columns:
///   16  2n bytes: half floats;
///   12  2n bytes: q & 255 of each value, then (q + 128) >> 8 of each, rounded down: q = int8(low) + 256 int8(high) in [-2047, 2047],
///       value = scale * columnScale * q / 2047. Small q leave the high bytes 0: short once they are coded;
///    8  n bytes: value = scale * q / 127, q in [-127, 127];
///    4  9 ceil(n / 16) bytes: blocks of 16 values: a byte b, then eight bytes of two signed 4-bit q in [-7, 7], the low one first;
///       value = scale * b / 255 * q / 7.
struct PackedFunctions {
  static constexpr int kMostSteps = 2047;  ///< |q| of kind 12

  std::vector<std::uint8_t> bits;   ///< 16, 12, 8 or 4, by function
  std::vector<float> scale;         ///< by function; 1 for 16 bits
  std::vector<std::uint8_t> data;
  std::vector<float> columnScale;   ///< #columns, what kind 12 multiplies; empty: all 1

  std::size_t count() const { return bits.size(); }
  /// Bytes of one function of `columns` values.
  static std::size_t bytesOf(int bits, std::size_t columns);
  /// bitsPerValue: 16, 12, 8 or 4. The scale is the largest |value|, of kind 12 the largest |value / columnScale|.
  void append(const float* values, std::size_t columns, int bitsPerValue);
  /// Kind 12 with a scale of its own, > 0: steps of scale * columnScale / 2047, at most 2047 of them.
  void appendSteps(const float* values, std::size_t columns, float scale);
  /// Whether every q is one that a kind allows. Sizes and kinds are right already.
  bool inRange(std::size_t columns) const;
  /// #functions by columns, row-major.
  std::vector<float> unpack(std::size_t columns) const;
};

/// #functions = F coordinates.
struct TransferCluster {
  int terms = 0;
  float meanScale = 0.0f;                 ///< m_d = meanScale * q / 32767
  std::vector<std::int16_t> mean;         ///< F, in [-32767, 32767]
  std::vector<std::int8_t> components;    ///< terms by F: C_kd = q / 127, q in [-127, 127]; of any length
  std::vector<float> weightScale;         ///< terms: w_k = weightScale * q, q the vertex's stored integer
};

struct ClusteredTransfer {
  std::vector<VisibilityLevel> levels;
  PackedFunctions functions;
  std::vector<TransferCluster> clusters;
  int weightBits = 8;                     ///< 8 or 16: a stored weight is in [-127, 127] or [-32767, 32767]
  /// One for each map of a row (SSDF, levels, then with levels the visible fractions), > 0: functions.columnScale by map; empty: all 1.
  std::vector<float> mapScales;
  /// Radians: rows hold softness * tanh(SSDF / softness) (shaders/lobe/ssdf.glsl). 0: the SSDF itself.
  float ssdfSoftness = 0.0f;
  bool empty() const { return clusters.empty(); }
};

/// What a vertex of a primitive stores.
struct ClusteredVertices {
  std::vector<std::uint16_t> cluster;   ///< #vertices
  std::vector<std::int16_t> weights;    ///< the clusters' terms of each vertex, one vertex behind the other
  /// #vertices + 1 places in `weights`.
  std::vector<std::size_t> firstWeights(const std::vector<TransferCluster>& clusters) const;
};

/// Maps of clusters ready for use, for columns [begin, end): (1 + terms) by end - begin for each cluster, one behind the other, the mean
/// first. A vertex's row is mean + sum_k w_k map_k. functions: unpacked, #functions by mean.size().
std::vector<float> clusterMaps(const std::vector<TransferCluster>& clusters, const std::vector<float>& functions, const std::vector<float>& mean,
                               std::size_t begin, std::size_t end);

}  // namespace chiaro
