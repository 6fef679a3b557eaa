#include "assets/builtin/ornament.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "assets/builtin/pattern.h"
#include "assets/builtin/surface_mesh.h"

namespace chiaro::builtin {
namespace {

constexpr double kPi = std::numbers::pi;

// Metres. Neighbouring parts share these, so that their edges meet.
constexpr double kFloorRadius = 2.0;
constexpr double kPlinthRadius = 0.62;
constexpr double kPlinthTop = 0.46;
constexpr double kDomeRadius = 0.40;
constexpr double kDomeTop = 0.84;
constexpr int kPillars = 8;
constexpr double kPillarRing = 1.50;    ///< distance of the pillars' axes from the middle
constexpr double kPillarRadius = 0.19;  ///< of the foot
constexpr double kPillarHeight = 1.12;

constexpr int kPlinthColumns = 128;  ///< also the dome's
constexpr int kFloorColumns = 2 * kPlinthColumns;
constexpr int kPillarColumns = 48;  ///< also the rim of the hole in the floor under a pillar

glm::dvec2 onCircle(double turns) { return {std::cos(2.0 * kPi * turns), std::sin(2.0 * kPi * turns)}; }

/// An outline turned about the vertical axis; u runs against the clock seen from above.
glm::dvec3 revolved(glm::dvec2 radiusAndHeight, double turns) {
  const glm::dvec2 c = onCircle(turns);
  return {radiusAndHeight.x * c.x, radiusAndHeight.y, -radiusAndHeight.x * c.y};
}

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Every part is one mesh with one material.
Primitive& addPart(Scene& scene, const std::string& name, int material) {
  scene.meshNames.push_back(name);
  Primitive primitive;
  primitive.name = name;
  primitive.mesh = static_cast<int>(scene.meshNames.size()) - 1;
  primitive.material = material;
  scene.primitives.push_back(std::move(primitive));
  return scene.primitives.back();
}

int addMaterial(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

/// glTF's channels: G roughness, B metallic.
glm::dvec3 roughnessMetallic(double roughness, double metallic) { return {0.0, roughness, metallic}; }

// ---- floor: a polar grid with a hole under the plinth and one under each pillar ----

class FloorMesh {
 public:
  explicit FloorMesh(Primitive& primitive) : primitive_(primitive), stride_(static_cast<std::size_t>(kColumns)) {}

  void build() {
    for (int ring = 0; ring <= kRings; ++ring) {
      for (int column = 0; column < kColumns; ++column)
        grid_.push_back(isInsideHole(ring, column) ? kUnused : addVertex(gridPoint(ring, column)));
    }
    for (int ring = 0; ring < kRings; ++ring) {
      for (int column = 0; column < kColumns; ++column) {
        if (!isHoleCell(ring, column))
          addQuad(vertex(ring, column), vertex(ring + 1, column), vertex(ring + 1, column + 1), vertex(ring, column + 1));
      }
    }
    for (int pillar = 0; pillar < kPillars; ++pillar) fillAroundPillar(pillar);
  }

 private:
  static constexpr int kColumns = kFloorColumns;
  static constexpr int kSector = kColumns / kPillars;  ///< columns a pillar
  static constexpr int kRings = 42;
  static constexpr int kHoleColumns = 12;  ///< the block of cells around a pillar
  static constexpr int kHoleRings = 12;
  static constexpr int kFirstHoleRing = 23;
  static constexpr int kLayers = 3;  ///< from the block's edge to the pillar's foot
  static constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  static_assert(2 * (kHoleColumns + kHoleRings) == kPillarColumns);

  /// Cells are about square at the plinth and grow outwards, less than the circles do.
  static double ringRadius(int ring) {
    const double t = static_cast<double>(ring) / kRings;
    return kPlinthRadius + (kFloorRadius - kPlinthRadius) * t * (0.72 + 0.28 * t);
  }
  static glm::dvec2 gridPoint(int ring, int column) {
    const auto onRing = [&](int c) { return ringRadius(ring) * onCircle(static_cast<double>(c) / kColumns); };
    // The innermost ring lies on the plinth's foot, which has half as many corners.
    return ring == 0 && column % 2 == 1 ? 0.5 * (onRing(column - 1) + onRing(column + 1)) : onRing(column);
  }

  static int columnInBlock(int column) { return column % kSector - (kSector - kHoleColumns) / 2; }
  static bool isHoleCell(int ring, int column) {
    const int c = columnInBlock(column);
    return ring >= kFirstHoleRing && ring < kFirstHoleRing + kHoleRings && c >= 0 && c < kHoleColumns;
  }
  static bool isInsideHole(int ring, int column) {
    const int c = columnInBlock(column);
    return ring > kFirstHoleRing && ring < kFirstHoleRing + kHoleRings && c > 0 && c < kHoleColumns;
  }

  std::uint32_t vertex(int ring, int column) const {
    return grid_[static_cast<std::size_t>(ring) * stride_ + static_cast<std::size_t>(column % kColumns)];
  }

  std::uint32_t addVertex(glm::dvec2 at) {
    primitive_.positions.emplace_back(at.x, 0.0, -at.y);
    primitive_.normals.emplace_back(0.0f, 1.0f, 0.0f);
    primitive_.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
    primitive_.texcoords.emplace_back(at.x, -at.y);  // one repeat a metre
    return static_cast<std::uint32_t>(primitive_.positions.size()) - 1;
  }

  /// Corners against the clock in (x, -z), that is seen from above.
  void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    primitive_.indices.insert(primitive_.indices.end(), {a, b, c, a, c, d});
  }

  /// Rings that turn from the block's outline into the pillar's foot.
  void fillAroundPillar(int pillar) {
    const int firstColumn = pillar * kSector + (kSector - kHoleColumns) / 2;
    const glm::dvec2 center = kPillarRing * onCircle((pillar + 0.5) / kPillars);
    std::vector<std::uint32_t> outline;  // with the clock in (x, -z), as the block is seen along growing column, then ring
    for (int i = 0; i < kHoleColumns; ++i) outline.push_back(vertex(kFirstHoleRing, firstColumn + i));
    for (int i = 0; i < kHoleRings; ++i) outline.push_back(vertex(kFirstHoleRing + i, firstColumn + kHoleColumns));
    for (int i = 0; i < kHoleColumns; ++i) outline.push_back(vertex(kFirstHoleRing + kHoleRings, firstColumn + kHoleColumns - i));
    for (int i = 0; i < kHoleRings; ++i) outline.push_back(vertex(kFirstHoleRing + kHoleRings - i, firstColumn));
    std::vector<std::uint32_t> outer = outline;
    for (int layer = 1; layer <= kLayers; ++layer) {
      const double share = static_cast<double>(layer) / kLayers;
      std::vector<std::uint32_t> inner;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::vec3 corner = primitive_.positions[outline[i]];
        // The foot's vertices: evenly round, starting where the block's first corner is (pillarPoint()).
        const glm::dvec2 foot = center + kPillarRadius * onCircle(footTurns(pillar, static_cast<int>(i)));
        inner.push_back(addVertex(glm::mix(glm::dvec2(corner.x, -corner.z), foot, share)));
      }
      for (std::size_t i = 0; i < outer.size(); ++i) {
        const std::size_t next = (i + 1) % outer.size();
        addQuad(outer[next], outer[i], inner[i], inner[next]);
      }
      outer = std::move(inner);
    }
  }

