#pragma once
/// Where the bytes of clustered components do most: more terms for the clusters that need them (reverse water-filling, Cover and
/// Thomas, "Elements of Information Theory", 10.3.3).

#include <vector>

#include "precompute/compression/clustering.h"

namespace chiaro {

struct TermBytes {
  int wideTerms = 4;          ///< terms of a cluster with the first prices; those behind have the second
  double component[2] = {};   ///< of one component
  double weight[2] = {};      ///< of one vertex' weight
  double vertices = 1.0;      ///< of the scene for each row of Cluster::rows
};

/// Drops components until the rest and the vertices' weights take at most `bytes`: each time the one whose energy per byte is least. What
/// a cluster keeps is its strongest.
void dropWeakTerms(std::vector<Cluster>& clusters, const TermBytes& cost, double bytes);

}  // namespace chiaro
