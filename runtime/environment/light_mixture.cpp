#include "runtime/environment/light_mixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEnvelopeSharpness = 8.0;
constexpr int kEnvelopeClips = 4;
constexpr double kContrast = 1.5;   ///< times the envelope: less is the unevenness of a sky or a wall, not a light
constexpr int kFinestWidth = 2048;  ///< of the blocks: larger images start with several texels a block, to bound memory
constexpr int kCoarsestWidth = 128;
constexpr double kSplitFlux = 1e-4;        ///< a block with a larger share of the excess is looked at in more detail
constexpr double kLeastLightShare = 2e-3;  ///< of the environment's flux
constexpr int kSeedsPerLight = 4;
/// Two lights that differ only at a finer scale than this sharpness cast the same shadow as one: a baked visibility of some
/// degrees a texel cannot tell them apart. Lobes are compared after a blur by it.
constexpr double kShadowSharpness = 500.0;
constexpr double kTwinLoss = 0.03;  ///< likelihood a flux (nats) under which two lobes are one light


glm::dvec3 directionOf(double x, double y, const ImageRgb& map) {
  return lobe64::directionFromEquirect({x / map.width, y / map.height});
}

double rowSolidAngle(int y, const ImageRgb& map) {
  return 2 * kPi / map.width * (std::cos(kPi * y / map.height) - std::cos(kPi * (y + 1) / map.height));
}

/// Luminance in a small equirectangular grid.
struct CoarseMap {
  static constexpr int kWidth = 64, kHeight = 32;
  std::array<double, kWidth * kHeight> values{};
  double& at(int x, int y) { return values[static_cast<std::size_t>(y * kWidth + x)]; }
  double at(int x, int y) const { return values[static_cast<std::size_t>(y * kWidth + x)]; }
};

CoarseMap coarseLuminance(const ImageRgb& map) {
  CoarseMap mean;
  std::array<double, CoarseMap::kWidth * CoarseMap::kHeight> weights{};
  const int stepsX = std::max(1, (CoarseMap::kWidth + map.width - 1) / map.width);
  const int stepsY = std::max(1, (CoarseMap::kHeight + map.height - 1) / map.height);
  for (int y = 0; y < map.height * stepsY; ++y)
    for (int x = 0; x < map.width * stepsX; ++x) {
      const auto to = static_cast<std::size_t>(y * CoarseMap::kHeight / (map.height * stepsY) * CoarseMap::kWidth +
                                               x * CoarseMap::kWidth / (map.width * stepsX));
      const double weight = rowSolidAngle(y / stepsY, map);
      mean.values[to] += weight * luminance(map.at(x / stepsX, y / stepsY));
      weights[to] += weight;
    }
  for (std::size_t i = 0; i < mean.values.size(); ++i) mean.values[i] /= weights[i];
  return mean;
}

/// Blur by a normalised SG; the kernel between two rows depends on the difference in longitude alone.
class CoarseBlur {
 public:
  CoarseBlur() : kernel_(static_cast<std::size_t>(kRows) * kRows * kColumns) {
    for (int a = 0; a < kRows; ++a) {
      double total = 0.0;
      for (int b = 0; b < kRows; ++b)
        for (int d = 0; d < kColumns; ++d) {
          const double ta = (a + 0.5) * kPi / kRows, tb = (b + 0.5) * kPi / kRows;
          const double cosine = std::cos(ta) * std::cos(tb) + std::sin(ta) * std::sin(tb) * std::cos(2 * kPi * d / kColumns);
          total += kernel(a, b)[d] = std::sin(tb) * std::exp(kEnvelopeSharpness * (cosine - 1.0));
        }
      for (int i = 0; i < kRows * kColumns; ++i) kernel(a, 0)[i] /= total;
    }
  }