 public:
  /// Direction of foot vertex `i` of a pillar. The block's first corner is seen from its middle at 5/8 of a turn from outwards.
  static double footTurns(int pillar, int i) {
    return (pillar + 0.5) / kPillars + 0.625 - static_cast<double>(i) / kPillarColumns;
  }

 private:
  Primitive& primitive_;
  std::size_t stride_;
  std::vector<std::uint32_t> grid_;
};

void addFloor(Scene& scene, int material) {
  Primitive& primitive = addPart(scene, "floor", material);
  FloorMesh(primitive).build();
  // The edge of the slab.
  const RoundedOutline outline(
      {{{kFloorRadius, 0.0}, 0.0}, {{kFloorRadius + 0.05, 0.0}, 0.04}, {{kFloorRadius + 0.05, -0.14}, 0.0}});
  Patch patch;
  patch.columns = kFloorColumns;
  patch.rowParameters = outline.parameters(0.07, 0.5);
  patch.rows = static_cast<int>(patch.rowParameters.size()) - 1;
  patch.texcoordScale = {12.0, 0.2};
  addPatch(
      primitive, patch, [&](double u, double v) { return revolved(outline.at(v), u); }, -1.0);
}

// ---- pillars ----

void addPillars(Scene& scene, int material) {
  Primitive& primitive = addPart(scene, "pillars", material);
  constexpr double kShaft = 0.125;
  constexpr double kShaftLow = 0.16;
  constexpr double kShaftHigh = kPillarHeight - 0.15;
  const RoundedOutline outline({{{kPillarRadius, 0.0}, 0.0},
                                {{kPillarRadius, 0.075}, 0.03},
                                {{0.145, 0.085}, 0.012},
                                {{0.138, 0.13}, 0.02},
                                {{kShaft, kShaftLow - 0.01}, 0.02},
                                {{kShaft * 0.9, kShaftHigh}, 0.03},
                                {{0.165, kPillarHeight - 0.085}, 0.03},
                                {{0.178, kPillarHeight - 0.075}, 0.008},
                                {{0.178, kPillarHeight}, 0.02},
                                {{0.0, kPillarHeight + 0.012}, 0.0}});
  Patch patch;
  patch.columns = kPillarColumns;
  patch.rowParameters = outline.parameters(0.08, 1.0);
  patch.rows = static_cast<int>(patch.rowParameters.size()) - 1;
  patch.texcoordScale = {1.0, 2.0};
  constexpr int kFlutes = 8;
  for (int pillar = 0; pillar < kPillars; ++pillar) {
    const glm::dvec3 foot = revolved({kPillarRing, 0.0}, (pillar + 0.5) / kPillars);
    const double start = FloorMesh::footTurns(pillar, 0);
    addPatch(
        primitive, patch,
        [&](double u, double v) {
          glm::dvec2 at = outline.at(v);
          // Flutes with round bottoms and narrow ridges, run out softly below and above.
          const double depth =
              0.024 * smooth(kShaftLow, kShaftLow + 0.09, at.y) * (1.0 - smooth(kShaftHigh - 0.1, kShaftHigh - 0.01, at.y));
          at.x -= depth * (1.0 - std::pow(std::abs(std::cos(kPi * kFlutes * u)), 3.0));
          return foot + revolved(at, start + u);
        },
        1.0);
  }
}

// ---- plinth and dome ----

void addPlinth(Scene& scene, int material) {
  Primitive& primitive = addPart(scene, "plinth", material);
  const RoundedOutline outline({{{kPlinthRadius, 0.0}, 0.0},
                                {{kPlinthRadius, 0.08}, 0.02},
                                {{0.56, 0.10}, 0.03},
                                {{0.53, 0.15}, 0.03},
                                {{0.53, kPlinthTop - 0.12}, 0.03},
                                {{0.59, kPlinthTop - 0.07}, 0.02},
                                {{0.59, kPlinthTop}, 0.02},
                                {{kDomeRadius, kPlinthTop}, 0.0}});
  Patch patch;
  patch.columns = kPlinthColumns;
  patch.rowParameters = outline.parameters(0.035, 0.5);
  patch.rows = static_cast<int>(patch.rowParameters.size()) - 1;
  patch.texcoordScale = {4.0, 1.0};
  addPatch(
      primitive, patch, [&](double u, double v) { return revolved(outline.at(v), u); }, 1.0);
}

constexpr int kGadroons = 8;

/// A bulging dome whose surface turns through deep grooves as it rises.
void addDome(Scene& scene, int material) {
  Primitive& primitive = addPart(scene, "dome", material);
  const RoundedOutline outline({{{kDomeRadius, kPlinthTop}, 0.0},
                                {{kDomeRadius, kPlinthTop + 0.035}, 0.015},
                                {{0.335, kPlinthTop + 0.05}, 0.02},
                                {{0.47, kPlinthTop + 0.17}, 0.12},
                                {{0.20, kDomeTop - 0.08}, 0.08},
                                {{0.215, kDomeTop - 0.02}, 0.02},
                                {{0.17, kDomeTop}, 0.02},
                                {{0.0, kDomeTop - 0.015}, 0.0}});
  Patch patch;
  patch.columns = 16 * kGadroons;
  static_assert(16 * kGadroons == kPlinthColumns);
  patch.rowParameters = outline.parameters(0.024, 0.5);
  patch.rows = static_cast<int>(patch.rowParameters.size()) - 1;
  patch.texcoordScale = {kGadroons / 2.0, 2.0};
  addPatch(
      primitive, patch,
      [&](double u, double v) {
        glm::dvec2 at = outline.at(v);
        const double lobed =
            smooth(kPlinthTop + 0.055, kPlinthTop + 0.12, at.y) * (1.0 - smooth(kDomeTop - 0.13, kDomeTop - 0.075, at.y));
        // Narrow in the groove, round on the lobe. The columns of vertices turn with the lobes, so that one runs along each groove.
        const double c = std::pow(std::cos(kPi * kGadroons * u), 2.0);
        at.x *= 1.0 - lobed * (0.07 * c + 0.15 * c * c * c);
        return revolved(at, u + 0.55 * (at.y - kPlinthTop));
      },
      1.0);
}

// ---- knot ----

/// A (2,3) torus knot, standing; its cross-section has rounded ridges that wind about it.
class Knot {
 public:
  static constexpr int kRidges = 5;

