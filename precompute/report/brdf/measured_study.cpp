#include "precompute/report/brdf/measured_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "assets/error.h"
#include "assets/file.h"
#include "precompute/material/reconstruction_error.h"
#include "precompute/parallel.h"
#include "precompute/report/brdf/factorisation.h"
#include "runtime/brdf/reflectance_table.h"

namespace chiaro {
namespace {

using namespace lobe64;

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
const std::vector<int> kModels{kGgx, kBeckmann, kCookTorrance, kWard, kBlinnPhong, kAshikhminShirley};
constexpr FitGrid kGrid{.thetaDiff = 15, .phiDiff = 6}, kErrorGrid{.thetaDiff = 30, .phiDiff = 18};
constexpr int kPolar = 112, kAzimuths = 256;

/// Where MERL's second edition, which the reconstructions follow, is brighter than the first, which Ngan fitted.
const Vec3 kSecondEdition(1.0, 1.15, 1.66);

/// "MERL-white-diffuse-bball" -> "white-diffuse-bball".
std::string merlName(const std::string& name) { return name.starts_with("MERL-") ? name.substr(5) : name; }
/// "blue-metallic-paint.nbrdf" -> "blue-metallic-paint"
std::string plainName(const std::string& name) { return name.substr(0, name.find('.')); }

/// The nine lobes that a shader reads, for a viewer anywhere.
ReflectanceFunction shaderReflectance(const ReflectanceTable& table, const MaterialFit& fit) {
  return [&table, fit](const Vec3& wo, const Vec3& wi) {
    const double sine = std::hypot(wo.x, wo.y), x = sine > 0.0 ? wo.x / sine : 1.0, y = sine > 0.0 ? wo.y / sine : 0.0;
    const Vec3 turned(x * wi.x + y * wi.y, x * wi.y - y * wi.x, wi.z);
    double base = 0.0, edge = 0.0;
    for (const SliceLobe& lobe : reflectanceLobes(table, fit.width, wo.z)) {
      const double value = vmfAmplitude(lobe.sharpness) * sgEvaluate(sphericalGaussian(lobe.axis, lobe.sharpness, 1.0), turned);
      base += lobe.weight * value, edge += lobe.fresnelWeight * value;
    }
    const double w = fresnelSchlickWeight(dot(wo, halfVector(wo, wi)));
    const double largest = std::max(fit.specular.x, std::max(fit.specular.y, fit.specular.z));
    const double left = 1.0 - fit.f90 * (largest + (1.0 - largest) * w);
    return fit.diffuse * (left / kPi) + (fit.specular * base + Vec3(edge)) * (fit.f90 / wi.z);
  };
}

FitFamily nganFamily(NganFamily family) {
  const auto parameter = [family](double width) { return nganHasExponent(family) ? 2.0 / (width * width) - 1.0 : width; };
  return {.name = nganName(family),
          .fresnel = nganHasFresnel(family) ? FitFamily::Fresnel::scaled : FitFamily::Fresnel::none,
          .lobe = [family, parameter](double width, const Vec3& wo,
                                      const Vec3& wi) { return nganLobe({.family = family, .width = parameter(width)}, wo, wi); },
          .published = parameter};
}

/// Root mean square of the differences of rho cos.
double cosineError(const std::vector<FitSample>& samples, const ReflectanceFunction& reflectance) {
  double sum = 0.0;
  for (const FitSample& s : samples) {
    const Vec3 difference = (reflectance(s.wo, s.wi) - s.rho) * s.wi.z;
    sum += s.weight * dot(difference, difference) / 3.0;
  }
  return std::sqrt(sum);
}

NganRefit refit(const std::string& material, const MaterialData& published, const MaterialData& source,
                const std::vector<FitSample>& samples) {
  const NganLobe& lobe = published.ngan->lobes.front();
  const FitFamily family = nganFamily(lobe.family);
  const MaterialFit fit = fitMaterial(samples, family, {.metric = FitMetric::cosine});
  const Vec3 n(0, 0, 1);
  NganModel scaled = *published.ngan;
  scaled.diffuse *= kSecondEdition;
  for (auto& one : scaled.lobes) one.scale *= kSecondEdition;
  const bool fresnel = nganHasFresnel(lobe.family);
  return {.material = material,
          .family = family.name,
          .source = formName(source.form),
          .width = family.published(fit.width),
          .publishedWidth = lobe.width,
          .peak = fit.specular.x * (fresnel ? fit.f90 : 1.0) * family.lobe(fit.width, n, n),
          .publishedPeak = lobe.scale.x * (fresnel ? lobe.f0 : 1.0) * nganLobe(lobe, n, n),
          .diffuse = fit.diffuse.x,
          .publishedDiffuse = published.ngan->diffuse.x,
          .error = fit.cosineError,
          .publishedError = cosineError(samples, nganReflectance(scaled))};
}

bool isTable(const std::filesystem::path& path) {
  const auto bytes = readFile(path);
  const std::string first(bytes.begin(), std::find(bytes.begin(), bytes.end(), '\n'));
  return first.starts_with("material,");
}

void push(Curve& curve, double x, double y) { curve.x.push_back(x), curve.y.push_back(y); }

/// Supplement, figure 8: materials that Ngan fitted, by the width of their fit.
Figure factorisationFigure(const std::vector<MeasuredMaterial>& materials) {
  Figure figure{
      .id = "measured",
      .title = "Measured materials: squared error, equation (11), against the data",
      .xLabel = "fitted width",
      .yLabel = "squared relative error",
      .note =
          "Luminance, both directions up to 80 degrees. The eight materials of Ngan et al. and what is given as a file, each by "
          "its best model. Below a width of .05 the grid of the factorisations is too coarse: their true errors are larger.",
      .logX = true,
      .logY = true,
      .curves = {{"model, fitted by rho cos", {}, {}},
                 {"its 3 lobes", {}, {}},
                 {"model, fitted by log", {}, {}},
                 {"its 9 fitted lobes (ours)", {}, {}},
                 {"16 factored terms", {}, {}, true},
                 {"64 factored terms", {}, {}, true},
                 {"256 factored terms", {}, {}, true}}};
  for (Curve& curve : figure.curves) curve.joined = false;
  std::vector<const MeasuredMaterial*> order;
  for (const auto& m : materials)
    if (!std::isnan(m.cosineModel)) order.push_back(&m);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->best.fit.width < b->best.fit.width; });
  for (const auto* m : order) {
    const double values[] = {m->cosineModel, m->cosineMixture, m->best.error, m->ours,
                             m->factored16,  m->factored64,    m->factored256};
    for (std::size_t c = 0; c < figure.curves.size(); ++c) push(figure.curves[c], m->best.fit.width, values[c]);
  }
  return figure;
}

