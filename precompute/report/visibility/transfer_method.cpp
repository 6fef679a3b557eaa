#include "precompute/report/visibility/transfer_method.h"

#include "precompute/compression/encode.h"
#include "precompute/report/visibility/map_methods.h"

namespace chiaro {
namespace {

/// Row of the PrimitiveTransfer weights of vertex `index` of the whole scene; null where there are no terms.
const std::int16_t* weightsOf(const Transfer& transfer, std::size_t index) {
  const auto stride = static_cast<std::size_t>(transfer.paddedTerms());
  if (stride == 0) return nullptr;
  for (const auto& primitive : transfer.primitives) {
    const auto count = primitive.weights.size() / stride;
    if (index < count) return primitive.weights.data() + index * stride;
    index -= count;
  }
  return nullptr;
}

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

}  // namespace

std::unique_ptr<VisibilityMethod> makeTransferMethod(const Transfer& transfer) {
  return std::make_unique<TransferMethod>(transfer);
}

}  // namespace chiaro