  Knot() {
    // Stand it on the dome, 3 mm above it: touching surfaces would share light they do not have.
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 400; ++i) {
      for (int j = 0; j < 60; ++j) lowest = std::min(lowest, raw(i / 400.0, j / 60.0).y);
    }
    lift_ = kDomeTop - 0.012 - lowest;
  }
  glm::dvec3 at(double u, double v) const { return raw(u, v) + glm::dvec3(0.0, lift_, 0.0); }

 private:
  static constexpr double kMajor = 0.335;
  static constexpr double kMinor = 0.150;
  static constexpr double kTube = 0.085;
  static constexpr double kTwists = 3.0;  ///< turns of a ridge about the tube over the whole knot; whole, so that it closes

  static glm::dvec3 center(double u) {
    const double t = 2.0 * kPi * u;
    const double radius = kMajor + kMinor * std::cos(3.0 * t);
    const double angle = 2.0 * t - 0.5 * kPi;  // one loop points down
    return {radius * std::cos(angle), radius * std::sin(angle), kMinor * std::sin(3.0 * t)};
  }

  glm::dvec3 raw(double u, double v) const {
    constexpr double kStep = 1e-4;
    const glm::dvec3 at = center(u);
    const glm::dvec3 along = glm::normalize(center(u + kStep) - center(u - kStep));
    // Out of the torus that the knot is wound on: turns with it and closes.
    const double angle = 4.0 * kPi * u - 0.5 * kPi;
    const glm::dvec3 ringCenter = kMajor * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    const glm::dvec3 spoke = at - ringCenter;
    const glm::dvec3 out = glm::normalize(spoke - along * glm::dot(spoke, along));
    const glm::dvec3 side = glm::cross(along, out);
    const double groove = std::pow(std::sin(kPi * kRidges * v), 4.0);
    const double radius = kTube * (1.0 - 0.30 * groove) * (1.0 + 0.06 * std::cos(2.0 * kPi * 12.0 * u));
    const glm::dvec2 c = onCircle(v - kTwists * u);  // rows of vertices follow the ridges
    const glm::dvec3 p = at + radius * (c.x * out + c.y * side);
    // A turn about the vertical, so that the camera sees it from the side a little.
    constexpr double kTurn = 0.42;
    return {std::cos(kTurn) * p.x + std::sin(kTurn) * p.z, p.y, -std::sin(kTurn) * p.x + std::cos(kTurn) * p.z};
  }

