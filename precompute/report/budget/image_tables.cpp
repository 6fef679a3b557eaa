#include "precompute/report/budget/image_tables.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "assets/image/display.h"
#include "precompute/figure/html_text.h"
#include "precompute/report/base64.h"
#include "precompute/report/error_map.h"
#include "precompute/report/page/page.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// What the error falls by in the next stage; the last: what is left.
double causedBy(const ImageBudget& budget, std::size_t stage, double ImageError::*figure) {
  const auto next = stage + 1;
  return budget.stages[stage].error.*figure - (next < budget.stages.size() ? budget.stages[next].error.*figure : 0.0);
}

std::string picture(const std::vector<std::uint8_t>& png, const std::string& alt) {
  return "<img class=\"pixels\" alt=\"" + htmlText(alt) + "\" src=\"data:image/png;base64," + base64(png) + "\">";
}

std::string shown(const ImageBudget& budget, const ImageRgba& image, const std::string& what) {
  return picture(encodePng(displayImage(image, budget.display.exposure, budget.display.toneMap)), what);
}

/// A stage's picture against the next one's, the last against the reference.
std::vector<std::uint8_t> changeMap(const ImageBudget& budget, std::size_t stage) {
  ImageRgba next = stage + 1 < budget.stages.size() ? budget.stages[stage + 1].picture : budget.reference;
  for (std::size_t i = 0; i < next.texels.size(); ++i) next.texels[i].a = budget.reference.texels[i].a;
  return encodePng(errorMap(budget.stages[stage].picture, next, budget.display));
}

std::string drawnAs(const ImageBudgetSettings& drawn) {
  std::string text = drawn.environment;
  if (drawn.materials.roughness) text += ", roughness " + formatted("%.3g", static_cast<double>(*drawn.materials.roughness));
  if (drawn.materials.metallic) text += ", metalness " + formatted("%.3g", static_cast<double>(*drawn.materials.metallic));
  return text + ", " + std::to_string(drawn.size.x) + " x " + std::to_string(drawn.size.y);
}

}  // namespace

std::string imageBudgetTable(const ImageBudget& budget) {
  char line[200];
  std::string text = "pictures: distance from the reference, " + std::to_string(budget.pixels) + " pixels (" + std::to_string(budget.leftOut) + " left out), display-encoded and linear\n";
  std::snprintf(line, sizeof line, "  %-36s%9s%9s%9s%9s%9s  %-34s%9s%9s\n", "", "RMSE", "PSNR", "linear", "PSNR", "FLIP", "cause", "RMSE", "change");
  text += line;
  for (std::size_t i = 0; i < budget.stages.size(); ++i) {
    const auto& stage = budget.stages[i];
    std::snprintf(line, sizeof line, "  %-36s%9.5f%9.2f%9.5f%9.2f%9.4f  %-34s%+9.5f%9.5f\n", stage.what.c_str(), stage.error.rmse, stage.error.psnr, stage.error.linearRmse, stage.error.linearPsnr,
                  stage.error.flip, stage.cause.c_str(), causedBy(budget, i, &ImageError::rmse), stage.change);
    text += line;
  }
  std::snprintf(line, sizeof line, "  noise: reference %.5f, last picture %.5f; left over both: %.2f\n", budget.referenceNoise.rmse, budget.exactNoise.rmse, budget.leftOverNoise());
  return text + line;
}

Json imageBudgetJson(const ImageBudget& budget, const ImageBudgetSettings& drawn) {
  const auto optional = [](const std::optional<float>& value) { return value ? Json(*value) : Json(nullptr); };
  Json json{{"environment", drawn.environment},
            {"roughness", optional(drawn.materials.roughness)},
            {"metallic", optional(drawn.materials.metallic)},
            {"size", {drawn.size.x, drawn.size.y}},
            {"samples", drawn.samples},
            {"rays_per_lobe", drawn.raysPerLobe},
            {"upsample", drawn.upsample},
            {"exposure", budget.display.exposure},
            {"gl_renderer", budget.glRenderer},
            {"pixels", budget.pixels},
            {"pixels_left_out", budget.leftOut},
            {"reference_noise", number(budget.referenceNoise.rmse)},
            {"reference_noise_linear", number(budget.referenceNoise.linearRmse)},
            {"exact_noise", number(budget.exactNoise.rmse)},
            {"exact_noise_linear", number(budget.exactNoise.linearRmse)},
            {"left_over_noise", number(budget.leftOverNoise())},
            {"stages", Json::array()}};
  for (std::size_t i = 0; i < budget.stages.size(); ++i) {
    const auto& stage = budget.stages[i];
    json["stages"].push_back({{"what", stage.what},
                              {"cause", stage.cause},
                              {"rmse", number(stage.error.rmse)},
                              {"psnr_db", number(stage.error.psnr)},
                              {"linear_rmse", number(stage.error.linearRmse)},
                              {"linear_psnr_db", number(stage.error.linearPsnr)},
                              {"flip", number(stage.error.flip)},
                              {"caused_rmse", number(causedBy(budget, i, &ImageError::rmse))},
                              {"caused_linear_rmse", number(causedBy(budget, i, &ImageError::linearRmse))},
                              {"caused_flip", number(causedBy(budget, i, &ImageError::flip))},
                              {"change_rmse", number(stage.change)}});
  }
  return json;
}