Figure allFigure(const std::vector<MeasuredMaterial>& materials) {
  Figure figure{
      .id = "measured_all",
      .title = "All measured materials: squared error of what a shader reads, equation (11)",
      .xLabel = "fitted width",
      .yLabel = "squared relative error",
      .note = "Each point is a material, its best model, against its data. Most of the error is the model's: see the table.",
      .logX = true,
      .logY = true,
      .curves = {}};
  for (const MaterialForm form : {MaterialForm::merl, MaterialForm::sgd, MaterialForm::abc, MaterialForm::ngan}) {
    Curve curve;
    curve.name = formName(form);
    curve.joined = false;
    for (const auto& m : materials)
      if (m.form == form) push(curve, m.best.fit.width, std::isnan(m.ours) ? m.best.chosenError : m.ours);
    if (!curve.x.empty()) figure.curves.push_back(std::move(curve));
  }
  return figure;
}

}  // namespace

std::vector<std::filesystem::path> measuredFiles(const std::vector<std::filesystem::path>& paths) {
  std::set<std::filesystem::path> files;
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      files.insert(path);
      continue;
    }
    const std::size_t before = files.size();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
      if (!entry.is_regular_file()) continue;
      const auto& file = entry.path();
      const bool packed = file.extension() == ".xz" && file.stem().extension() == ".binary";
      if (packed || file.extension() == ".binary" || (file.extension() == ".csv" && isTable(file))) files.insert(file);
    }
    if (files.size() == before)
      throw inputError(path.string(), "has no measured material in it",
                       "name a folder with .binary, .binary.xz or tables of fits (.csv)");
  }
  return {files.begin(), files.end()};
}