  double lift_ = 0.0;
};

void addKnot(Scene& scene, int material) {
  Primitive& primitive = addPart(scene, "knot", material);
  const Knot knot;
  Patch patch;
  patch.columns = 280;
  patch.rows = 10 * Knot::kRidges;
  patch.texcoordScale = {12.0, 1.0};
  addPatch(
      primitive, patch, [&](double u, double v) { return knot.at(u, v); }, -1.0);
}

// ---- materials ----

constexpr int kTexels = 256;

int stoneFloor(Scene& scene) {
  // Four tiles a repeat of one metre, laid as a chequer of honed pale and polished dark stone.
  const auto joint = [](glm::dvec2 uv) { return std::max(stripe(2.0 * uv.x, 0.006, 0.022), stripe(2.0 * uv.y, 0.006, 0.022)); };
  const auto dark = [](glm::dvec2 uv) {
    const double c = std::sin(2.0 * kPi * uv.x) * std::sin(2.0 * kPi * uv.y);
    return smooth(-0.02, 0.02, c);
  };
  Material material;
  material.name = "tiles";
  material.baseColorTexture = addColorTexture(scene, "tiles_color", kTexels, [&](glm::dvec2 uv) {
    const double cloud = periodicTurbulence(uv, 4, 3, 11);
    const glm::dvec3 pale = glm::dvec3(0.62, 0.56, 0.47) * (1.0 + 0.22 * cloud);
    const glm::dvec3 deep = glm::dvec3(0.13, 0.15, 0.17) * (1.0 + 0.55 * cloud);
    return glm::mix(glm::mix(pale, deep, dark(uv)), glm::dvec3(0.20, 0.18, 0.16), joint(uv));
  });
  material.metallicRoughnessTexture = addDataTexture(scene, "tiles_roughness", kTexels, [&](glm::dvec2 uv) {
    const double wear = 0.08 * periodicTurbulence(uv, 3, 2, 23);
    return roughnessMetallic(std::lerp(std::lerp(0.55, 0.22, dark(uv)) + wear, 0.85, joint(uv)), 0.0);
  });
  material.normalTexture = addNormalTexture(scene, "tiles_normal", kTexels, {1.0, 1.0}, [&](glm::dvec2 uv) {
    return -0.0035 * joint(uv) + 0.0022 * periodicNoise(uv, 5, 31);
  });
  return addMaterial(scene, material);
}

