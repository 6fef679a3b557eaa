#include "precompute/figure/figure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "precompute/figure/html_text.h"

namespace chiaro {
namespace {

constexpr double kWidth = 640, kHeight = 400, kLeft = 64, kRight = 190, kTop = 14, kBottom = 48;
constexpr double kDecades = 8;  // what is smaller by more would only flatten the rest
// Told apart without colour vision too (Okabe and Ito).
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d00", "#777777"};

struct Axis {
  bool logarithmic = false;
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  bool takes(double v) const { return std::isfinite(v) && (!logarithmic || v > 0.0); }
  double of(double v) const { return logarithmic ? std::log10(v) : v; }
  void include(double v) { low = std::min(low, of(v)), high = std::max(high, of(v)); }
  bool shows(double v) const { return takes(v) && of(v) >= low - 1e-9; }
  double share(double v) const { return (of(v) - low) / (high - low); }
  void finish() {
    if (!(low <= high)) low = 0.0, high = 1.0;
    if (logarithmic)
      low = std::max(std::floor(low * 1.0001), std::ceil(high * 0.9999) - kDecades), high = std::ceil(high * 0.9999);
    else
      low = std::min(low, 0.0);
    if (!(high > low)) high = low + 1.0;
  }
  std::vector<double> ticks() const {
    std::vector<double> all;
    if (logarithmic) {
      const int step = std::max(1, static_cast<int>(std::ceil((high - low) / 8)));
      for (int d = static_cast<int>(low); d <= static_cast<int>(high); d += step) all.push_back(std::pow(10.0, d));
      return all;
    }
    const double rough = (high - low) / 6, scale = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = scale * (rough / scale > 5 ? 10 : rough / scale > 2 ? 5 : rough / scale > 1 ? 2 : 1);
    for (double v = std::ceil(low / step) * step; v <= high + 1e-9 * step; v += step)
      all.push_back(std::abs(v) < 1e-9 * step ? 0.0 : v);
    return all;
  }
};

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", v);
  return text;
}

std::string place(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", v);
  return text;
}

}  // namespace

std::string figureSvg(const Figure& figure) {
  Axis ax{.logarithmic = figure.logX}, ay{.logarithmic = figure.logY};
  for (const Curve& curve : figure.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (ax.takes(curve.x[i]) && ay.takes(curve.y[i])) ax.include(curve.x[i]), ay.include(curve.y[i]);
  ax.finish();
  ay.finish();
  const auto px = [&](double v) { return kLeft + ax.share(v) * (kWidth - kLeft - kRight); };
  const auto py = [&](double v) { return kHeight - kBottom - ay.share(v) * (kHeight - kTop - kBottom); };
  std::string svg = "<svg viewBox=\"0 0 640 400\" role=\"img\" aria-label=\"" + htmlText(figure.title) + "\">\n";
  const auto line = [&](double x1, double y1, double x2, double y2, const char* look) {
    svg += "<line x1=\"" + place(x1) + "\" y1=\"" + place(y1) + "\" x2=\"" + place(x2) + "\" y2=\"" + place(y2) + "\" " + look +
           "/>\n";
  };
  const auto text = [&](double x, double y, const std::string& what, const std::string& look) {
    svg += "<text x=\"" + place(x) + "\" y=\"" + place(y) + "\" " + look + ">" + htmlText(what) + "</text>\n";
  };
  for (const double tick : ax.ticks()) {
    line(px(tick), kTop, px(tick), kHeight - kBottom, "class=\"grid\"");
    text(px(tick), kHeight - kBottom + 16, number(tick), "text-anchor=\"middle\"");
  }
  for (const double tick : ay.ticks()) {
    line(kLeft, py(tick), kWidth - kRight, py(tick), "class=\"grid\"");
    text(kLeft - 6, py(tick) + 4, number(tick), "text-anchor=\"end\"");
  }
  text((kLeft + kWidth - kRight) / 2, kHeight - 10, figure.xLabel, "text-anchor=\"middle\"");
  text(14, (kTop + kHeight - kBottom) / 2, figure.yLabel,
       "text-anchor=\"middle\" transform=\"rotate(-90 14 " + place((kTop + kHeight - kBottom) / 2) + ")\"");
  for (std::size_t c = 0; c < figure.curves.size(); ++c) {
    const Curve& curve = figure.curves[c];
    const std::string colour = kColours[(curve.colour < 0 ? c : static_cast<std::size_t>(curve.colour)) % std::size(kColours)];
    const std::string dash = curve.dashed ? " stroke-dasharray=\"5 4\"" : "";
    std::string points, dots;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!ax.shows(curve.x[i]) || !ay.shows(curve.y[i])) continue;
      if (curve.joined) points += place(px(curve.x[i])) + "," + place(py(curve.y[i])) + " ";
      if (curve.dotted) dots += "<circle cx=\"" + place(px(curve.x[i])) + "\" cy=\"" + place(py(curve.y[i])) + "\" r=\"2.5\" fill=\"" + colour +
              "\"><title>" + htmlText(curve.name) + ": " + number(curve.x[i]) + ", " + number(curve.y[i]) + "</title></circle>";
    }
    svg += "<g><title>" + htmlText(curve.name) + "</title><polyline fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"2\"" +
           dash + " points=\"" + points + "\"/>" + dots + "</g>\n";
    const double y = kTop + 10 + 18 * static_cast<double>(c);
    svg += "<line x1=\"" + place(kWidth - kRight + 10) + "\" y1=\"" + place(y) + "\" x2=\"" + place(kWidth - kRight + 32) +
           "\" y2=\"" + place(y) + "\" stroke=\"" + colour + "\" stroke-width=\"2\"" + dash + "/>\n";
    text(kWidth - kRight + 38, y + 4, curve.name, "");
  }
  return svg + "</svg>\n";
}

std::string figureFile(const Figure& figure) {
  const std::string inner = figureSvg(figure);
  const auto from = inner.find('\n') + 1, to = inner.rfind("</svg>");
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 -28 640 452\" role=\"img\">\n"
         "<style>text{font:12px system-ui,sans-serif;fill:#1c1c1c}.grid{stroke:#ddd}</style>\n"
         "<rect y=\"-28\" width=\"640\" height=\"452\" fill=\"#fff\"/>\n<text x=\"10\" y=\"-8\">" +
         htmlText(figure.title) + "</text>\n" + inner.substr(from, to - from) + "<text x=\"10\" y=\"414\" style=\"font-size:10px;fill:#666\">" +
         htmlText(figure.note) + "</text>\n</svg>\n";
}

}  // namespace chiaro
