#include "precompute/report/visibility/transfer_method.h"

#include <algorithm>

#include "assets/transfer/coded_lists.h"
#include "assets/transfer/row_decoder.h"
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

class ClusteredMethod : public VisibilityMethod {
 public:
  explicit ClusteredMethod(const Transfer& transfer) : transfer_(transfer), decoder_(transfer) {
    const auto coded = codedLists(transfer);
    double own = 0.0, count = 0.0;
    for (const auto* lists : {&coded.clusters, &coded.weights})
      for (const auto& list : *lists) own += static_cast<double>(list.size());
    for (const auto& primitive : transfer.primitives) count += static_cast<double>(primitive.clustered.cluster.size());
    const double fractions = transfer.fractionsInRow() ? 0.0 : transfer.directionCount;
    bytes_.eachVertex = own / count;
    bytes_.shared = (transfer.bytesPerVertex(static_cast<std::size_t>(count), &coded) - fractions - bytes_.eachVertex) * count;
  }

  std::string name() const override {
    return std::string("baked, ") + (transfer_.clustered.levels.empty() ? "clustered " : "joint ") +
           std::to_string(transfer_.clustered.clusters.size()) + " x " + std::to_string(transfer_.terms);
  }
  StoredBytes bytes() const override { return bytes_; }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<float> row(transfer_.columns(), 0.0f);
    for (std::size_t c = 0; c < 3; ++c)
      if (point.weights[c] > 0.0f) decoder_.add(point.vertices[c], point.weights[c], row.data());
    return [this, &point, row = std::move(row)](const Lobe& lobe) {
      const double above = lobe64::sgHalfSpaceFraction(glm::dot(glm::dvec3(point.view.normal), glm::dvec3(lobe.axis)), lobe.sharpness);
      return above * visibleShare(row.data(), transfer_.resolution, transfer_.clustered.levels, transfer_.clustered.ssdfSoftness, glm::vec3(lobe.axis), lobe.sharpness);
    };
  }

 private:
  const Transfer& transfer_;
  RowDecoder decoder_;
  StoredBytes bytes_;
};

}  // namespace

std::unique_ptr<VisibilityMethod> makeTransferMethod(const Transfer& transfer) {
  if (!transfer.clustered.empty()) return std::make_unique<ClusteredMethod>(transfer);
  return std::make_unique<TransferMethod>(transfer);
}

}  // namespace chiaro
