#include "precompute/compression/masked_projection.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "precompute/parallel.h"

namespace chiaro {
namespace {

using Matrix = RowMajor<float>;

constexpr double kPrior = 1e-2;
constexpr float kFaintest = 1e-4f;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

MaskedProjection::MaskedProjection(const Pca& pca, const std::vector<float>& columnWeight, const ColumnMasks& masks, int threads)
    : mean_(Eigen::Map<const Eigen::RowVectorXf>(pca.mean.data(), index(pca.mean.size()))),
      weighted_(index(pca.mean.size()), pca.terms),
      masks_(masks.masks),
      inverse_(masks.masks.size()) {
  const Eigen::Map<const Matrix> functions(pca.functions.data(), pca.terms, weighted_.rows());
  const Eigen::Map<const Eigen::VectorXf> weight(columnWeight.data(), weighted_.rows());
  weighted_ = weight.asDiagonal() * functions.transpose();
  if (pca.terms == 0) return;
  parallelBlocks(threads, masks_.size(), [&](std::size_t m) {
    if (masks_[m].empty()) return;
    // What the mask all but leaves out adds nothing to the normal equations.
    std::vector<std::size_t> used;
    for (std::size_t j = 0; j < masks_[m].size(); ++j)
      if (masks_[m][j] > kFaintest) used.push_back(j);
    Matrix scaled(index(used.size()), weighted_.cols());
    for (std::size_t i = 0; i < used.size(); ++i) {
      const auto j = index(used[i]);
      scaled.row(index(i)) = std::sqrt(masks_[m][used[i]] / weight[j]) * weighted_.row(j);
    }
    Eigen::MatrixXd normal = gram(scaled).cast<double>();
    for (int k = 0; k < pca.terms; ++k) normal(k, k) += kPrior * pca.energy.back() / pca.energy[static_cast<std::size_t>(k)];
    inverse_[m] = inverseOfPositive(std::move(normal)).cast<float>();
  });
}

RowMajor<float> MaskedProjection::operator()(const float* rows, std::size_t stride, std::span<const std::uint16_t> mask) const {
  const Eigen::Map<const Matrix, 0, Eigen::OuterStride<>> from(rows, index(mask.size()), weighted_.rows(),
                                                               Eigen::OuterStride<>(index(stride)));
  Matrix centred = from.rowwise() - mean_;
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (const auto& own = masks_[mask[i]]; !own.empty())
      centred.row(index(i)).array() *= Eigen::Map<const Eigen::RowVectorXf>(own.data(), weighted_.rows()).array();
  Matrix result = product(centred, weighted_);
  // Those of one mask together, so that its matrix is read once.
  std::vector<std::size_t> order(mask.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return mask[a] < mask[b]; });
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    const auto m = mask[order[first]];
    while (last < order.size() && mask[order[last]] == m) ++last;
    if (inverse_[m].size() == 0) continue;
    Matrix own(index(last - first), result.cols());
    for (auto i = first; i < last; ++i) own.row(index(i - first)) = result.row(index(order[i]));
    own = product(own, inverse_[m]);
    for (auto i = first; i < last; ++i) result.row(index(order[i])) = own.row(index(i - first));
  }
  return result;
}

}  // namespace chiaro
