#pragma once
/// Both ends of a subspace iteration: a random block to start with, and the Rayleigh-Ritz step.

#include <Eigen/Core>
#include <cstdint>

#include "precompute/compression/pca.h"
#include "precompute/compression/product.h"

namespace chiaro {

/// Independent standard normal numbers that depend on the seed and their place alone.
RowMajor<float> gaussianBlock(Eigen::Index rows, Eigen::Index columns, std::uint32_t seed);

/// basis: #columns by l, orthonormal. gram: l by l, of the rows' coordinates in it. root: what the columns were multiplied by. Fills in result's terms,
/// at most `terms` with more than leastEnergy each, their functions and energies. Returns what turns coordinates into weights: l by #terms.
RowMajor<double> ritzStep(const RowMajor<float>& basis, const Eigen::MatrixXd& gram, const Eigen::VectorXf& root, int terms,
                          double leastEnergy, Pca& result);

}  // namespace chiaro
