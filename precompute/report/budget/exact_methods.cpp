#include "precompute/report/budget/exact_methods.h"

#include "precompute/parallel.h"
#include "precompute/traced_share.h"
#include "precompute/transfer_lookup.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

double aboveHorizon(const SurfacePoint& point, const Lobe& lobe) {
  return lobe64::sgHalfSpaceFraction(glm::dot(glm::dvec3(point.view.normal), lobe.axis), lobe.sharpness);
}

class RowsMethod : public VisibilityMethod {
 public:
  RowsMethod(const VisibilityInput& input, const TransferRows::Layout& layout, std::string name)
      : name_(std::move(name)), layout_(layout), encoded_(input.encoded), columns_(0) {
    const TransferRows rows(input.rays, input.viewpoints, layout);
    columns_ = rows.size();
    values_.resize(encoded_.size() * columns_);
    parallelBlocks(input.threads, encoded_.size(), [&](std::size_t i) {
      const auto vertex = static_cast<std::uint32_t>(encoded_[i]);
      rows(std::span(&vertex, 1), values_.data() + i * columns_, columns_);
    });
  }

  std::string name() const override { return name_; }
  StoredBytes bytes() const override { return {4.0 * static_cast<double>(columns_), 0.0}; }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<float> row(columns_, 0.0f);
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(point.weights[c] > 0.0f)) continue;
      const float* corner = values_.data() + slotOf(encoded_, point.vertices[c]) * columns_;
      for (std::size_t t = 0; t < columns_; ++t) row[t] += point.weights[c] * corner[t];
    }
    return [this, &point, row = std::move(row)](const Lobe& lobe) {
      return aboveHorizon(point, lobe) * visibleShare(row.data(), layout_.resolution, layout_.levels, layout_.softness, glm::vec3(lobe.axis), lobe.sharpness);
    };
  }

 private:
  std::string name_;
  TransferRows::Layout layout_;
  std::vector<std::size_t> encoded_;
  std::size_t columns_;
  std::vector<float> values_;  ///< #encoded by columns_
};

/// Share of those directions that are above the horizon that arrive; 1 where none is.
double shareAbove(const RayScene& rays, const Viewpoint& view, const std::vector<glm::vec3>& directions) {
  std::size_t above = 0;
  for (const auto& w : directions) above += glm::dot(w, view.normal) > 0.0f;
  if (above == 0) return 1.0;
  return tracedShare(rays, view.front, view.normal, directions) * static_cast<double>(directions.size()) / static_cast<double>(above);
}

class TracedCornersMethod : public VisibilityMethod {
 public:
  explicit TracedCornersMethod(const VisibilityInput& input) : input_(input) {}
  std::string name() const override { return "traced at vertices"; }
  StoredBytes bytes() const override { return {}; }
  LobeFraction at(const SurfacePoint& point) const override {
    return [this, &point](const Lobe& lobe) {
      double share = 0.0;
      for (std::size_t c = 0; c < 3; ++c)
        if (point.weights[c] > 0.0f) share += static_cast<double>(point.weights[c]) * shareAbove(input_.rays, input_.viewpoints[point.vertices[c]], lobe.directions);
      return aboveHorizon(point, lobe) * share;
    };
  }

 private:
  VisibilityInput input_;
};

class TracedPointMethod : public VisibilityMethod {
 public:
  explicit TracedPointMethod(const VisibilityInput& input) : rays_(input.rays) {}
  std::string name() const override { return "traced at the point"; }
  StoredBytes bytes() const override { return {}; }
  LobeFraction at(const SurfacePoint& point) const override {
    return [this, &point](const Lobe& lobe) { return tracedShare(rays_, point.view.front, point.view.normal, lobe.directions); };
  }

 private:
  const RayScene& rays_;
};

}  // namespace

std::unique_ptr<VisibilityMethod> makeRowsMethod(const VisibilityInput& input, const TransferRows::Layout& layout, const std::string& name) {
  return std::make_unique<RowsMethod>(input, layout, name);
}

std::unique_ptr<VisibilityMethod> makeTracedCornersMethod(const VisibilityInput& input) { return std::make_unique<TracedCornersMethod>(input); }
std::unique_ptr<VisibilityMethod> makeTracedPointMethod(const VisibilityInput& input) { return std::make_unique<TracedPointMethod>(input); }

}  // namespace chiaro
