#include "precompute/ssdf/face_tree.h"

#include <algorithm>

namespace chiaro {
namespace {

glm::dvec3 onPlane(bool outer, double u, double v) {
  const double k = outer ? 1.0 : 0.0;
  return {u - k, v - k, 1.0 - u - v};
}

}  // namespace

FaceTree::FaceTree(int resolution) : half_(resolution / 2) {
  int side = kSide;
  while (side < half_) side *= 2;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    faces[f] = {f % 2 == 0 ? 1.0f : -1.0f, f / 2 % 2 == 0 ? 1.0f : -1.0f, f >= 4};
    add(faces[f], {0, 0, side});
  }
  std::vector<std::uint32_t> faceOf;
  for (std::uint32_t f = 0; f < faces.size(); ++f) faceOf.push_back(f);
  for (std::size_t s = 0; s < squares.size(); ++s) {  // grows as it goes
    const auto [i, j, size] = places_[s];
    const auto& face = faces[faceOf[s]];
    if (size == kSide) {
      squares[s].leaf = addLeaf(face, places_[s]);
      continue;
    }
    squares[s].firstChild = static_cast<std::uint32_t>(squares.size());
    for (int k = 0; k < 4; ++k) {
      const Place child{i + k % 2 * size / 2, j + k / 2 * size / 2, size / 2};
      // Texel (i, j) is of the inner face if i + j < half.
      const int last = std::min(child.i + child.side, half_) + std::min(child.j + child.side, half_) - 2;
      if (child.i >= half_ || child.j >= half_ || (face.outer ? last < half_ : child.i + child.j >= half_)) continue;
      add(face, child);
      faceOf.push_back(faceOf[s]);
    }
    squares[s].childCount = static_cast<std::uint32_t>(squares.size()) - squares[s].firstChild;
  }
  excess = AlignedFloats(leaves.size() * kTexels);
  scale = AlignedFloats(leaves.size() * kTexels);
  for (std::size_t s = 0; s < squares.size(); ++s) {
    if (squares[s].childCount != 0) continue;
    const auto& face = faces[faceOf[s]];
    const auto [i, j, size] = places_[s];
    const double center = 0.5 * kSide;
    const auto reference = glm::normalize(onPlane(face.outer, (i + center) / half_, (j + center) / half_));
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const double u = i + (face.signU > 0.0f ? x : kSide - 1 - x) + 0.5, v = j + (face.signV > 0.0f ? y : kSide - 1 - y) + 0.5;
        const auto plane = onPlane(face.outer, u / half_, v / half_);
        const auto to = plane / glm::length(plane) - reference;
        const auto at = kTexels * squares[s].leaf + static_cast<std::size_t>(kSide * y + x);
        excess[at] = static_cast<float>(glm::dot(to, to));
        scale[at] = static_cast<float>(2.0 / glm::length(plane));
      }
  }
}

void FaceTree::add(const OctahedralFace& face, const Place& place) {
  const auto [i, j, side] = place;
  auto& square = squares.emplace_back();
  places_.push_back(place);
  const double middle = 0.5 * side, reach = 0.5 * (side - 1) / half_;
  const auto center = onPlane(face.outer, (i + middle) / half_, (j + middle) / half_);
  square.center = glm::vec3(center);
  square.length = static_cast<float>(glm::length(center));
  square.half = static_cast<float>(reach);
  for (int k = 0; k < 4; ++k) {  // all texels lie in the hull of the four in its corners
    const auto corner = onPlane(face.outer, (i + middle) / half_ + (k % 2 == 0 ? reach : -reach), (j + middle) / half_ + (k / 2 == 0 ? reach : -reach));
    square.radius = std::max(square.radius, static_cast<float>(glm::distance(glm::normalize(center), glm::normalize(corner))) + 1e-6f);
  }
  square.whole = i + side <= half_ && j + side <= half_ && (face.outer ? i + j >= half_ : i + j + 2 * side - 2 < half_);
  if (!square.whole) return;
  square.column = static_cast<std::uint16_t>(face.signU > 0.0f ? half_ + i : half_ - side - i);
  square.row = static_cast<std::uint16_t>(face.signV > 0.0f ? half_ + j : half_ - side - j);
  square.side = static_cast<std::uint16_t>(side);
}

std::uint32_t FaceTree::addLeaf(const OctahedralFace& face, const Place& place) {
  const auto [i, j, side] = place;
  auto& leaf = leaves.emplace_back();
  const auto center = onPlane(face.outer, (i + 0.5 * side) / half_, (j + 0.5 * side) / half_);
  leaf.reference = glm::vec3(glm::normalize(center));
  leaf.column = face.signU > 0.0f ? half_ + i : half_ - side - i;
  leaf.row = face.signV > 0.0f ? half_ + j : half_ - side - j;
  for (int y = 0; y < side; ++y) {
    const int b = j + (face.signV > 0.0f ? y : side - 1 - y);
    // From the axis: those of the inner face come first.
    int first = face.outer ? std::max(half_ - b - i, 0) : 0, last = std::min(face.outer ? side : half_ - b - i, std::min(half_ - i, side));
    if (b >= half_ || first >= last) first = last = 0;
    const bool mirrored = face.signU < 0.0f && last > 0;
    leaf.from[static_cast<std::size_t>(y)] = static_cast<std::uint8_t>(mirrored ? side - last : first);
    leaf.to[static_cast<std::size_t>(y)] = static_cast<std::uint8_t>(mirrored ? side - first : last);
  }
  return static_cast<std::uint32_t>(leaves.size() - 1);
}

}  // namespace chiaro
