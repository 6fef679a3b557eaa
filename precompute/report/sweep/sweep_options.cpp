#include "precompute/report/sweep/sweep_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "assets/error.h"
#include "precompute/report/sweep/sweep.h"

namespace chiaro {
namespace {

void requireRange(const char* option, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw usageError(option, "is out of range", "give a value from " + std::to_string(least) + " to " + std::to_string(most));
}

void addOnce(std::vector<SweepPoint>& points, const SweepPoint& point) {
  if (std::find(points.begin(), points.end(), point) == points.end()) points.push_back(point);
}

/// What a form has no use for is zero, so that equal work is one point.
SweepPoint normalised(SweepPoint point) {
  if (point.form == SweepForm::pca) point.samplingResolution = 0, point.bytes = 0.0, point.weightBits = 0, point.functionBits = 0;
  return point;
}

}  // namespace

void declareSweepOptions(CLI::App& app, SweepOptions& options) {
  auto& measure = options.measure;
  const auto one = [](CLI::Option* option) { option->type_name("N")->capture_default_str(); };
  const auto many = [](CLI::Option* option) { option->delimiter(',')->type_name("N,N...")->capture_default_str(); };
  app.add_option("scene", options.scene, "Scene file that is not baked, or builtin:NAME")->required()->type_name("SCENE");
  app.add_option("-o,--output", options.output, "Folder for index.html, sweep.json, sweep.csv and what is finished so far")->required()->type_name("DIR");
  const std::map<std::string, SweepForm> forms{{"joint", SweepForm::joint}, {"clustered", SweepForm::clustered}, {"pca", SweepForm::pca}};
  app.add_option("--compression", options.forms, "Forms of compression: joint, clustered, pca")
      ->delimiter(',')
      ->transform(CLI::CheckedTransformer(forms, CLI::ignore_case))
      ->default_str("joint,pca")
      ->option_text("FORM,FORM...");
  many(app.add_option("--resolution", options.resolutions, "Texels a side of the octahedral sphere that is stored"));
  many(app.add_option("--sample-resolution", options.samplingResolutions, "Texels a side traced where visibility changes, 0 as a bake chooses"));
  many(app.add_option("--terms", options.terms, "Weights that a lookup fetches at most, 0 as a bake chooses"));
  many(app.add_option("--bytes", options.bytes, "Bytes a vertex that rounding has to fit, 0 as a bake chooses, below 0 no limit; not for pca"));
  many(app.add_option("--weight-bits", options.weightBits, "Bits of a weight, 8 or 16; not for pca"));
  many(app.add_option("--function-bits", options.functionBits, "Bits of a function's values, 16, 8, 4, or 0 as the bytes allow; not for pca"));
  app.add_flag("!--no-baselines", options.baselines, "Leave out the paper's setting, spherical harmonics and wavelets");
  app.add_flag("--ground", options.ground, "Put a square of 1600 vertices, three diagonals wide, under the scene");
  one(app.add_option("--vertices", measure.vertices, "Random vertices to measure at"));
  one(app.add_option("--points-inside", measure.points, "Random points inside triangles to measure at"));
  one(app.add_option("--rays", measure.rays, "Rays of the truth, a lobe"));
  one(app.add_option("--seed", measure.seed, "Of the random choices"));
  one(app.add_option("--threads", measure.threads, "CPU threads, 0 is all; never changes the errors"));
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void finishSweepOptions(const SweepOptions& options) {
  const auto& measure = options.measure;
  requireRange("--vertices", measure.vertices, 1, 1 << 20);
  requireRange("--points-inside", measure.points, 0, 1 << 20);
  requireRange("--rays", measure.rays, 32, 1 << 20);
  requireRange("--threads", measure.threads, 0, 1024);
  for (const int terms : options.terms) requireRange("--terms", terms, 0, 256);
  // A wrong value is found before hours of the others.
  for (const auto& point : pointsOf(options))
    if (point.isBake()) resolvedSettings(bakeSettingsOf(point, measure));
}

std::vector<SweepPoint> pointsOf(const SweepOptions& options) {
  std::vector<SweepPoint> points;
  for (const auto form : options.forms)
    for (const int resolution : options.resolutions)
      for (const int sampling : options.samplingResolutions)
        for (const int terms : options.terms)
          for (const double bytes : options.bytes)
            for (const int weightBits : options.weightBits)
              for (const int functionBits : options.functionBits)
                addOnce(points, normalised({form, resolution, sampling, terms, bytes, weightBits, functionBits}));
  if (!options.baselines) return points;
  const auto baseline = [&](SweepForm form, int terms) {
    points.push_back({.form = form, .resolution = 64, .samplingResolution = 0, .terms = terms, .bytes = 0.0, .weightBits = 0, .functionBits = 0});
  };
  baseline(SweepForm::paper, 48);
  for (const int coefficients : {25, 49, 100}) baseline(SweepForm::sphericalHarmonics, coefficients);
  for (const int wavelets : {24, 48, 96}) baseline(SweepForm::haar, wavelets);
  return points;
}

}  // namespace chiaro
