#include "precompute/material/material_output.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;
using lobe64::Vec3;

std::string text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json list(const Vec3& c) { return Json::array({c.x, c.y, c.z}); }
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Width or exponent, as the model of the asset has it.
double parameterOf(int kind, double width) { return modelFamily(kind).published(width); }

/// The GGX width that stands for a model's in metallic-roughness materials (docs/format.md).
double widthEquivalent(int kind, double width) {
  return lobe64::modelHasExponent(kind) ? std::sqrt(2.0 / (parameterOf(kind, width) + 2.0)) : width;
}

Json lobesOf(const NdfMixture& mixture) {
  Json lobes = Json::array();
  for (const auto& lobe : mixture.lobes) lobes.push_back({{"amplitude", lobe.amplitude}, {"sharpness", lobe.sharpness}});
  return lobes;
}

Json modelJson(const ModelFit& one, MaterialForm form) {
  const MaterialFit& fit = one.fit;
  Json json{{"model", modelJsonName(one.kind)},
            {"parameter", parameterOf(one.kind, fit.width)},
            {"width", fit.width},
            {"error", fit.error}};
  if (form != MaterialForm::ndf) {
    if (fit.share > 0.0)
      json["second_lobe"] = {{"parameter", parameterOf(one.kind, fit.width2)}, {"width", fit.width2}, {"share", fit.share}};
    json["diffuse"] = list(fit.diffuse);
    json["f0"] = list(fit.f0());
    json["f90"] = fit.f90;
    json["cosine_error"] = fit.cosineError;
    json["equation_11"] = {{"model", number(one.error)},
                           {"mixture", number(one.mixtureError)},
                           {"isotropic_warp", number(one.isotropicError)},
                           {"chosen_warp", number(one.chosenError)}};
  }
  json["lobes"] = lobesOf(one.mixture);
  json["lobes_error"] = one.mixture.error;
  return json;
}

}  // namespace

std::string materialGltf(const MaterialStudy& study, const std::string& name, const std::string& generator) {
  constexpr double kNoLess = 1.0 - 1e-3;  // F90 of this much is 1
  const auto& [kind, fit, mixture, error, mixtureError, isotropicError, chosenError] = study.chosen();
  const double parameter = parameterOf(kind, fit.width);
  Json reflectance{{"model", modelJsonName(kind)}, {"width", {parameter, parameter}}};
  Json extensions;
  Json used = Json::array({"CHIARO_materials_reflectance"});
  if (fit.f90 >= kNoLess) {
    reflectance["specularColor"] = list(fit.f0());
  } else {
    // F0 = min(.04 specularColorFactor, 1) specularFactor and F90 = specularFactor, at the index of 1.5 that a material without KHR_materials_ior
    // has.
    extensions["KHR_materials_specular"] = {{"specularFactor", fit.f90}, {"specularColorFactor", list(fit.specular / 0.04)}};
    used.push_back("KHR_materials_specular");
  }
  extensions["CHIARO_materials_reflectance"] = reflectance;
  const Json base = Json::array({fit.diffuse.x, fit.diffuse.y, fit.diffuse.z, 1.0});
  const Json material{{"name", name},
                      {"pbrMetallicRoughness",
                       {{"baseColorFactor", base},
                        {"metallicFactor", 0.0},
                        {"roughnessFactor", std::sqrt(std::min(widthEquivalent(kind, fit.width), 1.0))}}},
                      {"extensions", extensions}};
  return text({{"asset", {{"version", "2.0"}, {"generator", generator}}},
               {"extensionsUsed", used},
               {"materials", Json::array({material})}});
}

std::string materialJson(const MaterialStudy& study, const MaterialOptions& options, const std::string& file,
                         const std::string& version) {
  Json json{{"program", "chiaro-precompute material"},
            {"version", version},
            {"file", file},
            {"form", formName(study.form)},
            {"material", study.name},
            {"metric", options.fit.metric == FitMetric::logarithmic ? "log" : "cosine"},
            {"pairs", study.pairs},
            {"chosen", modelJsonName(study.chosen().kind)}};
  json["models"] = Json::array();
  for (const ModelFit& one : study.models) json["models"].push_back(modelJson(one, study.form));
  if (study.form == MaterialForm::ndf)
    json["distribution"] = {{"lobes", lobesOf(study.direct)}, {"lobes_error", study.direct.error}};
  return text(json);
}

}  // namespace chiaro
