#pragma once
/// Clustered principal components: rows in groups, each group with its own mean and its own few components (Sloan, Hall, Hart and
/// Snyder, "Clustered Principal Components for Precomputed Radiance Transfer", 2003, section 4).

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace chiaro {

/// Rows of coordinates in an orthonormal basis, so that their Euclidean distance is the error that counts.
struct Coordinates {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<float> values;  ///< row-major
  const float* row(std::size_t i) const { return values.data() + i * columns; }
};

struct ClusterSettings {
  int clusters = 64;
  int terms = 24;               ///< most components of a cluster
  int iterations = 4;           ///< reassignments after k-means
  double leastRms = 1e-4;       ///< components that move the cluster's rows by less (rms, the rows' units) are dropped
  std::uint32_t seed = 0;
  int threads = 0;              ///< never changes the result
};

struct Cluster {
  std::size_t rows = 0;             ///< of the training rows
  int terms = 0;
  std::vector<float> mean;          ///< #columns
  std::vector<float> components;    ///< #terms by #columns, orthonormal, strongest first
  std::vector<double> energy;       ///< #terms: sum over its rows of the squared weights
};

/// k-means on the strongest columns, then rows move to the cluster that reproduces them best, and means and components are made anew.
/// Fewer clusters come back when some stay empty.
std::vector<Cluster> clusterRows(const Coordinates& rows, const ClusterSettings& settings, const std::function<void(double)>& progress = {});

/// The cluster that reproduces each row best, among the `kCandidates` with the nearest means.
std::vector<std::uint16_t> assignRows(const std::vector<Cluster>& clusters, const Coordinates& rows, int threads);

}  // namespace chiaro