std::string imageBudgetCsv(const ImageBudget& budget) {
  std::ostringstream csv;
  csv.precision(9);
  csv << "what,cause,rmse,psnr_db,linear_rmse,linear_psnr_db,flip,caused_rmse,caused_linear_rmse,caused_flip,change_rmse\n";
  for (std::size_t i = 0; i < budget.stages.size(); ++i) {
    const auto& [what, cause, unused, error, change] = budget.stages[i];
    csv << '"' << what << "\",\"" << cause << '"';
    for (const double value : {error.rmse, error.psnr, error.linearRmse, error.linearPsnr, error.flip, causedBy(budget, i, &ImageError::rmse), causedBy(budget, i, &ImageError::linearRmse),
                               causedBy(budget, i, &ImageError::flip), change}) {
      csv << ',';
      if (std::isfinite(value)) csv << value;
    }
    csv << '\n';
  }
  return csv.str();
}

std::string imageBudgetSection(const ImageBudget& budget, const ImageBudgetSettings& drawn) {
  std::vector<TableRow> rows;
  std::string pictures;
  for (std::size_t i = 0; i < budget.stages.size(); ++i) {
    const auto& stage = budget.stages[i];
    rows.push_back({.cells = {textCell(stage.what), numberCell("%.5f", stage.error.rmse), numberCell("%.2f", stage.error.psnr), numberCell("%.5f", stage.error.linearRmse),
                              numberCell("%.2f", stage.error.linearPsnr), numberCell("%.4f", stage.error.flip), textCell(stage.cause), numberCell("%+.5f", causedBy(budget, i, &ImageError::rmse)),
                              numberCell("%+.5f", causedBy(budget, i, &ImageError::linearRmse)), numberCell("%+.4f", causedBy(budget, i, &ImageError::flip)), numberCell("%.5f", stage.change)}});
    pictures += "<figure>" + shown(budget, stage.picture, stage.what) + picture(changeMap(budget, i), "what " + stage.cause + " changes") + "<figcaption>" + htmlText(stage.what) +
                "; below: what it has beyond the next, " + htmlText(stage.cause) + "</figcaption></figure>\n";
  }
  pictures += "<figure>" + shown(budget, budget.reference, "reference") + "<figcaption>reference; pixels left out are dark in the maps</figcaption></figure>\n";
  return "<h2>Errors of a picture</h2>\n<p>The renderer's own picture (" + htmlText(drawnAs(drawn)) +
         ") with one stage of its shading after another made exact; what is asked of the exact stages is traced for each pixel. What the distance from the reference falls by is that "
         "stage's share. The last picture uses nothing of the renderer and other rays than the reference: what is left of it is noise (" +
         formatted("%.2f", budget.leftOverNoise()) + " times what both noises explain).</p>\n<figure><div class=\"chart\"><canvas id=\"chart_pictures\" role=\"img\" " +
         "aria-label=\"Error of the picture by cause; the same figures are in the table below\"></canvas></div></figure>\n" +
         sortableTable("pictures", {"picture", "RMSE", "PSNR dB", "linear RMSE", "linear PSNR", "FLIP", "cause", "RMSE by it", "linear", "FLIP", "changes the picture by"}, rows) +
         "<p class=\"soft\">RMSE and FLIP of what the screen shows, linear: of radiance times exposure. " + std::to_string(budget.pixels) + " pixels, " + std::to_string(budget.leftOut) +
         " at outlines left out. Noise of the reference " + formatted("%.5f", budget.referenceNoise.rmse) + ", of the last picture " + formatted("%.5f", budget.exactNoise.rmse) + ". " +
         htmlText(budget.glRenderer) + ".</p>\n<div class=\"row\">\n" + pictures + "</div>\n<div class=\"scale\"></div><p class=\"soft ends\"><span>0.1 too dark</span><span>0.1 too bright</span></p>\n";
}

Json imageBudgetChart(const ImageBudget& budget) {
  Json causes = Json::array();
  for (std::size_t i = 0; i < budget.stages.size(); ++i)
    causes.push_back({{"name", budget.stages[i].cause},
                      {"error", number(causedBy(budget, i, &ImageError::rmse))},
                      {"linear", number(causedBy(budget, i, &ImageError::linearRmse))},
                      {"change", number(budget.stages[i].change)}});
  return causes;
}

}  // namespace chiaro