  CoarseMap operator()(const CoarseMap& map) const {
    CoarseMap result;
    std::array<double, 2 * kColumns> row{};
    for (int b = 0; b < kRows; ++b) {
      for (int x = 0; x < 2 * kColumns; ++x) row[static_cast<std::size_t>(x)] = map.at(x % kColumns, b);
      for (int a = 0; a < kRows; ++a) {
        const double* weights = &kernel_[static_cast<std::size_t>((a * kRows + b) * kColumns)];
        for (int d = 0; d < kColumns; ++d)
          for (int x = 0; x < kColumns; ++x) result.at(x, a) += weights[d] * row[static_cast<std::size_t>(x + d)];
      }
    }
    return result;
  }

 private:
  static constexpr int kRows = CoarseMap::kHeight, kColumns = CoarseMap::kWidth;
  double* kernel(int a, int b) { return &kernel_[static_cast<std::size_t>((a * kRows + b) * kColumns)]; }
  std::vector<double> kernel_;
};

/// Clipped to its own blur again and again, a bright spot sinks to its surroundings while a gradient stays.
CoarseMap lowerEnvelope(const ImageRgb& environment) {
  const CoarseBlur blur;
  CoarseMap clipped = coarseLuminance(environment);
  CoarseMap envelope = blur(clipped);
  for (int i = 0; i < kEnvelopeClips; ++i) {
    for (std::size_t k = 0; k < clipped.values.size(); ++k) clipped.values[k] = std::min(clipped.values[k], envelope.values[k]);
    envelope = blur(clipped);
  }
  return envelope;
}

double bilinear(const CoarseMap& map, double u, double v) {
  const double x = u * CoarseMap::kWidth - 0.5, y = std::clamp(v * CoarseMap::kHeight - 0.5, 0.0, CoarseMap::kHeight - 1.0);
  const int x0 = static_cast<int>(std::floor(x)), y0 = std::min(static_cast<int>(y), CoarseMap::kHeight - 2);
  const double fx = x - x0, fy = y - y0;
  const int left = (x0 + CoarseMap::kWidth) % CoarseMap::kWidth, right = (x0 + 1) % CoarseMap::kWidth;
  return (1 - fy) * ((1 - fx) * map.at(left, y0) + fx * map.at(right, y0)) +
         fy * ((1 - fx) * map.at(left, y0 + 1) + fx * map.at(right, y0 + 1));
}

void add(ExcessPoint& sum, const ExcessPoint& point) {
  sum.resultant += point.resultant;
  sum.flux += point.flux;
  sum.color += point.color;
}

/// Sums over square blocks of texels, finest level first; blocks at the right and lower border may be cut off.
struct BlockLevel {
  int width = 0, height = 0;
  std::vector<ExcessPoint> blocks;
};

std::vector<BlockLevel> blockPyramid(const ImageRgb& environment) {
  const CoarseMap envelope = lowerEnvelope(environment);
  const int texelsABlock = std::max(1, (environment.width + kFinestWidth - 1) / kFinestWidth);
  BlockLevel finest{
      (environment.width + texelsABlock - 1) / texelsABlock, (environment.height + texelsABlock - 1) / texelsABlock, {}};
  finest.blocks.resize(static_cast<std::size_t>(finest.width) * static_cast<std::size_t>(finest.height));
  for (int y = 0; y < environment.height; ++y) {
    const double solidAngle = rowSolidAngle(y, environment);
    const double stepTheta = kPi / environment.height;
    const double stepPhi = 2 * kPi / environment.width * std::sin((y + 0.5) * stepTheta);
    // A texel spreads over its neighbours by linear interpolation: variance step^2/6 along each axis.
    const double ownCosine = std::max(0.0, 1.0 - (stepTheta * stepTheta + stepPhi * stepPhi) / 12.0);
    for (int x = 0; x < environment.width; ++x) {
      const glm::dvec3 radiance(environment.at(x, y));
      const double value = luminance(radiance);
      const double excess = value - kContrast * bilinear(envelope, (x + 0.5) / environment.width, (y + 0.5) / environment.height);
      if (!(excess > 1e-6 * value)) continue;  // rounding of a constant is no light
      const double flux = excess * solidAngle;
      add(finest.blocks[static_cast<std::size_t>(y / texelsABlock) * static_cast<std::size_t>(finest.width) +
                        static_cast<std::size_t>(x / texelsABlock)],
          {flux * ownCosine * directionOf(x + 0.5, y + 0.5, environment), flux, radiance * (flux / value)});
    }
  }
  std::vector<BlockLevel> levels{std::move(finest)};
  while (levels.back().width > kCoarsestWidth) {
    const BlockLevel& fine = levels.back();
    BlockLevel coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    coarse.blocks.resize(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height));
    for (int y = 0; y < fine.height; ++y)
      for (int x = 0; x < fine.width; ++x)
        add(coarse.blocks[static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(coarse.width) +
                          static_cast<std::size_t>(x / 2)],
            fine.blocks[static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.width) + static_cast<std::size_t>(x)]);
    levels.push_back(std::move(coarse));
  }
  return levels;
}

