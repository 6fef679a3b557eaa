#include "precompute/report/visibility/transfer_method.h"

#include <algorithm>

#include "precompute/compression/encode.h"
#include "precompute/report/visibility/map_methods.h"
#include "precompute/transfer_lookup.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

class TransferMethod : public VisibilityMethod {
 public:
  explicit TransferMethod(const Transfer& transfer) : transfer_(transfer), kind_(ssdfOfOccluders()) {}

  std::string name() const override { return "baked, PCA " + std::to_string(transfer_.terms); }
  StoredBytes bytes() const override {
    return {2.0 * transfer_.paddedTerms(), 4.0 * static_cast<double>(transfer_.mean.size() + transfer_.weightScale.size()) +
                                               2.0 * static_cast<double>(transfer_.eigenfunctions.size())};
  }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<float> map(transfer_.mean.size(), 0.0f), corner(map.size());
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(point.weights[c] > 0.0f)) continue;
      decodeSsdf(transfer_, weightsOf(transfer_, point.vertices[c]), corner.data());
      for (std::size_t t = 0; t < map.size(); ++t) map[t] += point.weights[c] * corner[t];
    }
    return [this, &point, map = std::move(map)](const Lobe& lobe) {
      return kind_.fraction(map.data(), transfer_.resolution, point, lobe);
    };
  }

 private:
  const Transfer& transfer_;
  MapKind kind_;
};

/// Clusters and functions are kept as they are stored; a corner's row is summed when it is asked for.
class ClusteredMethod : public VisibilityMethod {
 public:
  explicit ClusteredMethod(const Transfer& transfer)
      : transfer_(transfer), functions_(transfer.clustered.functions.unpack(transfer.columns())) {
    std::size_t count = 0;
    for (const auto& primitive : transfer.primitives) {
      first_.push_back(primitive.clustered.firstWeights(transfer.clustered.clusters));
      count += primitive.clustered.cluster.size();
    }
    const double fractions = transfer.fractionsInRow() ? 0.0 : transfer.directionCount;
    bytes_.eachVertex = 2.0;
    double weights = 0.0;
    for (const auto& primitive : transfer.primitives) weights += static_cast<double>(primitive.clustered.weights.size());
    bytes_.eachVertex += weights * transfer.clustered.weightBits / 8.0 / static_cast<double>(count);
    bytes_.shared = (transfer.bytesPerVertex(count) - fractions - bytes_.eachVertex) * static_cast<double>(count);
  }

  std::string name() const override {
    return std::string("baked, ") + (transfer_.clustered.levels.empty() ? "clustered " : "joint ") +
           std::to_string(transfer_.clustered.clusters.size()) + " x " + std::to_string(transfer_.terms);
  }
  StoredBytes bytes() const override { return bytes_; }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<float> row(transfer_.columns(), 0.0f);
    for (std::size_t c = 0; c < 3; ++c)
      if (point.weights[c] > 0.0f) add(point.vertices[c], point.weights[c], row);
    return [this, &point, row = std::move(row)](const Lobe& lobe) {
      const double above = lobe64::sgHalfSpaceFraction(glm::dot(glm::dvec3(point.view.normal), glm::dvec3(lobe.axis)), lobe.sharpness);
      return above * visibleShare(row.data(), transfer_.resolution, transfer_.clustered.levels, glm::vec3(lobe.axis), lobe.sharpness);
    };
  }

 private:
  void add(std::size_t vertex, float share, std::vector<float>& row) const {
    std::size_t p = 0;
    while (vertex >= transfer_.primitives[p].clustered.cluster.size()) vertex -= transfer_.primitives[p++].clustered.cluster.size();
    const auto& own = transfer_.primitives[p].clustered;
    const auto& cluster = transfer_.clustered.clusters[own.cluster[vertex]];
    const auto columns = row.size(), count = cluster.mean.size();
    std::vector<float> factor(count);
    for (std::size_t d = 0; d < count; ++d) factor[d] = cluster.meanScale * static_cast<float>(cluster.mean[d]) / 32767.0f;
    for (std::size_t k = 0; k < static_cast<std::size_t>(cluster.terms); ++k) {
      const float w = cluster.weightScale[k] * static_cast<float>(own.weights[first_[p][vertex] + k]) / 127.0f;
      for (std::size_t d = 0; d < count; ++d) factor[d] += w * static_cast<float>(cluster.components[k * count + d]);
    }
    for (std::size_t j = 0; j < columns; ++j) row[j] += share * transfer_.mean[j];
    for (std::size_t d = 0; d < count; ++d) {
      const float* function = functions_.data() + d * columns;
      for (std::size_t j = 0; j < columns; ++j) row[j] += share * factor[d] * function[j];
    }
  }

  const Transfer& transfer_;
  std::vector<float> functions_;
  std::vector<std::vector<std::size_t>> first_;
  StoredBytes bytes_;
};

}  // namespace

std::unique_ptr<VisibilityMethod> makeTransferMethod(const Transfer& transfer) {
  if (!transfer.clustered.empty()) return std::make_unique<ClusteredMethod>(transfer);
  return std::make_unique<TransferMethod>(transfer);
}

}  // namespace chiaro