int limestone(Scene& scene) {
  Material material;
  material.name = "limestone";
  material.baseColorTexture = addColorTexture(scene, "limestone_color", kTexels, [](glm::dvec2 uv) {
    const double layers = periodicTurbulence({uv.x, uv.y}, 3, 4, 41);
    return glm::mix(glm::dvec3(0.70, 0.63, 0.52), glm::dvec3(0.52, 0.43, 0.33), smooth(-0.4, 0.6, layers));
  });
  material.metallicRoughnessTexture = addDataTexture(scene, "limestone_roughness", kTexels, [](glm::dvec2 uv) {
    return roughnessMetallic(0.72 + 0.1 * periodicTurbulence(uv, 4, 2, 43), 0.0);
  });
  material.normalTexture = addNormalTexture(scene, "limestone_normal", kTexels, {0.8, 0.7},
                                            [](glm::dvec2 uv) { return 0.006 * periodicTurbulence(uv, 8, 2, 47); });
  return addMaterial(scene, material);
}

int polishedMarble(Scene& scene) {
  const auto vein = [](glm::dvec2 uv) {
    const double wander = periodicTurbulence(uv, 3, 3, 53);
    return std::pow(1.0 - std::abs(std::sin(kPi * (uv.x + 2.0 * uv.y + 1.3 * wander))), 5.0);
  };
  Material material;
  material.name = "green marble";
  material.baseColorTexture = addColorTexture(scene, "marble_color", kTexels, [&](glm::dvec2 uv) {
    const double cloud = 0.5 + 0.5 * periodicTurbulence(uv, 4, 3, 59);
    return glm::mix(glm::mix(glm::dvec3(0.012, 0.030, 0.027), glm::dvec3(0.04, 0.085, 0.068), cloud),
                    glm::dvec3(0.55, 0.60, 0.52), 0.8 * vein(uv));
  });
  material.metallicRoughnessTexture = addDataTexture(
      scene, "marble_roughness", kTexels, [&](glm::dvec2 uv) { return roughnessMetallic(0.08 + 0.2 * vein(uv), 0.0); });
  return addMaterial(scene, material);
}

