#include "precompute/report/sweep/sweep_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "assets/error.h"
#include "assets/scene/material_override.h"
#include "precompute/report/report_options.h"
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
  if (point.form == SweepForm::pca) point.samplingResolution = 0, point.bytes = 0.0, point.weightBits = 0, point.functionBits = 0, point.clusters = 0;
  return point;
}

}  // namespace

void declareSweepOptions(CLI::App& app, SweepOptions& options, SweepOptionTexts& texts) {
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
  many(app.add_option("--clusters", options.clusters, "Clusters, 0 as a bake chooses; not for pca"));
  many(app.add_option("--lobes", options.lobes, "Lobes that frames are drawn with, as for chiaro-view; 0 is the best known"));
  many(app.add_option("--prefilter", options.prefilters, "Texels a side of a face of the sharpest prefiltered environment, a power of two, 16 to 1024"));
  app.add_option("--target-error", options.targetError, "Choose the fewest bytes whose error is at most this")->type_name("E");
  app.add_option("--target-frame-time", options.targetFrameTime, "Choose among what draws a frame in at most so many milliseconds here")->type_name("MS");
  app.add_option("-e,--environment", options.pictures.environment, "Light of the frames: a built-in name, or an .hdr or .exr file")->type_name("NAME|FILE")->capture_default_str();
  app.add_option("--size", texts.size, "Size of the frames in pixels")->type_name("WxH")->capture_default_str();
  app.add_option("--camera", texts.camera, "auto, an index or name of a camera in the file, or eye=X,Y,Z,target=X,Y,Z,fov-deg=D")->type_name("SPEC")->capture_default_str();
  one(app.add_option("--samples", options.pictures.samples, "Sample pairs a pixel of the reference that frames are compared with"));
  one(app.add_option("--frames", options.pictures.frames, "Frames to time, after one that is not counted"));
  app.add_flag("--no-frames", options.noFrames, "Draw nothing: no frame times, no pictures' errors, no OpenGL");
  one(app.add_option("--jobs", options.jobs, "Bakes at a time, 0 as many as memory holds; never changes the errors"));
  app.add_option("--bake-point", options.bakePoint)->group("");
  app.add_option("--bake-threads", options.bakeThreads)->group("");
  app.add_flag("!--no-baselines", options.baselines, "Leave out the paper's setting, spherical harmonics and wavelets");
  app.add_flag("--ground", options.ground, "Put a square of 1600 vertices, three diagonals wide, under the scene");
  one(app.add_option("--vertices", measure.vertices, "Random vertices to measure at"));
  one(app.add_option("--points-inside", measure.points, "Random points inside triangles to measure at"));
  one(app.add_option("--rays", measure.rays, "Rays of the truth, a lobe"));
  one(app.add_option("--seed", measure.seed, "Of the random choices"));
  one(app.add_option("--threads", measure.threads, "CPU threads, 0 is all; never changes the errors"));
  app.add_flag("-q,--quiet", options.quiet, "Print nothing but errors");
}

void finishSweepOptions(SweepOptions& options, const SweepOptionTexts& texts) {
  const auto& measure = options.measure;
  requireRange("--vertices", measure.vertices, 1, 1 << 20);
  requireRange("--points-inside", measure.points, 0, 1 << 20);
  requireRange("--rays", measure.rays, 32, 1 << 20);
  requireRange("--threads", measure.threads, 0, 1024);
  for (const int terms : options.terms) requireRange("--terms", terms, 0, 256);
  requireRange("--jobs", options.jobs, 0, 1024);
  requireRange("--samples", options.pictures.samples, 4, 1 << 20);
  requireRange("--frames", options.pictures.frames, 1, 1000);
  for (const int lobes : options.lobes) requireLobes(lobes, "--lobes");
  for (const int texels : options.prefilters) requireFinestResolution(texels, "--prefilter");
  for (const auto& [option, value] : {std::pair{"--target-error", options.targetError}, std::pair{"--target-frame-time", options.targetFrameTime}})
    if (value && !(*value > 0.0)) throw usageError(option, "must be above 0", "give a number such as 0.02");
  if (options.noFrames && options.targetFrameTime) throw usageError("--target-frame-time", "needs frames", "leave out --no-frames");
  options.pictures.size = sizeFrom(texts.size);
  options.pictures.camera = parseCameraSpec(texts.camera);
  options.pictures.threads = measure.threads;
  if (!options.noFrames) requireEnvironment(options.pictures.environment);
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
                for (const int clusters : options.clusters)
                  for (const int lobes : options.noFrames ? std::vector{0} : options.lobes)
                    for (const int prefilter : options.noFrames ? std::vector{0} : options.prefilters)
                      addOnce(points, normalised({form, resolution, sampling, terms, bytes, weightBits, functionBits, clusters, lobes, prefilter}));
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