void gather(const std::vector<BlockLevel>& levels, std::size_t level, int x, int y, double splitFlux,
            std::vector<ExcessPoint>& points) {
  const BlockLevel& here = levels[level];
  if (x >= here.width || y >= here.height) return;
  const ExcessPoint& block =
      here.blocks[static_cast<std::size_t>(y) * static_cast<std::size_t>(here.width) + static_cast<std::size_t>(x)];
  if (!(block.flux > 0.0)) return;
  if (level == 0 || block.flux <= splitFlux) {
    points.push_back(block);
    return;
  }
  for (int k = 0; k < 4; ++k) gather(levels, level - 1, 2 * x + (k & 1), 2 * y + (k >> 1), splitFlux, points);
}

/// A vMF lobe of the mixture.
struct Lobe {
  glm::dvec3 axis{0, 0, 1};
  double sharpness = 0.0;
  double flux = 0.0;
};

/// Axis and sharpness that have this resultant per flux (ALGORITHMS 1.8).
Lobe lobeFromResultant(const glm::dvec3& resultant, double flux, double maxSharpness) {
  const double length = glm::length(resultant);
  Lobe lobe;
  lobe.flux = flux;
  if (length > 0.0) lobe.axis = resultant / length;
  lobe.sharpness = std::min(lobe64::vmfSharpnessFromMeanCosine(std::min(length / flux, 1.0)), maxSharpness);
  return lobe;
}

/// Differential entropy of the unit-integral lobe, blurred to what matters for shadows.
double entropy(const Lobe& lobe) {
  const double sharpness = 1.0 / (1.0 / std::max(lobe.sharpness, 1e-6) + 1.0 / kShadowSharpness);
  return -std::log(lobe64::vmfAmplitude(sharpness)) + sharpness * lobe64::oneMinusMeanCosine(sharpness);
}

Lobe merged(const Lobe& a, const Lobe& b, double maxSharpness) {
  const glm::dvec3 resultant =
      a.flux * lobe64::vmfMeanCosine(a.sharpness) * a.axis + b.flux * lobe64::vmfMeanCosine(b.sharpness) * b.axis;
  return lobeFromResultant(resultant, a.flux + b.flux, maxSharpness);
}

class Mixture {
 public:
  Mixture(const std::vector<ExcessPoint>& points, double maxSharpness) : points_(points), maxSharpness_(maxSharpness) {
    for (const ExcessPoint& point : points) totalFlux_ += point.flux;
    background_ = 0.1 * totalFlux_;
  }