MeasuredStudy studyMeasured(const std::vector<std::filesystem::path>& files, bool quick, int threads,
                            const std::function<void(const std::string&, double)>& progress) {
  struct Item {
    std::string file;
    MaterialData data;
  };
  std::vector<Item> items;
  std::map<std::string, std::vector<MaterialData>> published;
  for (const auto& file : files) {
    auto rows = readMaterials(file);
    for (const auto& row : rows)
      if (row.ngan && row.ngan->lobes.size() == 1) published[merlName(row.name.substr(0, row.name.find('/')))].push_back(row);
    std::size_t taken = 0;
    for (auto& row : rows)
      if (!row.ndf && (!quick || taken++ < 6)) items.push_back({file.filename().string(), std::move(row)});
  }

  MeasuredStudy study;
  study.materials.resize(items.size());
  std::vector<std::vector<NganRefit>> refits(items.size());
  progress("fitting measured materials", 0.0);
  const std::function<void(double)> fitted = [&](double done) { progress("fitting measured materials", done); };
  StepCounter steps(items.size(), fitted);
  parallelBlocks(threads, items.size(), [&](std::size_t i) {
    const auto& [file, data] = items[i];
    const MaterialStudy one = studyMaterial(
        data, {.models = kModels, .lobes = 3, .fit = {.fitF90 = true}, .grid = kGrid, .errorGrid = kErrorGrid, .threads = 1});
    MeasuredMaterial& m = study.materials[i];
    m = {.file = file,
         .name = data.name,
         .form = data.form,
         .best = one.chosen(),
         .cosineModel = kUndefined,
         .cosineMixture = kUndefined,
         .ours = kUndefined,
         .factored16 = kUndefined,
         .factored64 = kUndefined,
         .factored256 = kUndefined,
         .resolved = true};
    const bool ofNgan = data.form != MaterialForm::ngan && published.contains(plainName(data.name));
    const bool inFigure = ofNgan || data.form == MaterialForm::merl;
    if (inFigure) {
      const MaterialStudy cosine = studyMaterial(data, {.models = kModels,
                                                        .lobes = 3,
                                                        .fit = {.metric = FitMetric::cosine, .fitF90 = true},
                                                        .grid = kGrid,
                                                        .errorGrid = kErrorGrid,
                                                        .threads = 1});
      m.cosineModel = cosine.chosen().error, m.cosineMixture = cosine.chosen().mixtureError;
    }
    m.resolved = m.best.fit.width * kAzimuths >= 12.0;
    if (inFigure) {
      const auto value = [&](const Vec3& wo, const Vec3& wi) { return luminance(data.reflectance(wo, wi)) * wi.z; };
      const auto errors =
          factorisationErrors(value, kWidestMeasured, quick ? 56 : kPolar, quick ? 128 : kAzimuths, {16, 64, 256});
      m.factored16 = errors[0], m.factored64 = errors[1], m.factored256 = errors[2];
    }
    if (ofNgan) {
      const auto samples = fitSamples(data.reflectance, kWidestMeasured, kGrid, data.name);
      for (const auto& one_published : published.at(plainName(data.name)))
        if (one_published.ngan->lobes.front().family != NganFamily::lafortune)
          refits[i].push_back(refit(plainName(data.name), one_published, data, samples));
    }
    steps.add();
  });
  for (auto& some : refits) study.refits.insert(study.refits.end(), some.begin(), some.end());
  std::stable_sort(study.refits.begin(), study.refits.end(), [](const NganRefit& a, const NganRefit& b) {
    return std::tie(a.material, a.family) < std::tie(b.material, b.family);
  });

  for (const int kind : kModels) {
    if (kind == kAshikhminShirley ||
        std::none_of(study.materials.begin(), study.materials.end(), [&](const auto& m) { return m.best.kind == kind; }))
      continue;
    const std::string stage = std::string("lobes of ") + modelJsonName(kind);
    progress(stage, 0.0);
    const ReflectanceTable& table = reflectanceTableOf(kind);
    parallelBlocks(threads, items.size(), [&](std::size_t i) {
      MeasuredMaterial& m = study.materials[i];
      if (m.best.kind != kind) return;
      m.ours = reconstructionError(fitSamples(items[i].data.reflectance, kWidestMeasured, kErrorGrid, items[i].data.name),
                                   shaderReflectance(table, m.best.fit));
    });
  }
  study.figures = {factorisationFigure(study.materials), allFigure(study.materials)};
  return study;
}

}  // namespace chiaro
