#include "precompute/material/ngan_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>

#include "assets/error.h"
#include "precompute/material/abc_model.h"
#include "precompute/material/csv_file.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

constexpr const char* kNames[] = {"Ward", "WardDuer", "BlinnPhong", "LafortuneIso", "CookTorrance", "AshikhminShirley"};

Vec3 colour(const std::string& text, const std::string& where, std::size_t line) {
  if (text.size() < 2 || text.front() != '(' || text.back() != ')')
    throw inputError(where + ":" + std::to_string(line), "scale \"" + text + "\" is not (r,g,b)",
                     "write three numbers in brackets");
  std::stringstream parts(text.substr(1, text.size() - 2));
  std::string part;
  std::vector<double> numbers;
  while (std::getline(parts, part, ',')) numbers.push_back(csvNumber(part, where, line));
  if (numbers.size() != 3)
    throw inputError(where + ":" + std::to_string(line), "scale \"" + text + "\" has not three numbers", "write (r,g,b)");
  return Vec3(numbers[0], numbers[1], numbers[2]);
}

}  // namespace

const char* nganName(NganFamily family) { return kNames[static_cast<std::size_t>(family)]; }

double nganLobe(const NganLobe& l, const Vec3& wo, const Vec3& wi) {
  if (!(wo.z > 0.0) || !(wi.z > 0.0)) return 0.0;
  if (l.family == NganFamily::lafortune) {
    const double base = l.cxy * (wo.x * wi.x + wo.y * wi.y) + l.cz * wo.z * wi.z;
    return base > 0.0 ? std::pow(base, l.width) : 0.0;
  }
  const Vec3 wh = lobe64::halfVector(wo, wi);
  const double cos2 = std::max(wh.z * wh.z, 1e-12), tan2 = (wh.x * wh.x + wh.y * wh.y) / cos2;
  if (nganHasExponent(l.family)) {
    const double power = std::exp(-0.5 * l.width * std::log1p(tan2));  // c^n
    if (l.family == NganFamily::blinnPhong) return (l.width + 2.0) / lobe64::kTwoPi * power;
    return (l.width + 1.0) / (2.0 * lobe64::kFourPi) * power / (std::max(dot(wo, wh), 1e-9) * std::max(wo.z, wi.z));
  }
  const double gaussian = std::exp(-tan2 / (l.width * l.width)) / (lobe64::kPi * l.width * l.width);
  if (l.family == NganFamily::ward) return 0.25 * gaussian / std::sqrt(wo.z * wi.z);
  if (l.family == NganFamily::wardDuer) return 0.25 * gaussian / (wo.z * wi.z);
  return 0.25 * grooveMasking(wo, wi, wh) * gaussian / (cos2 * cos2 * wo.z * wi.z);
}

ReflectanceFunction nganReflectance(const NganModel& model) {
  return [model](const Vec3& wo, const Vec3& wi) {
    if (!(wo.z > 0.0) || !(wi.z > 0.0)) return Vec3(0.0);
    const double w = lobe64::fresnelSchlickWeight(dot(wo, lobe64::halfVector(wo, wi)));
    Vec3 rho = model.diffuse / lobe64::kPi;
    for (const NganLobe& l : model.lobes)
      rho += l.scale * (nganLobe(l, wo, wi) * (nganHasFresnel(l.family) ? l.f0 + (1.0 - l.f0) * w : 1.0));
    return rho;
  };
}

NganModel parseNganModel(const std::string& text, const std::string& where, std::size_t line) {
  const std::string place = where + ":" + std::to_string(line);
  NganModel model;
  std::stringstream parts(text);
  std::string part;
  while (std::getline(parts, part, '|')) {
    std::istringstream words(part);
    std::string name, word;
    words >> name;
    std::map<std::string, std::string> values;
    while (words >> word) {
      const auto equals = word.find('=');
      if (equals == std::string::npos) throw inputError(place, "\"" + word + "\" is not NAME=VALUE", "write such as m=0.2");
      values[word.substr(0, equals)] = word.substr(equals + 1);
    }
    const auto number = [&](const std::string& key, double least, double most) {
      if (!values.contains(key)) throw inputError(place, name + " has no " + key, "write such as " + key + "=0.2");
      const double value = csvNumber(values[key], where, line);
      if (!(value >= least && value <= most))
        throw inputError(place, name + " has " + key + "=" + values[key], "keep it in range");
      return value;
    };
    if (!values.contains("scale")) throw inputError(place, "\"" + name + "\" has no scale", "write scale=(r,g,b)");
    const Vec3 scale = colour(values["scale"], where, line);
    if (name == "Lambertian") {
      model.diffuse = scale;
      continue;
    }
    const auto* known = std::find(std::begin(kNames), std::end(kNames), name);
    if (known == std::end(kNames))
      throw inputError(place, "the lobe \"" + name + "\" is not known",
                       "use Ward, WardDuer, BlinnPhong, LafortuneIso, CookTorrance or AshikhminShirley");
    NganLobe lobe{.family = static_cast<NganFamily>(known - std::begin(kNames)), .scale = scale};
    lobe.width = nganHasExponent(lobe.family) ? number("Exponent", 1e-3, 1e7)
                                              : number(lobe.family == NganFamily::cookTorrance ? "m" : "ax", 1e-5, 10.0);
    if (nganHasFresnel(lobe.family)) lobe.f0 = number("F0", 0.0, 1.0);
    if (lobe.family == NganFamily::lafortune) lobe.cxy = number("Cxy", -10.0, 10.0), lobe.cz = number("Cz", -10.0, 10.0);
    model.lobes.push_back(lobe);
  }
  return model;
}

}  // namespace chiaro
