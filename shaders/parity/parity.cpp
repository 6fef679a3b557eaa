#include "shaders/parity/parity.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <sstream>

namespace chiaro::parity {
namespace {

/// Distance in representable floats.
std::int64_t ulps(float a, float b) {
  const auto ordered = [](float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    return bits < 0 ? std::int64_t{INT32_MIN} - bits : std::int64_t{bits};
  };
  return std::abs(ordered(a) - ordered(b));
}

/// From a positive number to the next float.
double stepAt(double size) {
  const auto at = static_cast<float>(size);
  return static_cast<double>(std::nextafter(at, std::numeric_limits<float>::infinity())) - static_cast<double>(at);
}

std::string describe(const Case& c, const std::vector<double>& expected, const std::vector<float>& got, std::size_t sample, int output) {
  std::ostringstream text;
  text.precision(9);
  const std::size_t at = sample * static_cast<std::size_t>(c.outputCount) + static_cast<std::size_t>(output);
  text << "    sample " << sample << ", input";
  for (int i = 0; i < c.inputCount; ++i) text << ' ' << c.inputs[sample * static_cast<std::size_t>(c.inputCount) + static_cast<std::size_t>(i)];
  text << "; output " << output << " expected " << expected[at] << " got " << got[at];
  if (std::isfinite(expected[at]) && std::isfinite(got[at])) text << " (" << ulps(got[at], static_cast<float>(expected[at])) << " ulps)";
  text << '\n';
  return text.str();
}

enum class Class { finite, nan, plusInfinity, minusInfinity };

Class classify(double x) {
  if (std::isnan(x)) return Class::nan;
  // A double beyond float's range must come out as infinity in float.
  if (x > 3.4028235677973366e38) return Class::plusInfinity;
  if (x < -3.4028235677973366e38) return Class::minusInfinity;
  return Class::finite;
}

}  // namespace

std::vector<double> runDouble(const Case& c) {
  std::vector<double> out;
  for (std::size_t s = 0; s < c.sampleCount(); ++s) {
    lobe64::KernelInput in{};
    for (int i = 0; i < c.inputCount; ++i) in.v[i] = c.inputs[s * static_cast<std::size_t>(c.inputCount) + static_cast<std::size_t>(i)];
    double y[25] = {};
    c.run64(in, y);
    out.insert(out.end(), y, y + c.outputCount);
  }
  return out;
}

std::vector<float> runFloat(const Case& c) {
  std::vector<float> out;
  for (std::size_t s = 0; s < c.sampleCount(); ++s) {
    lobe32::KernelInput in{};
    for (int i = 0; i < c.inputCount; ++i) in.v[i] = c.inputs[s * static_cast<std::size_t>(c.inputCount) + static_cast<std::size_t>(i)];
    float y[25] = {};
    c.run32(in, y);
    out.insert(out.end(), y, y + c.outputCount);
  }
  return out;
}

Comparison compare(const Case& c, const std::vector<double>& expected, const std::vector<float>& got, const std::string& label) {
  Comparison result;
  result.samples = c.sampleCount();
  const auto outputs = static_cast<std::size_t>(c.outputCount);
  if (got.size() != expected.size() || expected.size() != result.samples * outputs) {
    result.failures = result.samples;
    result.report = c.name + ": " + label + " returned the wrong number of values\n";
    return result;
  }
  std::vector<double> errors;
  errors.reserve(result.samples * c.groups.size());
  for (std::size_t s = 0; s < result.samples; ++s) {
    const double floor = kFloor * c.scale(&c.inputs[s * static_cast<std::size_t>(c.inputCount)]);
    bool nanInput = false, infiniteInput = false;
    for (int i = 0; i < c.inputCount; ++i) {
      const float in = c.inputs[s * static_cast<std::size_t>(c.inputCount) + static_cast<std::size_t>(i)];
      nanInput = nanInput || std::isnan(in);
      infiniteInput = infiniteInput || std::isinf(in);
    }
    for (const Group& group : c.groups) {
      double error2 = 0.0, size2 = 0.0;
      bool finite = true, sameClass = true;
      for (int k = group.first; k < group.first + group.size; ++k) {
        const std::size_t at = s * outputs + static_cast<std::size_t>(k);
        const Class wanted = classify(expected[at]);
        const Class found = classify(got[at]);
        // NaN in, NaN out. From an infinite input or an overflow any non-finite answer will do: never a plausible number.
        const bool same = wanted == Class::finite ? found == Class::finite
                          : wanted == Class::nan && nanInput && !infiniteInput ? found == Class::nan
                                                             : found != Class::finite;
        sameClass = sameClass && same;
        finite = finite && wanted == Class::finite;
        const double difference = static_cast<double>(got[at]) - expected[at];
        error2 += difference * difference;
        size2 += expected[at] * expected[at];
      }
      if (!sameClass) {
        if (result.classFailures++ == 0) result.firstClassFailure = s;
        ++result.failures;
        continue;
      }
      if (!finite) continue;
      const double error = std::sqrt(error2) / std::max(std::sqrt(size2), floor);
      if (!(error <= c.tolerance)) ++result.failures;
      if (!(error <= result.worst)) {
        result.worst = error;
        result.worstSample = s;
        result.worstOutput = group.first;
        result.worstUlps = std::sqrt(error2) / stepAt(std::max(std::sqrt(size2), floor));
      }
      errors.push_back(error);
    }
  }
  std::sort(errors.begin(), errors.end());
  if (!errors.empty()) {
    result.median = errors[errors.size() / 2];
    result.percentile99 = errors[errors.size() * 99 / 100];
  }
  char line[256];
  std::snprintf(line, sizeof line, "%-28s %-10s %8zu samples  median %.1e  99%% %.1e  worst %.2e  failures %zu (%zu NaN/inf)\n", c.name.c_str(),
                label.c_str(), result.samples, result.median, result.percentile99, result.worst, result.failures, result.classFailures);
  result.report = line + ("    domain: " + c.domain) + "\n";
  if (!errors.empty()) result.report += describe(c, expected, got, result.worstSample, result.worstOutput);
  if (result.classFailures > 0) {
    for (int k = 0; k < c.outputCount; ++k) {
      const std::size_t at = result.firstClassFailure * outputs + static_cast<std::size_t>(k);
      if (classify(expected[at]) != classify(got[at])) result.report += describe(c, expected, got, result.firstClassFailure, k);
    }
  }
  return result;
}

}  // namespace chiaro::parity
