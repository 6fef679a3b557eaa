#include "precompute/reference/environment_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chiaro::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// Where a fraction falls in an increasing list from 0 to 1: the interval and the position within it.
template <class T>
std::pair<int, double> invert(const T* cumulative, int count, double random) {
  const T* end = cumulative + count + 1;
  const T* above = std::upper_bound(cumulative, end, static_cast<T>(random));
  const int index = std::clamp(static_cast<int>(above - cumulative) - 1, 0, count - 1);
  const double low = static_cast<double>(cumulative[index]);
  const double share = static_cast<double>(cumulative[index + 1]) - low;
  return {index, share > 0.0 ? std::clamp((random - low) / share, 0.0, 1.0) : 0.5};
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment, const glm::mat3& worldFromEnvironment)
    : environment_(&environment),
      worldFromEnvironment_(worldFromEnvironment),
      width_(environment.radiance.width),
      height_(environment.radiance.height) {
  const ImageRgb& image = environment.radiance;
  const auto brightness = [&](int x, int y) {
    const glm::dvec3 value(image.at((x + width_) % width_, std::clamp(y, 0, height_ - 1)));
    return value.x + value.y + value.z;
  };
  for (int y = 0; y <= height_; ++y) cosines_.push_back(std::cos(kPi * y / height_));
  rows_.assign(static_cast<std::size_t>(height_) + 1, 0.0);
  columns_.assign(static_cast<std::size_t>(height_) * (static_cast<std::size_t>(width_) + 1), 0.0f);
  std::vector<double> vertical(static_cast<std::size_t>(width_));
  std::vector<double> sums(static_cast<std::size_t>(width_) + 1);
  for (int y = 0; y < height_; ++y) {
    // The mean over a texel of a bilinear interpolant weighs each axis by 1/8, 6/8, 1/8.
    for (int x = 0; x < width_; ++x)
      vertical[static_cast<std::size_t>(x)] = (brightness(x, y - 1) + 6.0 * brightness(x, y) + brightness(x, y + 1)) / 8.0;
    for (int x = 0; x < width_; ++x) {
      const double left = vertical[static_cast<std::size_t>((x + width_ - 1) % width_)];
      const double right = vertical[static_cast<std::size_t>((x + 1) % width_)];
      sums[static_cast<std::size_t>(x) + 1] =
          sums[static_cast<std::size_t>(x)] + (left + 6.0 * vertical[static_cast<std::size_t>(x)] + right) / 8.0;
    }
    const double rowSum = sums.back();
    float* row = &columns_[static_cast<std::size_t>(y) * sums.size()];
    if (rowSum > 0.0) std::ranges::transform(sums, row, [&](double sum) { return static_cast<float>(sum / rowSum); });
    total_ += rowSum * (cosines_[static_cast<std::size_t>(y)] - cosines_[static_cast<std::size_t>(y) + 1]);
    rows_[static_cast<std::size_t>(y) + 1] = total_;
  }
  if (total_ > 0.0) {
    for (double& row : rows_) row /= total_;
  }
}

glm::dvec2 EnvironmentSampler::texelCoordinates(glm::dvec3 direction) const {
  const glm::dvec3 w = direction * worldFromEnvironment_;  // v * M = transpose(M) * v
  const double u = 0.5 + std::atan2(w.x, -w.z) / (2.0 * kPi);
  const double v = std::atan2(std::hypot(w.x, w.z), w.y) / kPi;  // acos(w.y), accurate at the poles
  return {u * width_, v * height_};
}

EnvironmentSampler::Light EnvironmentSampler::at(glm::dvec3 direction) const {
  const glm::dvec2 place = texelCoordinates(direction);
  return {bilinear(place), density(place)};
}

glm::dvec3 EnvironmentSampler::bilinear(glm::dvec2 texelCoordinates) const {
  const glm::dvec2 at = texelCoordinates - 0.5;
  const glm::dvec2 corner = glm::floor(at);
  const glm::dvec2 f = at - corner;
  const int left = (static_cast<int>(corner.x) + width_) % width_;
  const int right = (left + 1) % width_;
  const int top = std::clamp(static_cast<int>(corner.y), 0, height_ - 1);
  const int bottom = std::clamp(static_cast<int>(corner.y) + 1, 0, height_ - 1);
  const ImageRgb& image = environment_->radiance;
  return glm::mix(glm::mix(glm::dvec3(image.at(left, top)), glm::dvec3(image.at(right, top)), f.x),
                  glm::mix(glm::dvec3(image.at(left, bottom)), glm::dvec3(image.at(right, bottom)), f.x), f.y);
}

glm::dvec3 EnvironmentSampler::sample(glm::dvec2 random) const {
  const auto [row, rowPosition] = invert(rows_.data(), height_, random.y);
  const auto [column, columnPosition] = invert(cumulative(row), width_, random.x);
  const double cosine =
      std::lerp(cosines_[static_cast<std::size_t>(row)], cosines_[static_cast<std::size_t>(row) + 1], rowPosition);
  const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
  const double azimuth = 2.0 * kPi * ((column + columnPosition) / width_ - 0.5);
  return worldFromEnvironment_ * glm::dvec3(sine * std::sin(azimuth), cosine, -sine * std::cos(azimuth));
}

double EnvironmentSampler::density(glm::dvec2 at) const {
  if (!anyLight()) return 0.0;
  const int column = std::clamp(static_cast<int>(at.x), 0, width_ - 1);
  const int row = std::clamp(static_cast<int>(at.y), 0, height_ - 1);
  // The differences of the stored lists, so that this is the density of `sample` exactly, rounding included.
  const double rowShare = rows_[static_cast<std::size_t>(row) + 1] - rows_[static_cast<std::size_t>(row)];
  const double columnShare = static_cast<double>(cumulative(row)[column + 1]) - static_cast<double>(cumulative(row)[column]);
  const double solidAngle =
      2.0 * kPi / width_ * (cosines_[static_cast<std::size_t>(row)] - cosines_[static_cast<std::size_t>(row) + 1]);
  return rowShare * columnShare / solidAngle;
}

}  // namespace chiaro::reference
