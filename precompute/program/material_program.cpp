#include "precompute/program/material_program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "assets/builtin/environment.h"
#include "assets/file.h"
#include "assets/image/display.h"
#include "assets/program/command_line.h"
#include "assets/program/interrupt.h"
#include "precompute/material/material_figure.h"
#include "precompute/material/material_output.h"
#include "precompute/material/material_study.h"
#include "precompute/material/sphere_picture.h"

namespace chiaro {
namespace {

constexpr const char* kExamples = R"(Examples:
  chiaro-precompute material blue-metallic-paint.binary -o blue.gltf
      the best model; blue.json, blue.svg and blue.png say and show how good it is
  chiaro-precompute material sgd_bagher2012_merl100.csv --row gold-paint --model ggx -o gold.gltf
  chiaro-precompute material facets.csv --lobes 4 -o facets.gltf
      a distribution of normals: lines of an angle in degrees and a value

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 unreadable input, 4 unwritable output, 130 interrupted.)";

struct Options {
  std::filesystem::path file, output;
  std::string row, model = "best", name, metric = "log", f90 = "fit", environment = "sunny";
  int lobes = 3, specularLobes = 1, size = 200, samples = 192, threads = 0;
  bool quiet = false;

  std::filesystem::path beside(const char* ending) const { return std::filesystem::path(output).replace_extension(ending); }
};

void declare(CLI::App& app, Options& options) {
  const auto shown = [](CLI::Option* option, const char* type) { option->type_name(type)->capture_default_str(); };
  app.add_option("file", options.file, "MERL .binary or .binary.xz, a table of fits (.csv), or a distribution of normals (.csv)")
      ->required()
      ->type_name("FILE");
  app.add_option("-o,--output", options.output, "glTF file of the material; .json, .svg and .png are written beside it")
      ->required()
      ->type_name("FILE.gltf");
  app.add_option("--row", options.row, "The material of a table")->type_name("NAME");
  shown(app.add_option("--model", options.model,
                       "ggx, beckmann, cookTorrance, ward, blinnPhong, ashikhminShirley, or best: the one of least error"),
        "M");
  shown(app.add_option("--lobes", options.lobes, "Spherical Gaussians of the distribution, 1 to 4"), "N");
  shown(app.add_option("--specular-lobes", options.specularLobes, "Distributions that are added up, 1 or 2; the glTF takes one"),
        "N");
  shown(app.add_option("--metric", options.metric, "What the fit makes small: log (of 1 + rho cos) or cosine (rho cos)"), "NAME");
  shown(app.add_option("--f90", options.f90, "Reflectance at grazing angles: fit, or 1"), "fit|1");
  app.add_option("--name", options.name, "Name of the material; else the row's or the file's")->type_name("NAME");
  shown(app.add_option("-e,--environment", options.environment,
                       "Light of the picture: sunny, overcast, windows, white, or an .hdr or .exr file"),
        "NAME|FILE");
  shown(app.add_option("--size", options.size, "Pixels a side of a sphere, 16 to 2048"), "N");
  shown(app.add_option("--samples", options.samples, "Samples a pixel, of each of three kinds, 1 to 65536"), "N");
  shown(app.add_option("--threads", options.threads, "CPU threads, 0 is all; never changes the result"), "N");
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

std::vector<int> modelsOf(const std::string& name) {
  if (name == "best")
    return {lobe64::kGgx,  lobe64::kBeckmann,   lobe64::kCookTorrance,
            lobe64::kWard, lobe64::kBlinnPhong, lobe64::kAshikhminShirley};
  const auto kind = modelFromJsonName(name);
  if (!kind)
    throw usageError("--model", "\"" + name + "\" is no model",
                     "give ggx, beckmann, cookTorrance, ward, blinnPhong, ashikhminShirley or best");
  return {*kind};
}

MaterialOptions finish(const Options& options) {
  const auto inRange = [](const char* option, int value, int least, int most) {
    if (value < least || value > most)
      throw usageError(option, "must lie between " + std::to_string(least) + " and " + std::to_string(most),
                       "give a number in that range");
  };
  inRange("--lobes", options.lobes, 1, 4);
  inRange("--specular-lobes", options.specularLobes, 1, 2);
  inRange("--size", options.size, 16, 2048);
  inRange("--samples", options.samples, 1, 65536);
  inRange("--threads", options.threads, 0, 1024);
  if (options.metric != "log" && options.metric != "cosine")
    throw usageError("--metric", "\"" + options.metric + "\" is no metric", "give log or cosine");
  if (options.f90 != "fit" && options.f90 != "1")
    throw usageError("--f90", "\"" + options.f90 + "\" is neither fit nor 1", "give one of them");
  if (options.output.extension() != ".gltf")
    throw usageError("--output", "\"" + options.output.string() + "\" does not end in .gltf", "name it so");
  requireEnvironment(options.environment);
  for (const char* ending : {".gltf", ".json", ".svg", ".png"}) {
    const auto path = options.beside(ending);
    if (isSameFile(path, options.file) || isSameFile(path, options.environment))
      throw usageError("--output", path.string() + " is an input, which would be lost", "give another name");
    requireWritable(path);
  }
  MaterialOptions material;
  material.models = modelsOf(options.model);
  material.lobes = options.lobes;
  material.fit.metric = options.metric == "log" ? FitMetric::logarithmic : FitMetric::cosine;
  material.fit.lobes = options.specularLobes;
  material.fit.fitF90 = options.f90 == "fit";
  material.threads = options.threads;
  return material;
}

void print(const MaterialStudy& study, const MaterialOptions& options) {
  if (study.form == MaterialForm::ndf) {
    std::printf("%s: %zu lobes miss the distribution by %.2g of it\n%18s%12s%12s%14s\n", study.name.c_str(),
                study.direct.lobes.size(), study.direct.error, "model", "parameter", "error", "its lobes");
    for (const ModelFit& one : study.models)
      std::printf("%18s%12.5g%12.2g%14.2g%s\n", modelJsonName(one.kind), modelFamily(one.kind).published(one.fit.width),
                  one.fit.error, one.mixture.error, &one == &study.chosen() ? "  chosen" : "");
    return;
  }
  std::printf(
      "%s: %zu pairs of directions; errors by %s; equation (11) of the model, and of its %d lobes before and after warping\n",
      study.name.c_str(), study.pairs, options.fit.metric == FitMetric::logarithmic ? "log(1 + rho cos)" : "rho cos",
      options.lobes);
  std::printf("%18s%11s%24s%24s%7s%10s%10s%10s%10s\n", "model", "parameter", "diffuse", "F0", "F90", "error", "eq. 11", "lobes",
              "warped");
  for (const ModelFit& one : study.models) {
    const MaterialFit& fit = one.fit;
    const auto f0 = fit.f0();
    std::printf("%18s%11.5g%10.3f%7.3f%7.3f%10.4f%7.4f%7.4f%7.3f%10.2e%10.2e%10.2e%10.2e%s\n", modelJsonName(one.kind),
                modelFamily(one.kind).published(fit.width), fit.diffuse.x, fit.diffuse.y, fit.diffuse.z, f0.x, f0.y, f0.z,
                fit.f90, fit.error, one.error, one.mixtureError, one.chosenError, &one == &study.chosen() ? "  chosen" : "");
    if (fit.share > 0.0)
      std::printf("%18s%11.5g  share %.3f\n", "second lobe", modelFamily(one.kind).published(fit.width2), fit.share);
  }
}

}  // namespace

ExitCode materialProgram(int argc, const char* const* argv) {
  CLI::App app("Fits a microfacet model and spherical Gaussians to measured reflectance, draws both and writes a glTF material.",
               "chiaro-precompute material");
  app.footer(kExamples);
  app.set_version_flag("--version", "chiaro-precompute " CHIARO_VERSION);
  Options options;
  declare(app, options);
  if (!readCommandLine(app, argc, argv)) return ExitCode::done;
  MaterialOptions material = finish(options);
  catchInterrupts();
  const MaterialData data = readMaterial(options.file, options.row);
  const MaterialStudy study = studyMaterial(data, material);
  throwIfInterrupted();

  const Environment environment = loadEnvironment(options.environment);
  std::vector<ReflectanceFunction> shown{studiedReflectance(study)};
  if (data.reflectance) shown.insert(shown.begin(), data.reflectance);
  const SphereOptions sphere{
      .size = options.size, .samples = options.samples, .width = study.chosen().fit.width, .threads = options.threads};
  const ImageRgba picture = spherePicture(shown, environment, sphere);
  throwIfInterrupted();

  // One lobe is what a scene takes.
  MaterialStudy single = study;
  if (study.chosen().fit.share > 0.0) {
    material.fit.lobes = 1;
    material.models = {study.chosen().kind};
    single = studyMaterial(data, material);
  }
  writeFileAtomically(options.beside(".json"), materialJson(study, material, options.file.filename().string(), CHIARO_VERSION));
  writeFileAtomically(options.beside(".svg"), figureFile(materialFigure(data, study)));
  writePng(options.beside(".png"), displayImage(picture, autoExposure(environment), ToneMap::neutral));
  writeFileAtomically(options.output,
                      materialGltf(single, options.name.empty() ? data.name : options.name, "chiaro-precompute " CHIARO_VERSION));
  if (!options.quiet) {
    print(study, material);
    if (study.chosen().fit.share > 0.0)
      std::printf("%s holds the fit with one lobe, error %.2e\n", options.output.c_str(), single.chosen().fit.error);
  }
  return ExitCode::done;
}

}  // namespace chiaro
