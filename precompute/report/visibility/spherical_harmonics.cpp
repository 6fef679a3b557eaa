#include "precompute/report/visibility/spherical_harmonics.h"

#include <cmath>
#include <numbers>

namespace chiaro {

void evaluateSh(glm::dvec3 w, int bands, double* out) {
  // legendre: P_l^m over sin^m, normalised; (cosine, sine): sin^m times cos and sin of m phi, so that the pole needs no care.
  double diagonal = std::sqrt(0.25 / std::numbers::pi), cosine = 1.0, sine = 0.0;
  for (int m = 0; m < bands; ++m) {
    if (m > 0) {
      diagonal *= std::sqrt((2.0 * m + 1.0) / (2.0 * m));
      const double next = cosine * w.x - sine * w.y;
      sine = sine * w.x + cosine * w.y;
      cosine = next;
    }
    double before = 0.0, legendre = diagonal;
    for (int l = m; l < bands; ++l) {
      if (l > m) {
        const double l2 = l * l, m2 = m * m, previous = (l - 1.0) * (l - 1.0);
        const double a = std::sqrt((4.0 * l2 - 1.0) / (l2 - m2));
        const double next =
            a * (w.z * legendre - (l > m + 1 ? std::sqrt((previous - m2) / (4.0 * previous - 1.0)) * before : 0.0));
        before = legendre;
        legendre = next;
      }
      const int center = l * (l + 1);
      if (m == 0) {
        out[center] = legendre;
      } else {
        out[center + m] = std::numbers::sqrt2 * legendre * cosine;
        out[center - m] = std::numbers::sqrt2 * legendre * sine;
      }
    }
  }
}

std::vector<double> lobeBands(double sharpness, int bands) {
  // A wrong start is forgotten by a factor of exp(-2 l / sharpness) a step.
  const int from = bands + 20 + static_cast<int>(8.0 * std::sqrt(sharpness));
  std::vector<double> ratio(static_cast<std::size_t>(bands), 0.0);
  double r = 0.0;  // I_{l+3/2} / I_{l+1/2}
  for (int l = from; l >= 0; --l) {
    r = 1.0 / ((2.0 * l + 3.0) / sharpness + r);
    if (l < bands) ratio[static_cast<std::size_t>(l)] = r;
  }
  std::vector<double> bandsOut(static_cast<std::size_t>(bands), 1.0);
  for (std::size_t l = 1; l < bandsOut.size(); ++l) bandsOut[l] = bandsOut[l - 1] * ratio[l - 1];
  return bandsOut;
}

}  // namespace chiaro