/// Blue glaze on the lobes, gold leaf in a lattice over them, bare clay where it is worn.
int glazeAndGold(Scene& scene) {
  const auto gold = [](glm::dvec2 uv) { return std::max(stripe(uv.x + uv.y, 0.045, 0.05), stripe(uv.x - uv.y, 0.045, 0.05)); };
  const auto worn = [](glm::dvec2 uv) { return smooth(0.20, 0.34, periodicTurbulence(uv, 3, 2, 61)); };
  Material material;
  material.name = "glaze and gold";
  material.baseColorTexture = addColorTexture(scene, "glaze_color", kTexels, [&](glm::dvec2 uv) {
    const glm::dvec3 glaze =
        glm::mix(glm::dvec3(0.015, 0.06, 0.22), glm::dvec3(0.03, 0.16, 0.34), 0.5 + 0.5 * periodicTurbulence(uv, 2, 3, 67));
    return glm::mix(glm::mix(glaze, glm::dvec3(0.45, 0.22, 0.12), worn(uv)), glm::dvec3(1.0, 0.72, 0.32), gold(uv));
  });
  material.metallicRoughnessTexture = addDataTexture(scene, "glaze_roughness", kTexels, [&](glm::dvec2 uv) {
    const double base = std::lerp(0.18, 0.8, worn(uv));
    return roughnessMetallic(std::lerp(base, 0.3, gold(uv)), gold(uv));
  });
  material.normalTexture = addNormalTexture(scene, "glaze_normal", kTexels, {0.5, 0.4},
                                            [&](glm::dvec2 uv) { return 0.004 * gold(uv) + 0.006 * periodicNoise(uv, 4, 71); });
  return addMaterial(scene, material);
}

/// Copper brushed along the knot, with bands of smooth silver that are not.
int brushedCopper(Scene& scene) {
  const auto band = [](glm::dvec2 uv) { return stripe(uv.x, 0.13, 0.03); };
  Material material;
  material.name = "brushed copper";
  material.anisotropyStrength = 0.7f;
  material.baseColorTexture = addColorTexture(scene, "copper_color", kTexels, [&](glm::dvec2 uv) {
    const double patina = smooth(0.1, 0.5, periodicTurbulence(uv, 4, 3, 73));
    const glm::dvec3 copper = glm::mix(glm::dvec3(0.93, 0.52, 0.36), glm::dvec3(0.72, 0.40, 0.25), patina);
    return glm::mix(copper, glm::dvec3(0.94, 0.92, 0.88), band(uv));
  });
  material.metallicRoughnessTexture = addDataTexture(scene, "copper_roughness", kTexels, [&](glm::dvec2 uv) {
    const double brushed = 0.34 + 0.08 * periodicTurbulence(uv, 4, 2, 79);
    return roughnessMetallic(std::lerp(brushed, 0.15, band(uv)), 1.0);
  });
  material.anisotropyTexture = addDataTexture(scene, "copper_brushing", kTexels, [&](glm::dvec2 uv) {
    return glm::dvec3(1.0, 0.5, 1.0 - band(uv));  // along the tangent
  });
  material.normalTexture = addNormalTexture(scene, "copper_normal", kTexels, {0.43, 0.5}, [&](glm::dvec2 uv) {
    return -0.004 * stripe(uv.x - 0.18, 0.01, 0.05) - 0.004 * stripe(uv.x + 0.18, 0.01, 0.05) + 0.003 * periodicNoise(uv, 6, 83);
  });
  return addMaterial(scene, material);
}

}  // namespace

Scene ornament() {
  Scene scene;
  addFloor(scene, stoneFloor(scene));
  addPillars(scene, limestone(scene));
  addPlinth(scene, polishedMarble(scene));
  addDome(scene, glazeAndGold(scene));
  addKnot(scene, brushedCopper(scene));
  for (Primitive& primitive : scene.primitives) dropUnusedVertices(primitive);
  Camera camera = lookAt({0.45f, 1.85f, 5.6f}, {0.0f, 0.83f, 0.0f}, 0.475f, boundsOf(scene));
  camera.name = "three-quarter view";
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace chiaro::builtin
