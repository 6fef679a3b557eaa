#pragma once
/// Numerical integration in double, by methods the library does not use: the independent side of the lobe tests.

#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace chiaro::quadrature {

inline constexpr double kPi = 3.14159265358979323846;

struct Rule {
  std::vector<double> node, weight;  ///< on [-1, 1]
};

/// Gauss-Legendre by Newton's method on P_n.
inline Rule gaussLegendre(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 100; ++step) {
      double p0 = 1.0, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1);
      const double delta = p1 / slope;
      x -= delta;
      if (std::abs(delta) < 1e-16) break;
    }
    rule.node.push_back(x);
    rule.weight.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// Integral of f over [a, b] by 20-point Gauss on `pieces` equal pieces.
template <class F>
double integrate(F f, double a, double b, int pieces) {
  static const Rule rule = gaussLegendre(20);
  double sum = 0;
  const double h = (b - a) / pieces;
  for (int p = 0; p < pieces; ++p) {
    for (std::size_t i = 0; i < rule.node.size(); ++i) sum += rule.weight[i] * f(a + h * (p + 0.5 + 0.5 * rule.node[i]));
  }
  return 0.5 * h * sum;
}

/// e^-x I0(x), x >= 0: the mean of exp(x (cos phi - 1)), by the trapezoid rule (exponentially exact for periodic functions);
/// above 200 the asymptotic series, whose first dropped term is below 1e-13 there.
inline double besselI0Scaled(double x) {
  if (x > 200) {
    double term = 1, sum = 1;
    for (int k = 1; k <= 6; ++k) sum += term *= (2 * k - 1) * (2 * k - 1) / (8 * k * x);
    return sum / std::sqrt(2 * kPi * x);
  }
  const int n = 64 + static_cast<int>(8 * std::sqrt(x));
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double s = std::sin(kPi * (i + 0.5) / n);
    sum += std::exp(-2 * x * s * s);
  }
  return sum / n;
}

/// Integral over a hemisphere-like band theta in [from, to] about a pole at angle beta from the lobe's axis, of
/// exp(sharpness (cos - 1)) * weight(theta): polar coordinates about the pole, azimuth in closed form.
template <class F>
double lobeAboutPole(double sharpness, double beta, double from, double to, F weight) {
  const auto integrand = [&](double theta) {
    const double half = std::sin(0.5 * (theta - beta));
    const double azimuth = besselI0Scaled(sharpness * std::abs(std::sin(beta) * std::sin(theta)));
    return std::sin(theta) * weight(theta) * std::exp(-2 * sharpness * half * half) * azimuth;
  };
  const double reach = sharpness > 0 ? 12 / std::sqrt(sharpness) : 10.0;
  const double low = std::max(from, beta - reach), high = std::min(to, beta + reach);
  return low < high ? 2 * kPi * integrate(integrand, low, high, 12) : 0.0;
}

/// Integral of f over the unit sphere: Gauss in z, trapezoid in azimuth.
template <class F>
double sphere(F f, int polar = 200, int azimuths = 400) {
  const Rule rule = gaussLegendre(polar);
  double sum = 0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double z = rule.node[i], s = std::sqrt((1 - z) * (1 + z));
    for (int k = 0; k < azimuths; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / azimuths;
      sum += rule.weight[i] * f(glm::dvec3(s * std::cos(phi), s * std::sin(phi), z));
    }
  }
  return sum * 2 * kPi / azimuths;
}

}  // namespace chiaro::quadrature
