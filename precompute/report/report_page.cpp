#include "precompute/report/report_page.h"

#include <cmath>
#include <cstdio>

#include "precompute/report/base64.h"
#include "precompute/figure/html_text.h"
#include "precompute/report/error_map.h"
#include "precompute/report/page/page.h"

namespace chiaro {
namespace {

constexpr int kCropSide = 25;  // pixels about a worst one

std::string formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "undefined";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string titleOf(const Comparison& one) {
  return htmlText(one.environment) + (one.model ? ", " + reflectanceNames()[static_cast<std::size_t>(*one.model)] : "") +
         (one.roughness ? ", roughness " + formatted("%.3g", static_cast<double>(*one.roughness)) : "");
}

std::string image(const std::vector<std::uint8_t>& png, const std::string& alt, const Comparison& one, const std::string& look = "") {
  return "<img alt=\"" + alt + ", " + titleOf(one) + "\" width=\"" + std::to_string(one.reference.width) + "\" height=\"" + std::to_string(one.reference.height) +
         "\"" + (look.empty() ? "" : " class=\"" + look + "\"") + " src=\"data:image/png;base64," + base64(png) + "\">";
}

/// What the runtime is compared with, for people.
std::string referenceName(const ReportOptions& options) { return options.other.empty() ? "reference" : htmlText(options.other.filename().string()); }

/// The runtime's picture left of the slider, the reference right of it.
std::string slidingPictures(const CasePictures& pictures, const Comparison& one, const ReportOptions& options) {
  const std::string name = options.other.empty() ? "runtime" : htmlText(options.scene.filename().string()), other = referenceName(options);
  return "<figure><div class=\"compare\">" + image(pictures.runtime, name, one) + image(pictures.reference, other, one, "over") +
         "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" autocomplete=\"off\" aria-label=\"how much of the picture is " + name + "\"></div><figcaption>" + name +
         " left, " + other + " right; the slider moves the line</figcaption></figure>\n";
}

/// Rings about the worst pixels, numbered as in their table.
std::string markedErrorMap(const CasePictures& pictures, const Comparison& one) {
  std::string html = "<figure><div class=\"marked\">" + image(pictures.error, "error", one);
  int number = 0;
  for (const auto& pixel : one.worstPixels) {
    const auto percent = [](int at, int of) { return formatted("%.2f%%", 100.0 * (at + 0.5) / of); };
    html += "<span style=\"left:" + percent(pixel.x, one.reference.width) + ";top:" + percent(pixel.y, one.reference.height) + "\">" + std::to_string(++number) + "</span>";
  }
  return html + "</div><figcaption>error; the worst pixels are numbered</figcaption></figure>\n";
}

/// kCropSide pixels a side about (x, y), as shown; black beyond the border.
std::vector<std::uint8_t> crop(const ImageRgba& picture, const WorstPixel& about, const DisplaySettings& display) {
  ImageRgba part{.width = kCropSide, .height = kCropSide, .texels = std::vector<glm::vec4>(kCropSide * kCropSide, glm::vec4(0.0f))};
  for (int y = 0; y < kCropSide; ++y)
    for (int x = 0; x < kCropSide; ++x) {
      const int fromX = about.x + x - kCropSide / 2, fromY = about.y + y - kCropSide / 2;
      if (fromX >= 0 && fromY >= 0 && fromX < picture.width && fromY < picture.height) part.at(x, y) = picture.at(fromX, fromY);
    }
  return encodePng(displayImage(part, display.exposure, display.toneMap));
}

std::string worstTable(const Comparison& one, const ReportOptions& options) {
  if (one.worstPixels.empty()) return "";
  std::vector<TableRow> rows;
  int number = 0;
  for (const auto& pixel : one.worstPixels) {
    const auto shown = [&](const ImageRgba& picture, const char* what) {
      return "<img class=\"crop\" alt=\"" + std::string(what) + " about pixel " + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) +
             "\" src=\"data:image/png;base64," + base64(crop(picture, pixel, one.display)) + "\">";
    };
    ++number;
    rows.push_back({.cells = {numberCell("%.0f", number), numberCell("%.0f", pixel.x), numberCell("%.0f", pixel.y), numberCell("%.4f", pixel.difference),
                              numberCell("%+.4f", pixel.bias), {.html = shown(one.runtime, "runtime") + " " + shown(one.reference, "reference"), .value = pixel.difference}}});
  }
  return sortableTable("worst_" + one.name, {"worst pixel", "x", "y", "RMSE", "bias", "runtime, " + (options.other.empty() ? std::string("reference") : options.other.filename().string())}, rows);
}

bool fails(const Comparison& one, const ReportOptions& options) {
  const bool defined = one.difference.undefinedPixels == 0;
  return !defined || (options.failUnder && !(one.difference.psnr >= *options.failUnder)) ||
         (options.failOver && !(judgedError(one, options) <= *options.failOver));
}

std::string table(const ReportOptions& options, const Comparisons& comparisons) {
  std::vector<TableRow> rows;
  for (const Comparison& one : comparisons.cases) {
    const PictureDifference& d = one.difference;
    Cell title = textCell("");
    title.html = "<a href=\"#" + one.name + "\">" + titleOf(one) + "</a>";
    rows.push_back({.cells = {title, numberCell("%.2f", d.psnr, fails(one, options)), numberCell("%.4f", d.rmse), numberCell("%+.4f", d.bias), numberCell("%.3f", d.worst),
                              numberCell("%.4f", d.noise), numberCell("%.2f", psnrOf(d.rmseWithoutNoise)), numberCell("%.4f", one.perceptual.ssim),
                              numberCell("%.4f", one.perceptual.flip), numberCell("%.4f", one.perceptual.hdrFlip), numberCell("%.0f", static_cast<double>(d.objectPixels)),
                              numberCell("%.0f", static_cast<double>(d.undefinedPixels), d.undefinedPixels > 0), numberCell("%.0f", static_cast<double>(d.coverageMismatches))}});
  }
  return sortableTable("cases",
                       {"light, material", "PSNR dB", "RMSE", "bias", "worst", "reference noise", "PSNR without noise", "SSIM", "FLIP", "HDR FLIP", "pixels", "undefined",
                        "outline differs"},
                       rows);
}

std::string settings(const ReportFacts& facts, const ReportOptions& options, const Comparisons& comparisons) {
  std::string html = "<h2>Settings</h2><dl>\n";
  const auto entry = [&](const std::string& name, const std::string& text) {
    html += "<dt>" + name + "</dt><dd>" + htmlText(text) + "</dd>\n";
  };
  entry("scene", options.scene.filename().string());
  entry("mesh", std::to_string(facts.vertices) + " vertices, " + std::to_string(facts.triangles) + " triangles");
  entry("transfer", std::to_string(facts.terms) + " terms, " + std::to_string(facts.directions) + " broad lobes, " +
                        std::to_string(facts.resolution) + " texels a side, " + formatted("%.0f", facts.bytesPerVertex) +
                        " bytes a vertex");
  entry("pictures",
        std::to_string(options.size.x) + " x " + std::to_string(options.size.y) + ", one ray a pixel through its centre");
  entry("reference", options.other.empty() ? std::to_string(options.samples) + " sample pairs a pixel, in two halves" : options.other.filename().string());
  entry("shadows", options.shadows ? "yes" : "no");
  if (options.metallic) entry("metalness", formatted("%.3g", static_cast<double>(*options.metallic)));
  entry("tone map", facts.toneMap);
  for (const Comparison& one : comparisons.cases)
    entry("exposure", formatted("%.4g", static_cast<double>(one.display.exposure)) + " (" + one.name + ")");
  entry("OpenGL", comparisons.glRenderer + ", " + comparisons.glVersion);
  entry("chiaro-report", facts.version);
  return html + "</dl>\n";
}

std::string errorMapLegend(ErrorMapKind kind, bool pair) {
  if (kind != ErrorMapKind::difference)
    return std::string("<h2>Error maps</h2><p class=\"soft\">") +
           (kind == ErrorMapKind::flip ? "FLIP of the pictures as shown" : "HDR FLIP, the worst of all exposures") +
           ". Magenta is undefined, grey no object.</p>\n<div class=\"magma\"></div><div class=\"ends soft\"><span>0 equal</span>"
           "<span>1</span></div>\n";
  const std::string range = formatted("%.2g", kErrorMapRange);
  std::string html;
  html +=
      "<h2>Error maps</h2><p class=\"soft\">" + std::string(pair ? "The first bake minus the other" : "Runtime minus reference") + ", mean of the channels. Black is equal, magenta undefined, "
      "grey no object.</p>\n";
  html += "<div class=\"scale\"></div><div class=\"ends soft\"><span>&minus;" + range + " too dark</span><span>0</span><span>+" +
          range + " too bright</span></div>\n";
  return html;
}

}  // namespace

