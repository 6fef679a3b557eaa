#include "precompute/report/metrics/flip_color.h"

#include <cmath>

namespace chiaro::flip {
namespace {

constexpr double kColorExponent = 0.7;         // q_c
constexpr double kTurn = 0.4, kTurned = 0.95;  // p_c, p_t

// sRGB primaries and D65 as exact fractions; rows X, Y, Z.
constexpr double kRgbToXyz[3][3] = {{10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
                                    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
                                    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};

/// XYZ over that of white.
glm::dmat3 whiteRelative() {
  glm::dmat3 m(0.0);  // column-major
  for (int row = 0; row < 3; ++row) {
    const double white = kRgbToXyz[row][0] + kRgbToXyz[row][1] + kRgbToXyz[row][2];
    for (int column = 0; column < 3; ++column) m[column][row] = kRgbToXyz[row][column] / white;
  }
  return m;
}

const glm::dmat3 kToRelativeXyz = whiteRelative();
const glm::dmat3 kFromRelativeXyz = glm::inverse(kToRelativeXyz);

glm::dvec3 opponent(const glm::dvec3& v) { return {116.0 * v.y - 16.0, 500.0 * (v.x - v.y), 200.0 * (v.y - v.z)}; }

double labCurve(double t) {
  constexpr double kDelta = 6.0 / 29.0;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

}  // namespace

glm::dvec3 yCxCzFromLinear(const glm::dvec3& rgb) { return opponent(kToRelativeXyz * rgb); }

glm::dvec3 linearFromYCxCz(const glm::dvec3& yCxCz) {
  const double y = (yCxCz.x + 16.0) / 116.0;
  return kFromRelativeXyz * glm::dvec3(y + yCxCz.y / 500.0, y, y - yCxCz.z / 200.0);
}

glm::dvec3 huntLabFromLinear(const glm::dvec3& rgb) {
  const glm::dvec3 v = kToRelativeXyz * rgb;
  const glm::dvec3 lab = opponent({labCurve(v.x), labCurve(v.y), labCurve(v.z)});
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

double colorDistance(const glm::dvec3& huntLab, const glm::dvec3& otherHuntLab) {
  const glm::dvec3 d = huntLab - otherHuntLab;
  return std::pow(std::abs(d.x) + std::hypot(d.y, d.z), kColorExponent);
}

double remappedDistance(double distance) {
  static const double largest = colorDistance(huntLabFromLinear({0, 1, 0}), huntLabFromLinear({0, 0, 1}));
  const double turn = kTurn * largest;
  if (distance < turn) return kTurned / turn * distance;
  return kTurned + (distance - turn) / (largest - turn) * (1.0 - kTurned);
}

}  // namespace chiaro::flip
