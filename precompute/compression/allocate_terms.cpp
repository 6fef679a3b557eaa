#include "precompute/compression/allocate_terms.h"

#include <algorithm>
#include <cstddef>

namespace chiaro {
namespace {

struct Candidate {
  std::size_t cluster;
  int term;
  double worth, bytes;
};

}  // namespace

void dropWeakTerms(std::vector<Cluster>& clusters, const TermBytes& cost, double bytes) {
  std::vector<Candidate> candidates;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const double vertices = static_cast<double>(clusters[c].rows) * cost.vertices;
    for (int k = 0; k < clusters[c].terms; ++k) {
      const int price = k < cost.wideTerms ? 0 : 1;
      const double size = cost.component[price] + vertices * cost.weight[price];
      double worth = clusters[c].energy[static_cast<std::size_t>(k)] * cost.vertices / size;
      if (k > 0) worth = std::min(worth, candidates.back().worth);  // cheap as it may be, it needs those before it
      candidates.push_back({c, k, worth, size});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  std::vector<int> kept(clusters.size(), 0);
  for (const auto& candidate : candidates) {
    bytes -= candidate.bytes;
    if (bytes < 0.0) break;
    kept[candidate.cluster] = candidate.term + 1;
  }
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    auto& cluster = clusters[c];
    cluster.terms = kept[c];
    cluster.components.resize(static_cast<std::size_t>(kept[c]) * cluster.mean.size());
    cluster.energy.resize(static_cast<std::size_t>(kept[c]));
  }
}

}  // namespace chiaro
