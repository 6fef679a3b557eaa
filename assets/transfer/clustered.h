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

/// Functions in one block of bytes, each as 16, 8 or 4 bits a value:
///   16  half floats;
///    8  signed bytes, value = scale * q / 127;
///    4  blocks of 16 values: a byte b, then eight bytes of two signed 4-bit q, the low one first; value = scale * b / 255 * q / 7.
struct PackedFunctions {
  std::vector<std::uint8_t> bits;   ///< 16, 8 or 4, by function
  std::vector<float> scale;         ///< by function; 1 for 16 bits
  std::vector<std::uint8_t> data;

  std::size_t count() const { return bits.size(); }
  /// Bytes of one function of `columns` values.
  static std::size_t bytesOf(int bits, std::size_t columns);
  void append(const float* values, std::size_t columns, int bitsPerValue);
  /// #functions by columns, row-major.
  std::vector<float> unpack(std::size_t columns) const;
};

/// #functions = F coordinates.
struct TransferCluster {
  int terms = 0;
  float meanScale = 0.0f;                 ///< m_d = meanScale * q / 32767
  std::vector<std::int16_t> mean;         ///< F, as blocks of 8 bits hold them (block_codec.h)
  std::vector<std::int8_t> components;    ///< terms by F: C_kd = q / 127; from term wideTerms on as blocks of 4 bits hold them
  std::vector<float> weightScale;         ///< terms: w_k = weightScale * q, q the vertex's stored integer
};

struct ClusteredTransfer {
  std::vector<VisibilityLevel> levels;
  PackedFunctions functions;
  std::vector<TransferCluster> clusters;
  int weightBits = 8;                     ///< 8 or 16: what a stored weight of the first wideTerms terms may take
  /// The terms of a cluster behind these, the weak ones, store 4 bits for each weight and each component.
  int wideTerms = 4096;
  bool empty() const { return clusters.empty(); }
};

/// What a vertex of a primitive stores.
struct ClusteredVertices {
  std::vector<std::uint16_t> cluster;   ///< #vertices
  std::vector<std::int16_t> weights;    ///< the clusters' terms of each vertex, one vertex behind the other
  /// #vertices + 1 places in `weights`.
  std::vector<std::size_t> firstWeights(const std::vector<TransferCluster>& clusters) const;
};

/// Bytes that a cluster's components, and a vertex's weights, take where they are stored.
std::size_t storedComponentBytes(const ClusteredTransfer& clustered, int terms);
std::size_t storedWeightBytes(const ClusteredTransfer& clustered, int terms);

/// Maps of clusters ready for use, for columns [begin, end): (1 + terms) by end - begin for each cluster, one behind the other, the mean
/// first. A vertex's row is mean + sum_k w_k map_k. functions: unpacked, #functions by mean.size().
std::vector<float> clusterMaps(const std::vector<TransferCluster>& clusters, const std::vector<float>& functions, const std::vector<float>& mean,
                               std::size_t begin, std::size_t end);

}  // namespace chiaro
