#include "precompute/report/visibility/map_methods.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "precompute/compression/pca.h"
#include "precompute/parallel.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

double horizonFraction(const SurfacePoint& point, const Lobe& lobe) {
  return lobe64::sgHalfSpaceFraction(glm::dot(glm::dvec3(point.view.normal), lobe.axis), lobe.sharpness);
}

double atAxis(const float* map, int resolution, const SurfacePoint&, const Lobe& lobe) {
  return lobe64::ssdfVisibleFraction(static_cast<double>(sampleOctahedral(map, resolution, glm::vec3(lobe.axis))),
                                     lobe.sharpness);
}

double atAxisAboveHorizon(const float* map, int resolution, const SurfacePoint& point, const Lobe& lobe) {
  return atAxis(map, resolution, point, lobe) * horizonFraction(point, lobe);
}

double integrated(const float* map, int resolution, const SurfacePoint&, const Lobe& lobe) {
  double sum = 0.0;
  for (const auto& w : lobe.directions) sum += static_cast<double>(sampleOctahedral(map, resolution, w));
  return sum / static_cast<double>(lobe.directions.size());
}

/// maps: #vertices rows, in the order of `vertices`.
FixedPointMatrix mapsOf(const VisibilityInput& input, const TracedVertices& traced, const MapKind& kind,
                        const std::vector<std::size_t>& vertices) {
  constexpr std::size_t kBlock = 32;
  const auto& grid = traced.grid();
  FixedPointMatrix maps(vertices.size(), grid.texelCount, kind.range);
  parallelBlocks(input.threads, (vertices.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    VertexMaps vertexMaps(grid);
    std::vector<float> map(grid.texelCount);
    for (auto i = block * kBlock; i < std::min((block + 1) * kBlock, vertices.size()); ++i) {
      (vertexMaps.*kind.map)(input.viewpoints[vertices[i]], traced.visible(vertices[i]), map.data());
      maps.setRow(i, map.data());
    }
  });
  return maps;
}

class PcaMethod : public VisibilityMethod {
 public:
  PcaMethod(const VisibilityInput& input, const TracedVertices& traced, const MapKind& kind)
      : kind_(kind), encoded_(input.encoded), resolution_(traced.grid().resolution), texels_(traced.grid().texelCount) {
    const auto& grid = traced.grid();
    const auto columnWeight = grid.rowMajorSolidAngle();
    const PcaSettings settings{.terms = input.terms, .seed = input.seed, .threads = input.threads};
    auto pca = computePca(mapsOf(input, traced, kind, input.basis), columnWeight, settings);
    terms_ = static_cast<std::size_t>(pca.terms);
    mean_ = std::move(pca.mean);
    project(mapsOf(input, traced, kind, input.encoded), pca.functions, columnWeight, input.threads);
    functions_ = std::move(pca.functions);
    for (float& value : functions_) value = glm::unpackHalf1x16(glm::packHalf1x16(value));
  }

  std::string name() const override { return kind_.name + " PCA " + std::to_string(terms_); }
  StoredBytes bytes() const override {
    const auto terms = static_cast<double>(terms_), texels = static_cast<double>(texels_);
    return {2.0 * terms, 4.0 * texels + 2.0 * terms * texels + 4.0 * terms};
  }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<float> map = mean_;
    for (std::size_t k = 0; k < terms_; ++k) {
      float weight = 0.0f;
      for (std::size_t c = 0; c < 3; ++c) weight += point.weights[c] * weights_[slotOf(encoded_, point.vertices[c]) * terms_ + k];
      for (std::size_t t = 0; t < texels_; ++t) map[t] += weight * functions_[k * texels_ + t];
    }
    return
        [this, &point, map = std::move(map)](const Lobe& lobe) { return kind_.fraction(map.data(), resolution_, point, lobe); };
  }

 private:
  /// The functions are orthonormal under `columnWeight`.
  void project(const FixedPointMatrix& maps, const std::vector<float>& functions, const std::vector<float>& columnWeight,
               int threads) {
    weights_.resize(maps.rows * terms_);
    parallelBlocks(threads, maps.rows, [&](std::size_t i) {
      for (std::size_t k = 0; k < terms_; ++k) {
        float sum = 0.0f;
        for (std::size_t t = 0; t < texels_; ++t)
          sum += columnWeight[t] * (static_cast<float>(maps.row(i)[t]) * maps.step() - mean_[t]) * functions[k * texels_ + t];
        weights_[i * terms_ + k] = sum;
      }
    });
    for (std::size_t k = 0; k < terms_; ++k) {
      float scale = 0.0f;
      for (std::size_t i = 0; i < maps.rows; ++i) scale = std::max(scale, std::abs(weights_[i * terms_ + k]));
      for (std::size_t i = 0; i < maps.rows; ++i) weights_[i * terms_ + k] = rounded16(weights_[i * terms_ + k], scale);
    }
  }

  MapKind kind_;
  std::vector<std::size_t> encoded_;
  int resolution_;
  std::size_t texels_;
  std::size_t terms_ = 0;
  std::vector<float> mean_, functions_;  ///< #texels; #terms by #texels
  std::vector<float> weights_;           ///< #encoded by #terms, as stored
};

class UncompressedMethod : public VisibilityMethod {
 public:
  UncompressedMethod(const VisibilityInput& input, const TracedVertices& traced, const MapKind& kind)
      : kind_(kind),
        encoded_(input.encoded),
        resolution_(traced.grid().resolution),
        maps_(mapsOf(input, traced, kind, input.encoded)) {}

  std::string name() const override { return kind_.name + " uncompressed"; }
  StoredBytes bytes() const override { return {2.0 * static_cast<double>(maps_.columns), 0.0}; }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<float> map(maps_.columns, 0.0f);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto* row = maps_.row(slotOf(encoded_, point.vertices[c]));
      for (std::size_t t = 0; t < map.size(); ++t) map[t] += point.weights[c] * maps_.step() * static_cast<float>(row[t]);
    }
    return
        [this, &point, map = std::move(map)](const Lobe& lobe) { return kind_.fraction(map.data(), resolution_, point, lobe); };
  }

 private:
  MapKind kind_;
  std::vector<std::size_t> encoded_;
  int resolution_;
  FixedPointMatrix maps_;
};

class UnoccludedMethod : public VisibilityMethod {
 public:
  std::string name() const override { return "no shadows"; }
  StoredBytes bytes() const override { return {}; }
  LobeFraction at(const SurfacePoint& point) const override {
    return [&point](const Lobe& lobe) { return horizonFraction(point, lobe); };
  }
};

}  // namespace

MapKind ssdfWithHorizon() { return {"SSDF with horizon", kMaxDistance, &VertexMaps::ssdfWithHorizon, atAxis}; }
MapKind ssdfOfOccluders() { return {"SSDF", kMaxDistance, &VertexMaps::ssdfOfOccluders, atAxisAboveHorizon}; }
MapKind binaryVisibility() { return {"visibility", 1.0f, &VertexMaps::visibility, integrated}; }

std::unique_ptr<VisibilityMethod> makePcaMethod(const VisibilityInput& input, const TracedVertices& traced, const MapKind& kind) {
  return std::make_unique<PcaMethod>(input, traced, kind);
}

std::unique_ptr<VisibilityMethod> makeUncompressedMethod(const VisibilityInput& input, const TracedVertices& traced,
                                                         const MapKind& kind) {
  return std::make_unique<UncompressedMethod>(input, traced, kind);
}

std::unique_ptr<VisibilityMethod> makeUnoccludedMethod() { return std::make_unique<UnoccludedMethod>(); }

}  // namespace chiaro
