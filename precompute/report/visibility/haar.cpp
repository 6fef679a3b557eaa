#include "precompute/report/visibility/haar.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace chiaro {
namespace {

/// One level: 2x2 blocks of the top left n x n of `image` become mean-like and three detail coefficients, and back.
/// The same butterfly both ways: it is its own inverse.
void butterfly(float& a, float& b, float& c, float& d) {
  const float mean = 0.5f * (a + b + c + d), dx = 0.5f * (a - b + c - d), dy = 0.5f * (a + b - c - d),
              dxy = 0.5f * (a - b - c + d);
  a = mean;
  b = dx;
  c = dy;
  d = dxy;
}

}  // namespace

void haarForward(float* image, int side) {
  const auto stride = static_cast<std::size_t>(side);
  std::vector<float> level(stride * stride);
  for (std::size_t n = stride; n > 1; n /= 2) {
    const auto half = n / 2;
    for (std::size_t j = 0; j < half; ++j)
      for (std::size_t i = 0; i < half; ++i) {
        const float* block = image + 2 * j * stride + 2 * i;
        float a = block[0], b = block[1], c = block[stride], d = block[stride + 1];
        butterfly(a, b, c, d);
        level[j * n + i] = a;
        level[j * n + i + half] = b;
        level[(j + half) * n + i] = c;
        level[(j + half) * n + i + half] = d;
      }
    for (std::size_t j = 0; j < n; ++j) std::copy_n(level.begin() + static_cast<std::ptrdiff_t>(j * n), n, image + j * stride);
  }
}

void haarInverse(float* image, int side) {
  const auto stride = static_cast<std::size_t>(side);
  std::vector<float> level(stride * stride);
  for (std::size_t n = 2; n <= stride; n *= 2) {
    const auto half = n / 2;
    for (std::size_t j = 0; j < half; ++j)
      for (std::size_t i = 0; i < half; ++i) {
        float a = image[j * stride + i], b = image[j * stride + i + half], c = image[(j + half) * stride + i],
              d = image[(j + half) * stride + i + half];
        butterfly(a, b, c, d);
        level[2 * j * n + 2 * i] = a;
        level[2 * j * n + 2 * i + 1] = b;
        level[(2 * j + 1) * n + 2 * i] = c;
        level[(2 * j + 1) * n + 2 * i + 1] = d;
      }
    for (std::size_t j = 0; j < n; ++j) std::copy_n(level.begin() + static_cast<std::ptrdiff_t>(j * n), n, image + j * stride);
  }
}

CubeGrid::CubeGrid(int faceSide)
    : side(faceSide),
      texelCount(6 * static_cast<std::size_t>(faceSide) * static_cast<std::size_t>(faceSide)),
      x(texelCount),
      y(texelCount),
      z(texelCount) {
  std::size_t t = 0;
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i, ++t) {
        glm::dvec3 w(0.0);
        const int axis = face / 2;
        w[axis] = face % 2 == 0 ? 1.0 : -1.0;
        w[(axis + 1) % 3] = (2.0 * i + 1.0) / side - 1.0;
        w[(axis + 2) % 3] = (2.0 * j + 1.0) / side - 1.0;
        w = glm::normalize(w);
        x[t] = static_cast<float>(w.x);
        y[t] = static_cast<float>(w.y);
        z[t] = static_cast<float>(w.z);
      }
}

std::size_t CubeGrid::texelAt(glm::vec3 w) const {
  const auto magnitude = glm::abs(w);
  const int axis = magnitude.x >= magnitude.y && magnitude.x >= magnitude.z ? 0 : magnitude.y >= magnitude.z ? 1 : 2;
  const float scale = 0.5f * static_cast<float>(side) / magnitude[axis];
  const auto texel = [&](float value) {
    return std::clamp(static_cast<int>(value * scale + 0.5f * static_cast<float>(side)), 0, side - 1);
  };
  const int face = 2 * axis + (w[axis] < 0.0f ? 1 : 0);
  const int i = texel(w[(axis + 1) % 3]), j = texel(w[(axis + 2) % 3]);
  return static_cast<std::size_t>((face * side + j) * side + i);
}

}  // namespace chiaro