  /// Greedy k-means++: always the point that costs most where it is (flux times squared distance to the nearest seed).
  void seed(int count) {
    std::vector<double> distance(points_.size(), 4.0);
    std::vector<std::size_t> owner(points_.size(), 0);
    std::size_t next = 0;
    for (std::size_t i = 1; i < points_.size(); ++i)
      if (points_[i].flux > points_[next].flux) next = i;
    int seeds = 0;
    for (; seeds < count; ++seeds) {
      const glm::dvec3 centre = points_[next].resultant / points_[next].flux;
      double worst = 0.0;
      std::size_t worstAt = next;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const glm::dvec3 offset = points_[i].resultant / points_[i].flux - centre;
        const double squared = glm::dot(offset, offset);
        if (squared < distance[i]) {
          distance[i] = squared;
          owner[i] = static_cast<std::size_t>(seeds);
        }
        if (points_[i].flux * distance[i] > worst) {
          worst = points_[i].flux * distance[i];
          worstAt = i;
        }
      }
      next = worstAt;
      if (!(worst > 0.0)) {
        ++seeds;
        break;
      }
    }
    std::vector<ExcessPoint> sums(static_cast<std::size_t>(seeds));
    for (std::size_t i = 0; i < points_.size(); ++i) add(sums[owner[i]], points_[i]);
    for (const ExcessPoint& sum : sums)
      if (sum.flux > 0.0) lobes_.push_back(lobeFromResultant(sum.resultant, sum.flux, maxSharpness_));
  }

  /// One step of EM. A point counts as the texels it stands for, all with the same share of each lobe.
  void step() {
    std::vector<ExcessPoint> sums = assign();
    lobes_.clear();
    for (const ExcessPoint& sum : sums)
      if (sum.flux > 1e-9 * totalFlux_) lobes_.push_back(lobeFromResultant(sum.resultant, sum.flux, maxSharpness_));
  }

  /// What each lobe is given of every point; the rest goes to the background.
  std::vector<ExcessPoint> assign() {
    struct Term {
      glm::dvec3 axis;
      double sharpness, logScale;
    };
    std::vector<Term> terms;
    for (const Lobe& lobe : lobes_)
      terms.push_back({lobe.axis, lobe.sharpness, std::log(lobe.flux * lobe64::vmfAmplitude(lobe.sharpness))});
    const double background = background_ / (4 * kPi);
    std::vector<double> share(terms.size());
    std::vector<ExcessPoint> sums(terms.size());
    double toBackground = 0.0;
    for (const ExcessPoint& point : points_) {
      const glm::dvec3 centre = point.resultant / point.flux;
      double total = background;
      for (std::size_t k = 0; k < terms.size(); ++k) {
        const double exponent = terms[k].logScale + terms[k].sharpness * (glm::dot(terms[k].axis, centre) - 1.0);
        total += share[k] = exponent > logTiny_ ? std::exp(exponent) : 0.0;
      }
      if (!(total > 0.0)) continue;
      for (std::size_t k = 0; k < terms.size(); ++k) {
        if (share[k] == 0.0) continue;
        const double part = share[k] / total;
        sums[k].resultant += part * point.resultant;
        sums[k].flux += part * point.flux;
        sums[k].color += part * point.color;
      }
      toBackground += background / total * point.flux;
    }
    background_ = toBackground;
    return sums;
  }

  /// Joins the two lobes, or gives up the one, whose loss changes the mixture's likelihood least (Runnalls 2007, for vMF), if
  /// that is less than `bound` times the flux they have. Only pairs with at least one lobe as sharp as a light are looked at.
  bool simplify(double minLightSharpness, double bound = std::numeric_limits<double>::infinity()) {
    double least = std::numeric_limits<double>::infinity();
    bool found = false;
    std::size_t first = 0, second = 0;  // equal: give up that one
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
      if (lobes_[i].sharpness >= minLightSharpness) {
        const double cost = lobes_[i].flux * (std::log(4 * kPi) - entropy(lobes_[i]));
        if (cost < least && cost < bound * lobes_[i].flux) {
          least = cost;
          first = second = i;
          found = true;
        }
      }
      for (std::size_t j = i + 1; j < lobes_.size(); ++j) {
        if (lobes_[i].sharpness < minLightSharpness && lobes_[j].sharpness < minLightSharpness) continue;
        const Lobe joint = merged(lobes_[i], lobes_[j], maxSharpness_);
        const double cost =
            joint.flux * entropy(joint) - lobes_[i].flux * entropy(lobes_[i]) - lobes_[j].flux * entropy(lobes_[j]);
        if (cost < least && cost < bound * joint.flux) {
          least = cost;
          first = i;
          second = j;
          found = true;
        }
      }
    }
    if (!found) return false;
    if (first == second)
      background_ += lobes_[first].flux;
    else
      lobes_[first] = merged(lobes_[first], lobes_[second], maxSharpness_);
    lobes_.erase(lobes_.begin() + static_cast<std::ptrdiff_t>(second));
    return true;
  }

  int lightCount(double minLightSharpness) const {
    return static_cast<int>(
        std::count_if(lobes_.begin(), lobes_.end(), [&](const Lobe& lobe) { return lobe.sharpness >= minLightSharpness; }));
  }
  const std::vector<Lobe>& lobes() const { return lobes_; }

 private:
  static constexpr double logTiny_ = -80.0;
  const std::vector<ExcessPoint>& points_;
  double maxSharpness_;
  double totalFlux_ = 0.0;
  double background_ = 0.0;
  std::vector<Lobe> lobes_;
};

