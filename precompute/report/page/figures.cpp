#include "precompute/report/page/figures.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "precompute/figure/html_text.h"

namespace chiaro {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const std::vector<double>& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return json;
}

}  // namespace

Json figuresJson(const std::vector<Figure>& figures) {
  Json json = Json::array();
  for (const Figure& figure : figures) {
    Json one{{"id", figure.id}, {"title", figure.title}, {"x", figure.xLabel}, {"y", figure.yLabel}, {"curves", Json::array()}};
    for (const Curve& curve : figure.curves) one["curves"].push_back({{"name", curve.name}, {"x", numbers(curve.x)}, {"y", numbers(curve.y)}});
    json.push_back(std::move(one));
  }
  return json;
}

std::string figuresCsv(const std::vector<Figure>& figures) {
  std::ostringstream csv;
  csv.precision(9);
  csv << "figure,curve,x,y\n";
  for (const Figure& figure : figures)
    for (const Curve& curve : figure.curves)
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        csv << figure.id << ",\"" << curve.name << "\"," << curve.x[i] << ',';
        if (std::isfinite(curve.y[i])) csv << curve.y[i];
        csv << '\n';
      }
  return csv.str();
}

std::string figuresHtml(const std::vector<Figure>& figures) {
  std::string html;
  for (const Figure& figure : figures)
    html += "<figure id=\"" + figure.id + "\"><h2>" + htmlText(figure.title) + "</h2>\n" + figureSvg(figure) + "<figcaption>" + htmlText(figure.note) + "</figcaption></figure>\n";
  return html;
}

}  // namespace chiaro
