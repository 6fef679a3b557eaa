#include "runtime/brdf/reflectance_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "runtime/brdf/embedded_tables.h"
#include "shaders/cpp/lobe.h"

namespace chiaro {
namespace {

using lobe64::Vec3;

ReflectanceTable unpacked(int kind) {
  ReflectanceTable table{kind, ReflectanceTable::kWidths, ReflectanceTable::kCosines, {}};
  const std::span<const float> numbers = embeddedTable(kind);
  table.entries.resize(numbers.size() / 4);
  for (std::size_t k = 0; k < table.entries.size(); ++k)
    table.entries[k] = glm::vec4(numbers[4 * k], numbers[4 * k + 1], numbers[4 * k + 2], numbers[4 * k + 3]);
  return table;
}

}  // namespace

const ReflectanceTable& reflectanceTableOf(int kind) {
  static const std::array tables{unpacked(lobe64::kCookTorrance), unpacked(lobe64::kBeckmann), unpacked(lobe64::kBlinnPhong), unpacked(lobe64::kWard),
                                 unpacked(lobe64::kGgx), unpacked(lobe64::kAshikhminShirley)};
  return tables.at(static_cast<std::size_t>(kind));
}

std::vector<SliceLobe> reflectanceLobes(const ReflectanceTable& table, double width, double cosineOut) {
  const int singles = lobe64::reflectanceSingles(table.kind), groups = singles + lobe64::reflectancePairs(table.kind);
  const glm::dvec2 coordinate =
      lobe64::reflectanceTableCoordinate(width, cosineOut) * lobe64::Vec2(table.widthCount - 1, table.cosineCount - 1);
  const int i = std::clamp(static_cast<int>(coordinate.x), 0, table.widthCount - 2),
            j = std::clamp(static_cast<int>(coordinate.y), 0, table.cosineCount - 2);
  const glm::dvec2 f = coordinate - glm::dvec2(i, j);
  const auto entry = [&](int k) {
    const auto texel = [&](int di, int dj) {
      return glm::dvec4(table.entries[static_cast<std::size_t>((k * table.cosineCount + j + dj) * table.widthCount + i + di)]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
  };
  const Vec3 n(0, 0, 1), x(1, 0, 0), y(0, 1, 0);
  const glm::dvec4 elevations = entry(groups);
  std::vector<SliceLobe> lobes;
  for (int g = 0; g < groups; ++g)
    for (int side = 0; side <= (g < singles ? 0 : 1); ++side) {
      const double elevation = g < singles ? 0.0 : elevations[g - singles] * (side == 0 ? 1.0 : -1.0);
      const auto lobe = lobe64::reflectanceTableLobe(entry(g), elevation, n, x, y, cosineOut, width);
      lobes.push_back({lobe.axis, lobe.sharpness, lobe.weight, lobe.fresnelWeight});
    }
  return lobes;
}

}  // namespace chiaro