void steps(Mixture& mixture, int count) {
  for (int i = 0; i < count; ++i) mixture.step();
}

}  // namespace

std::vector<ExcessPoint> excessPoints(const ImageRgb& environment) {
  const std::vector<BlockLevel> levels = blockPyramid(environment);
  double total = 0.0;
  for (const ExcessPoint& block : levels.back().blocks) total += block.flux;
  std::vector<ExcessPoint> points;
  for (int y = 0; y < levels.back().height; ++y)
    for (int x = 0; x < levels.back().width; ++x) gather(levels, levels.size() - 1, x, y, kSplitFlux * total, points);
  return points;
}

std::vector<SgLight> fitLights(const ImageRgb& environment, const SgEnvironmentSettings& settings) {
  double environmentFlux = 0.0;
  for (int y = 0; y < environment.height; ++y)
    for (int x = 0; x < environment.width; ++x)
      environmentFlux += luminance(environment.at(x, y)) * rowSolidAngle(y, environment);
  const std::vector<ExcessPoint> points = excessPoints(environment);
  double excessFlux = 0.0;
  for (const ExcessPoint& point : points) excessFlux += point.flux;
  if (settings.lightCount <= 0 || !(excessFlux > kLeastLightShare * environmentFlux)) return {};

  Mixture mixture(points, settings.maxLightSharpness);
  mixture.seed(kSeedsPerLight * settings.lightCount);
  steps(mixture, 6);
  while (mixture.lightCount(settings.minLightSharpness) > settings.lightCount) {
    if (!mixture.simplify(settings.minLightSharpness)) break;
    if (mixture.lightCount(settings.minLightSharpness) % 6 == 0) steps(mixture, 2);
  }
  steps(mixture, 20);
  while (mixture.simplify(settings.minLightSharpness, kTwinLoss)) {
  }
  steps(mixture, 3);

  const std::vector<ExcessPoint> sums = mixture.assign();
  std::vector<SgLight> lights;
  std::vector<std::pair<double, SgLight>> byFlux;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (!(sums[k].flux > kLeastLightShare * environmentFlux)) continue;
    const Lobe lobe = lobeFromResultant(sums[k].resultant, sums[k].flux, settings.maxLightSharpness);
    if (lobe.sharpness < settings.minLightSharpness) continue;
    const glm::dvec3 amplitude = sums[k].color * lobe64::vmfAmplitude(lobe.sharpness);
    byFlux.push_back({sums[k].flux, {glm::vec3(lobe.axis), static_cast<float>(lobe.sharpness), glm::vec3(amplitude)}});
  }
  std::stable_sort(byFlux.begin(), byFlux.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (byFlux.size() > static_cast<std::size_t>(settings.lightCount)) byFlux.resize(static_cast<std::size_t>(settings.lightCount));
  for (const auto& [flux, light] : byFlux) lights.push_back(light);
  return lights;
}

}  // namespace chiaro
