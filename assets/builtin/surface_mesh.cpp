#include "assets/builtin/surface_mesh.h"

#include <algorithm>
#include <cmath>

namespace chiaro::builtin {
namespace {

/// A central difference that stays inside [0,1].
glm::dvec3 derivative(const std::function<glm::dvec3(double)>& curve, double at) {
  constexpr double kStep = 1e-5;
  const double low = std::max(at - kStep, 0.0);
  const double high = std::min(at + kStep, 1.0);
  return (curve(high) - curve(low)) / (high - low);
}

struct Frame {
  glm::dvec3 normal;
  glm::vec4 tangent;
};

Frame frameAt(const SurfaceFunction& surface, double u, double v, double outward) {
  glm::dvec3 du = derivative([&](double s) { return surface(s, v); }, u);
  glm::dvec3 dv = derivative([&](double s) { return surface(u, s); }, v);
  glm::dvec3 across = glm::cross(du, dv);
  const double scale = glm::length(dv) * glm::length(dv) + glm::length(du) * glm::length(du);
  if (!(glm::length(across) > 1e-6 * scale)) {
    // At a pole a circle has shrunk to a point: look from a little beside it.
    const double beside = v < 0.5 ? 1e-4 : 1.0 - 1e-4;
    du = derivative([&](double s) { return surface(s, beside); }, u);
    dv = derivative([&](double s) { return surface(u, s); }, beside);
    across = glm::cross(du, dv);
  }
  Frame frame;
  frame.normal = outward * glm::normalize(across);
  const glm::dvec3 tangent = glm::normalize(du - frame.normal * glm::dot(frame.normal, du));
  // glTF: the bitangent points up the image, which is against v.
  const double handedness = glm::dot(glm::cross(frame.normal, tangent), dv) < 0.0 ? 1.0 : -1.0;
  frame.tangent = glm::vec4(glm::dvec4(tangent, handedness));
  return frame;
}

}  // namespace

void addPatch(Primitive& primitive, const Patch& patch, const SurfaceFunction& surface, double outward) {
  const auto base = static_cast<std::uint32_t>(primitive.positions.size());
  const auto stride = static_cast<std::uint32_t>(patch.columns + 1);
  for (int row = 0; row <= patch.rows; ++row) {
    const double v =
        patch.rowParameters.empty() ? static_cast<double>(row) / patch.rows : patch.rowParameters[static_cast<std::size_t>(row)];
    for (int column = 0; column <= patch.columns; ++column) {
      const double u = static_cast<double>(column) / patch.columns;
      const Frame frame = frameAt(surface, u, v, outward);
      primitive.positions.emplace_back(surface(u, v));
      primitive.normals.emplace_back(frame.normal);
      primitive.tangents.push_back(frame.tangent);
      primitive.texcoords.emplace_back(glm::dvec2(u, v) * patch.texcoordScale);
    }
  }
  const auto addTriangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const glm::dvec3 pa(primitive.positions[a]);
    const glm::dvec3 ab = glm::dvec3(primitive.positions[b]) - pa;
    const glm::dvec3 ac = glm::dvec3(primitive.positions[c]) - pa;
    if (!(glm::length(glm::cross(ab, ac)) > 1e-6 * (glm::dot(ab, ab) + glm::dot(ac, ac)))) return;
    if (outward < 0.0) std::swap(b, c);
    primitive.indices.insert(primitive.indices.end(), {a, b, c});
  };
  for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(patch.rows); ++row) {
    for (std::uint32_t column = 0; column < static_cast<std::uint32_t>(patch.columns); ++column) {
      const std::uint32_t corner = base + row * stride + column;
      addTriangle(corner, corner + 1, corner + stride + 1);
      addTriangle(corner, corner + stride + 1, corner + stride);
    }
  }
}

void dropUnusedVertices(Primitive& primitive) {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> newIndex(primitive.positions.size(), kUnused);
  for (const auto index : primitive.indices) newIndex[index] = 0;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < newIndex.size(); ++i) {
    if (newIndex[i] == kUnused) continue;
    newIndex[i] = count;
    primitive.positions[count] = primitive.positions[i];
    primitive.normals[count] = primitive.normals[i];
    primitive.tangents[count] = primitive.tangents[i];
    primitive.texcoords[count] = primitive.texcoords[i];
    ++count;
  }
  primitive.positions.resize(count);
  primitive.normals.resize(count);
  primitive.tangents.resize(count);
  primitive.texcoords.resize(count);
  for (auto& index : primitive.indices) index = newIndex[index];
}

RoundedOutline::RoundedOutline(const std::vector<Corner>& corners) {
  glm::dvec2 from = corners.front().at;
  const auto addLine = [&](glm::dvec2 to) {
    const double length = glm::length(to - from);
    if (length > 1e-9) pieces_.push_back({from, to, {}, 0.0, 0.0, 0.0, length});
    from = to;
  };
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const glm::dvec2 corner = corners[i].at;
    const glm::dvec2 back = corners[i - 1].at - corner;
    const glm::dvec2 ahead = corners[i + 1].at - corner;
    const glm::dvec2 in = -glm::normalize(back);
    const glm::dvec2 out = glm::normalize(ahead);
    const double turn = std::atan2(in.x * out.y - in.y * out.x, glm::dot(in, out));
    const double half = std::tan(0.5 * std::abs(turn));
    if (half < 1e-6) continue;
    // The fillet takes radius * tan(turn / 2) of both lines, and no more than half of either.
    const double cut = std::min({corners[i].radius * half, 0.49 * glm::length(back), 0.49 * glm::length(ahead)});
    const double radius = cut / half;
    addLine(corner - cut * in);
    const glm::dvec2 left(-in.y, in.x);
    const double side = turn > 0.0 ? 1.0 : -1.0;
    const glm::dvec2 center = from + side * radius * left;
    const glm::dvec2 spoke = from - center;
    pieces_.push_back({from, corner + cut * out, center, radius, std::atan2(spoke.y, spoke.x), turn, radius * std::abs(turn)});
    from = corner + cut * out;
  }
  addLine(corners.back().at);
  for (const Piece& piece : pieces_) length_ += piece.length;
}

glm::dvec2 RoundedOutline::at(double share) const {
  double along = std::clamp(share, 0.0, 1.0) * length_;
  for (const Piece& piece : pieces_) {
    if (along > piece.length && &piece != &pieces_.back()) {
      along -= piece.length;
      continue;
    }
    const double t = along / piece.length;
    if (piece.radius == 0.0) return glm::mix(piece.from, piece.to, t);
    const double angle = piece.startAngle + t * piece.sweep;
    return piece.center + piece.radius * glm::dvec2(std::cos(angle), std::sin(angle));
  }
  return pieces_.back().to;
}

std::vector<double> RoundedOutline::parameters(double step, double turn) const {
  std::vector<double> result{0.0};
  double start = 0.0;
  for (const Piece& piece : pieces_) {
    const int count = std::max(
        {1, static_cast<int>(std::ceil(piece.length / step)), static_cast<int>(std::ceil(std::abs(piece.sweep) / turn))});
    for (int i = 1; i <= count; ++i) result.push_back((start + piece.length * i / count) / length_);
    start += piece.length;
  }
  result.back() = 1.0;
  return result;
}

}  // namespace chiaro::builtin
