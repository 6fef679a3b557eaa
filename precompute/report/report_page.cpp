#include "precompute/report/report_page.h"

#include <cmath>
#include <cstdio>

#include "precompute/report/base64.h"
#include "precompute/figure/html_text.h"
#include "precompute/report/error_map.h"

namespace chiaro {
namespace {

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ground:#fff;--text:#1c1c1c;--soft:#666;--line:#ddd;--bad:#b3261e}
@media (prefers-color-scheme:dark){:root{--ground:#141414;--text:#e6e6e6;--soft:#a0a0a0;--line:#383838;--bad:#ff8a80}}
body{margin:0 auto;padding:1rem;max-width:100rem;background:var(--ground);color:var(--text);font:16px/1.5 system-ui,sans-serif}
h1{font-size:1.4rem;margin:.5rem 0}h2{font-size:1.1rem;margin:2rem 0 .5rem}
p,dl{max-width:46rem}.soft,figcaption{color:var(--soft);font-size:.9rem}.bad{color:var(--bad);font-weight:600}
.wide{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:.3rem .7rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th:first-child,td:first-child{text-align:left}
.row{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,18rem),1fr));gap:.7rem}
figure{margin:0}img{width:100%;height:auto;display:block;background:#303030}
.scale{height:.8rem;max-width:24rem;background:linear-gradient(90deg,#0ff,#00f,#000,#f00,#ff0)}
.magma{height:.8rem;max-width:24rem;background:linear-gradient(90deg,#000004,#51127c,#b73779,#fc8961,#fcfdbf)}
.ends{display:flex;justify-content:space-between;max-width:24rem}
dt{float:left;clear:left;min-width:11rem;color:var(--soft)}dd{margin:0 0 0 11.5rem}
)";

std::string formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "undefined";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string titleOf(const Comparison& one) {
  return htmlText(one.environment) +
         (one.roughness ? ", roughness " + formatted("%.3g", static_cast<double>(*one.roughness)) : "");
}

std::string picture(const std::vector<std::uint8_t>& png, const std::string& caption, const Comparison& one) {
  return "<figure><img alt=\"" + caption + ", " + titleOf(one) + "\" width=\"" + std::to_string(one.reference.width) +
         "\" height=\"" + std::to_string(one.reference.height) + "\" src=\"data:image/png;base64," + base64(png) +
         "\"><figcaption>" + caption + "</figcaption></figure>\n";
}

bool fails(const Comparison& one, const ReportOptions& options) {
  const bool defined = one.difference.undefinedPixels == 0;
  return !defined || (options.failUnder && !(one.difference.psnr >= *options.failUnder));
}

std::string table(const ReportOptions& options, const Comparisons& comparisons) {
  std::string html =
      "<div class=\"wide\"><table><tr><th>light, material</th><th>PSNR dB</th><th>RMSE</th><th>bias</th><th>worst</th>"
      "<th>reference noise</th><th>PSNR without noise</th><th>SSIM</th><th>FLIP</th><th>HDR "
      "FLIP</th><th>pixels</th><th>undefined</th><th>outline differs</th></tr>\n";
  for (const Comparison& one : comparisons.cases) {
    const PictureDifference& d = one.difference;
    const auto cell = [&](const std::string& text, bool bad = false) {
      html += (bad ? "<td class=\"bad\">" : "<td>") + text + "</td>";
    };
    html += "<tr>";
    cell("<a href=\"#" + one.name + "\">" + titleOf(one) + "</a>");
    cell(formatted("%.2f", d.psnr), fails(one, options));
    cell(formatted("%.4f", d.rmse));
    cell(formatted("%+.4f", d.bias));
    cell(formatted("%.3f", d.worst));
    cell(formatted("%.4f", d.noise));
    cell(formatted("%.2f", psnrOf(d.rmseWithoutNoise)));
    cell(formatted("%.4f", one.perceptual.ssim));
    cell(formatted("%.4f", one.perceptual.flip));
    cell(formatted("%.4f", one.perceptual.hdrFlip));
    cell(std::to_string(d.objectPixels));
    cell(std::to_string(d.undefinedPixels), d.undefinedPixels > 0);
    cell(std::to_string(d.coverageMismatches));
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
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
  entry("reference", std::to_string(options.samples) + " sample pairs a pixel, in two halves");
  entry("shadows", options.shadows ? "yes" : "no");
  if (options.metallic) entry("metalness", formatted("%.3g", static_cast<double>(*options.metallic)));
  entry("tone map", facts.toneMap);
  for (const Comparison& one : comparisons.cases)
    entry("exposure", formatted("%.4g", static_cast<double>(one.display.exposure)) + " (" + one.name + ")");
  entry("OpenGL", comparisons.glRenderer + ", " + comparisons.glVersion);
  entry("chiaro-report", facts.version);
  return html + "</dl>\n";
}

std::string errorMapLegend(ErrorMapKind kind) {
  if (kind != ErrorMapKind::difference)
    return std::string("<h2>Error maps</h2><p class=\"soft\">") +
           (kind == ErrorMapKind::flip ? "FLIP of the pictures as shown" : "HDR FLIP, the worst of all exposures") +
           ". Magenta is undefined, grey no object.</p>\n<div class=\"magma\"></div><div class=\"ends soft\"><span>0 equal</span>"
           "<span>1</span></div>\n";
  const std::string range = formatted("%.2g", kErrorMapRange);
  std::string html;
  html +=
      "<h2>Error maps</h2><p class=\"soft\">Runtime minus reference, mean of the channels. Black is equal, magenta undefined, "
      "grey no object.</p>\n";
  html += "<div class=\"scale\"></div><div class=\"ends soft\"><span>&minus;" + range + " too dark</span><span>0</span><span>+" +
          range + " too bright</span></div>\n";
  return html;
}

}  // namespace

std::string reportPage(const ReportFacts& facts, const ReportOptions& options, const Comparisons& comparisons,
                       const std::vector<CasePictures>& pictures) {
  const std::string scene = htmlText(options.scene.filename().string());
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\">\n<title>" +
      scene + " against its reference</title><style>" + kStyle + "</style></head><body>\n";
  html += "<h1>" + scene + " against its reference</h1>\n";
  html +=
      "<p>Each picture of the runtime beside a brute-force one of the same scene, camera, light and exposure: direct light, "
      "traced, no spherical "
      "Gaussian and no baked transfer in it. Figures are of tone-mapped, display-encoded colours from 0 to 1, over the pixels "
      "that show an object. "
      "The reference is drawn in two halves with independent noise; how they differ gives the noise, and the PSNR without "
      "it.</p>\n";
  html += table(options, comparisons);
  html += errorMapLegend(options.errorMap);
  for (std::size_t i = 0; i < comparisons.cases.size(); ++i) {
    const Comparison& one = comparisons.cases[i];
    html += "<h2 id=\"" + one.name + "\">" + titleOf(one) + ": " + formatted("%.2f dB", one.difference.psnr) +
            "</h2>\n<div class=\"row\">\n";
    html += picture(pictures[i].runtime, "runtime", one) + picture(pictures[i].reference, "reference", one) +
            picture(pictures[i].error, "error", one);
    html += "</div>\n<p class=\"soft\">Prefiltering " + formatted("%.2f s", one.prepareSeconds) + ", runtime " +
            formatted("%.2f s", one.runtimeSeconds) + " with upload, reference " + formatted("%.1f s", one.referenceSeconds) +
            " for " + formatted("%.1f", static_cast<double>(one.rays) * 1e-6) + " million rays.</p>\n";
  }
  return html + settings(facts, options, comparisons) + "</body></html>\n";
}

}  // namespace chiaro
