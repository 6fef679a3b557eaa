#pragma once
/// A million random combinations of reflectance model, parameters at their ends, grazing and hidden directions and lights of any strength: what comes out
/// must be finite and never negative.

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "shaders/parity/parity.h"

namespace chiaro::parity {

/// Kernel modelRadiance: widths 1e-4 to 1, exponents 1 to 1e6, F0 0 to 1, intensities 1e-6 to 1e6; a third of the parameters at an end. Deterministic.
Case extremeModels();

template <typename Scalar>
bool isBad(Scalar radiance) {
  return !(std::isfinite(radiance) && radiance >= Scalar(0));
}

template <typename Scalar>
std::size_t countBad(const std::vector<Scalar>& radiance) {
  std::size_t bad = 0;
  for (const auto value : radiance) bad += isBad(value);
  return bad;
}

/// Values above 0: that the test is of something.
template <typename Scalar>
std::size_t countLit(const std::vector<Scalar>& radiance) {
  std::size_t lit = 0;
  for (const auto value : radiance) lit += value > Scalar(0);
  return lit;
}

/// The inputs of the first bad value, for a failure's message.
template <typename Scalar>
std::string firstBad(const Case& c, const std::vector<Scalar>& radiance) {
  std::ostringstream text;
  text.precision(9);
  const auto outputs = static_cast<std::size_t>(c.outputCount), inputs = static_cast<std::size_t>(c.inputCount);
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    if (!isBad(radiance[i])) continue;
    text << "output " << i % outputs << " is " << radiance[i] << " of";
    for (std::size_t k = 0; k < inputs; ++k) text << ' ' << c.inputs[i / outputs * inputs + k];
    break;
  }
  return text.str();
}

}  // namespace chiaro::parity
