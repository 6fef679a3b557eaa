#include "precompute/report/budget/error_view.h"

#include <cmath>
#include <cstdio>

#include "assets/image/display.h"
#include "precompute/figure/html_text.h"
#include "precompute/report/base64.h"
#include "precompute/report/page/page.h"
#include "runtime/render/frame_uniforms.h"

namespace chiaro {
namespace {

constexpr std::size_t kWorst = 8;
constexpr glm::ivec2 kOverview{640, 420}, kCloseUp{120, 90};

/// Where the picture shows the vertex; nothing where it is outside or something is before it.
std::optional<glm::vec2> placeIn(const Camera& camera, glm::ivec2 size, const WorstVertex& vertex, const RayScene& rays) {
  const auto clip = clipFromWorld(camera, static_cast<float>(size.x) / static_cast<float>(size.y)) * glm::vec4(vertex.position, 1.0f);
  if (!(clip.w > 0.0f) || !(std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w)) return {};
  const glm::vec3 start = vertex.position + 4.0f * rays.surfaceOffset(vertex.position) * vertex.normal;
  const glm::vec3 eye(camera.worldFromCamera[3]), towards = camera.perspective ? eye - start : glm::vec3(camera.worldFromCamera[2]) * camera.farPlane;
  const float distance = glm::length(towards);
  if (glm::dot(towards, vertex.normal) <= 0.0f || rays.occluded(start, towards / distance, 0.0f, distance)) return {};
  return glm::vec2(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w);
}

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string image(const std::vector<std::uint8_t>& png, const std::string& alt, const std::string& look) {
  return "<img " + look + "alt=\"" + htmlText(alt) + "\" src=\"data:image/png;base64," + base64(png) + "\">";
}

}  // namespace

ErrorView viewErrors(const Scene& scene, VertexErrors errors, const CameraSpec& spec) {
  const RayScene rays(scene);
  const auto camera = resolveCamera(spec, scene, static_cast<float>(kOverview.x) / static_cast<float>(kOverview.y));
  ErrorView view{.errors = std::move(errors), .overview = {}, .worst = {}};
  view.overview = encodePng(errorMeshPicture(scene, rays, view.errors, camera, kOverview));
  for (auto& vertex : worstVertices(scene, view.errors, kWorst)) {
    auto closeUp = encodePng(errorMeshPicture(scene, rays, view.errors, cameraBefore(vertex, scene, rays), kCloseUp));
    const auto at = placeIn(camera, kOverview, vertex, rays);
    view.worst.push_back({.vertex = std::move(vertex), .at = at, .closeUp = std::move(closeUp)});
  }
  return view;
}

std::string errorViewSection(const ErrorView& view) {
  std::string marks;
  std::vector<TableRow> rows;
  for (std::size_t i = 0; i < view.worst.size(); ++i) {
    const auto& [vertex, at, closeUp] = view.worst[i];
    const auto number = std::to_string(i + 1);
    if (at) marks += "<span style=\"left:" + formatted("%.2f%%", 100.0 * static_cast<double>(at->x)) + ";top:" + formatted("%.2f%%", 100.0 * static_cast<double>(at->y)) + "\">" + number + "</span>";
    rows.push_back({.cells = {numberCell("%.0f", static_cast<double>(i + 1)), textCell(vertex.mesh), numberCell("%.0f", static_cast<double>(vertex.vertex)), numberCell("%.4g", static_cast<double>(vertex.position.x)),
                              numberCell("%.4g", static_cast<double>(vertex.position.y)), numberCell("%.4g", static_cast<double>(vertex.position.z)), numberCell("%.4f", vertex.error),
                              {.html = image(closeUp, "about vertex " + std::to_string(vertex.vertex), "class=\"near\" "), .value = vertex.error}}});
  }
  return "<h2>Error at every vertex</h2>\n<p>Mean |error| of the visible fraction at each vertex, the bake as it is: " + formatted("%.4f", view.errors.mean) + " on average, half of the vertices below " +
         formatted("%.4f", view.errors.median) + ", nineteen of twenty below " + formatted("%.4f", view.errors.percentile95) +
         ". The same colours are in error.glb, which any glTF viewer opens. The worst vertices, apart from each other, are numbered where this view shows them.</p>\n<figure><div class=\"marked\">" +
         image(view.overview, "the scene in the colours of its error", "") + marks + "</div></figure>\n<div class=\"magma\"></div><p class=\"soft ends\"><span>0</span><span>" +
         formatted("%g", kVertexErrorRange) + " and more</span></p>\n" + sortableTable("worst_vertices", {"worst vertex", "mesh", "vertex", "x", "y", "z", "mean error", "seen along its normal"}, rows);
}

}  // namespace chiaro
