#include "precompute/report/visibility/haar_method.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "precompute/parallel.h"
#include "precompute/report/visibility/haar.h"

namespace chiaro {
namespace {

constexpr int kSide = 64;

struct Coefficient {
  std::uint16_t index = 0;
  float value = 0.0f;
};

/// 1 where the sphere is seen and above the horizon, else 0.
void traceCube(const RayScene& rays, const CubeGrid& grid, const Viewpoint& viewpoint, std::vector<float>& visible) {
  visible.assign(grid.texelCount, 0.0f);
  for (std::size_t first = 0; first < grid.texelCount; first += 16) {
    std::uint32_t above = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      const glm::vec3 w(grid.x[first + i], grid.y[first + i], grid.z[first + i]);
      if (glm::dot(w, viewpoint.normal) > 0.0f) above |= 1u << i;
    }
    if (above == 0) continue;
    const auto seen = above & ~rays.occluded16(viewpoint.front, grid.x.data() + first, grid.y.data() + first,
                                               grid.z.data() + first, above, 0.0f, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < 16; ++i) visible[first + i] = (seen >> i & 1u) != 0 ? 1.0f : 0.0f;
  }
}

/// The `count` largest, largest first; equal ones by their index, so that the choice is nobody's chance.
std::vector<Coefficient> largest(const std::vector<float>& values, std::size_t count) {
  std::vector<Coefficient> all;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] != 0.0f) all.push_back({static_cast<std::uint16_t>(i), values[i]});
  count = std::min(count, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(), [](const auto& a, const auto& b) {
    const float x = std::abs(a.value), y = std::abs(b.value);
    return x > y || (x == y && a.index < b.index);
  });
  all.resize(count);
  return all;
}

class HaarMethod : public VisibilityMethod {
 public:
  HaarMethod(const VisibilityInput& input, std::shared_ptr<const CubeGrid> grid, std::size_t terms,
             const std::vector<std::vector<Coefficient>>& sorted)
      : encoded_(input.encoded), grid_(std::move(grid)), terms_(terms), stored_(sorted) {
    float scale = 0.0f;
    for (auto& vertex : stored_) {
      vertex.resize(std::min(vertex.size(), terms));
      for (const auto& c : vertex) scale = std::max(scale, std::abs(c.value));
    }
    for (auto& vertex : stored_)
      for (auto& c : vertex) c.value = rounded16(c.value, scale);
  }

  std::string name() const override { return "Haar " + std::to_string(terms_); }
  StoredBytes bytes() const override { return {4.0 * static_cast<double>(terms_), 4.0}; }

  LobeFraction at(const SurfacePoint& point) const override {
    std::vector<float> map(grid_->texelCount, 0.0f);
    for (std::size_t c = 0; c < 3; ++c)
      for (const auto& [index, value] : stored_[slotOf(encoded_, point.vertices[c])]) map[index] += point.weights[c] * value;
    for (std::size_t face = 0; face < 6; ++face) haarInverse(map.data() + face * kSide * kSide, kSide);
    return [this, map = std::move(map)](const Lobe& lobe) {
      double sum = 0.0;
      for (const auto& w : lobe.directions) sum += static_cast<double>(map[grid_->texelAt(w)]);
      return sum / static_cast<double>(lobe.directions.size());
    };
  }

 private:
  std::vector<std::size_t> encoded_;
  std::shared_ptr<const CubeGrid> grid_;
  std::size_t terms_;
  std::vector<std::vector<Coefficient>> stored_;  ///< of each encoded vertex
};

}  // namespace

std::vector<std::unique_ptr<VisibilityMethod>> makeHaarMethods(const VisibilityInput& input, const std::vector<int>& terms) {
  const auto grid = std::make_shared<const CubeGrid>(kSide);
  const auto most = static_cast<std::size_t>(*std::max_element(terms.begin(), terms.end()));
  std::vector<std::vector<Coefficient>> coefficients(input.encoded.size());
  parallelBlocks(input.threads, input.encoded.size(), [&](std::size_t i) {
    std::vector<float> cube;
    traceCube(input.rays, *grid, input.viewpoints[input.encoded[i]], cube);
    for (std::size_t face = 0; face < 6; ++face) haarForward(cube.data() + face * kSide * kSide, kSide);
    coefficients[i] = largest(cube, most);
  });
  std::vector<std::unique_ptr<VisibilityMethod>> methods;
  for (const int count : terms)
    methods.push_back(std::make_unique<HaarMethod>(input, grid, static_cast<std::size_t>(count), coefficients));
  return methods;
}

}  // namespace chiaro