std::string reportPage(const ReportFacts& facts, const ReportOptions& options, const Comparisons& comparisons,
                       const std::vector<CasePictures>& pictures) {
  const bool pair = !options.other.empty();
  std::string html =
      pair ? "<p>Each picture of one bake beside that of another: the same camera, light and exposure."
           : "<p>Each picture of the runtime beside a brute-force one of the same scene, camera, light and exposure: direct light, traced, no spherical Gaussian and no "
             "baked transfer in it.";
  html += " Figures are of tone-mapped, display-encoded colours from 0 to 1, over the pixels that show an object.";
  if (!pair) html += " The reference is drawn in two halves with independent noise; how they differ gives the noise, and the PSNR without it.";
  html += "</p>\n" + table(options, comparisons) + errorMapLegend(options.errorMap, pair);
  for (std::size_t i = 0; i < comparisons.cases.size(); ++i) {
    const Comparison& one = comparisons.cases[i];
    html += "<h2 id=\"" + one.name + "\">" + titleOf(one) + ": " + formatted("%.2f dB", one.difference.psnr) + "</h2>\n<div class=\"row\">\n";
    html += slidingPictures(pictures[i], one, options) + markedErrorMap(pictures[i], one) + "</div>\n" + worstTable(one, options);
    html += "<p class=\"soft\">Prefiltering " + formatted("%.2f s", one.prepareSeconds) + ", runtime " + formatted("%.2f s", one.runtimeSeconds) + " with upload, " +
            referenceName(options) + " " + formatted("%.1f s", one.referenceSeconds);
    if (!pair) html += " for " + formatted("%.1f", static_cast<double>(one.rays) * 1e-6) + " million rays";
    html += ".</p>\n";
  }
  html += settings(facts, options, comparisons);
  return pageHtml({.title = options.scene.filename().string() + (pair ? " against " + options.other.filename().string() : " against its reference"), .body = html, .data = ""});
}

}  // namespace chiaro
