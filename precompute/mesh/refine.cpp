#include "precompute/mesh/refine.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <vector>

#include "assets/error.h"
#include "precompute/embree/ray_scene.h"
#include "precompute/mesh/normals.h"
#include "precompute/mesh/subdivide.h"
#include "precompute/mesh/transfer_probe.h"
#include "precompute/parallel.h"
#include "precompute/visibility/viewpoints.h"

namespace chiaro {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kBlock = 16;

void requireValid(const RefineSettings& settings) {
  const auto require = [](bool holds, const char* name, const char* remedy) {
    if (!holds) throw usageError(name, "is out of range", remedy);
  };
  require(settings.error > 0.0f && settings.error <= 1.0f, "refine error", "give a share above 0, up to 1");
  require(settings.leastEdge > 0.0f && settings.leastEdge <= 1.0f, "refine least edge", "give a share above 0, up to 1");
  require(settings.spacing > 0.0f && settings.spacing <= 1.0f, "refine spacing", "give a share above 0, up to 1");
  require(settings.resolution >= 16 && settings.resolution <= 256 && settings.resolution % 4 == 0, "refine resolution",
          "give a multiple of 4 from 16 to 256");
}

/// The first pair of vertices of an edge: the same in every pass until the edge is split.
using EdgeName = std::array<std::uint32_t, 3>;

EdgeName nameOf(const EdgeTable& table, std::size_t edge) {
  const auto& side = table.sides[table.firstSide[edge]];
  return {side.primitive, side.a, side.b};
}

class Refinement {
 public:
  Refinement(Scene& scene, const RefineSettings& settings, int threads, RefineReport& report, const std::function<void(double)>& progress)
      : source_(scene),
        scene_(scene),
        settings_(settings),
        threads_(threads),
        report_(report),
        progress_(progress),
        rays_(source_),
        probe_(rays_, settings.resolution),
        firstNew_(scene.primitives.size(), 0),
        ssdf_(scene.primitives.size()) {
    const auto bounds = boundsOf(scene);
    const auto magnitude = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
    const double diagonal = static_cast<double>(bounds.diagonal());
    // Below some hundred roundings of the coordinates a middle is no middle, and a triangle no plane.
    const double rounding = 256.0 * static_cast<double>(std::numeric_limits<float>::epsilon() * std::max({magnitude.x, magnitude.y, magnitude.z}));
    leastEdge_ = std::max(static_cast<double>(settings.leastEdge) * diagonal, rounding);
    spacing_ = static_cast<double>(settings.spacing) * diagonal;
  }

  void run() {
    for (bool full = false;; ++report_.passes) {
      const EdgeTable table(scene_);
      measure(table);
      const auto candidates = candidatesOf(table);
      if (candidates.empty() || full) {
        finish(table);
        return;
      }
      std::vector<bool> marked(table.size(), false);
      full = !mark(table, candidates, marked);
      if (std::none_of(marked.begin(), marked.end(), [](bool m) { return m; })) {
        finish(table);
        return;
      }
      for (std::size_t e = 0; e < table.size(); ++e)
        if (marked[e]) tooWrong_.erase(nameOf(table, e));
      for (std::size_t p = 0; p < firstNew_.size(); ++p) firstNew_[p] = static_cast<std::uint32_t>(scene_.primitives[p].positions.size());
      subdivide(scene_, table, marked);
    }
  }

 private:
  bool isNew(const EdgeSide& side) const { return std::max(side.a, side.b) >= firstNew_[side.primitive]; }

  /// Runs `work(i, scratch)` for i in [0, count) on all threads; each i writes to its own place.
  template <typename Work>
  void forEach(std::size_t count, double firstShare, double lastShare, const Work& work) {
    const std::function<void(double)> part = [&](double done) { show(firstShare + (lastShare - firstShare) * done); };
    StepCounter steps(count, progress_ ? part : progress_);
    std::mutex mutex;
    parallelBlocks(threads_, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
      TransferProbe::Scratch scratch(probe_);
      const auto end = std::min((block + 1) * kBlock, count);
      for (std::size_t i = block * kBlock; i < end; ++i) work(i, scratch);
      {
        const std::lock_guard lock(mutex);
        report_.raysTraced += scratch.rays;
      }
      steps.add(end - block * kBlock);
    });
  }

  /// How many passes are to come nobody knows: each gets half of what is left.
  void show(double shareOfPass) const {
    if (progress_) progress_(1.0 - std::ldexp(1.0 - 0.5 * shareOfPass, -report_.passes));
  }

  /// Looks at what the last pass made: its edges, then the inside of its triangles none of whose edges is too wrong already.
  void measure(const EdgeTable& table) {
    std::vector<std::uint32_t> wings;  // first side of each
    std::vector<std::uint32_t> edgeOfWing;
    for (std::uint32_t e = 0; e < table.size(); ++e) {
      for (auto s = table.firstSide[e]; s < table.firstSide[e + 1]; ++s) {
        if (s != table.firstSide[e] && table.sides[s].sameWing(table.sides[s - 1])) continue;
        if (!isNew(table.sides[s]) || (report_.passes == 0 && table.length[e] < leastEdge_)) continue;
        wings.push_back(s);
        edgeOfWing.push_back(e);
      }
    }
    std::vector<Face> faces;
    std::uint32_t triangle = 0;
    for (std::uint32_t p = 0; p < scene_.primitives.size(); ++p) {
      const auto& indices = scene_.primitives[p].indices;
      for (std::uint32_t i = 0; i < indices.size(); i += 3, ++triangle) {
        const bool fresh = std::max({indices[i], indices[i + 1], indices[i + 2]}) >= firstNew_[p];
        if (fresh && table.length[table.longestOf(triangle)] >= leastEdge_) faces.push_back({p, i, triangle});
      }
    }
    traceCorners(table, wings, faces);

    std::vector<double> error(wings.size());
    forEach(wings.size(), 0.3, 0.6, [&](std::size_t i, TransferProbe::Scratch& scratch) { error[i] = wingError(table, wings[i], scratch); });
    for (std::size_t i = 0; i < wings.size(); ++i) note(table, edgeOfWing[i], error[i]);

    std::erase_if(faces, [&](const Face& face) {
      for (std::size_t c = 0; c < 3; ++c)
        if (tooWrong_.contains(nameOf(table, table.edgeOfCorner[3 * std::size_t{face.triangle} + c]))) return true;
      return false;
    });
    error.assign(faces.size(), 0.0);
    forEach(faces.size(), 0.6, 1.0,
            [&](std::size_t i, TransferProbe::Scratch& scratch) { error[i] = faceError(table, faces[i], scratch); });
    for (std::size_t i = 0; i < faces.size(); ++i) note(table, table.longestOf(faces[i].triangle), error[i]);
  }

  void note(const EdgeTable& table, std::size_t edge, double error) {
    if (!(error > static_cast<double>(settings_.error))) return;
    auto& known = tooWrong_[nameOf(table, edge)];
    known = std::max(known, error);
  }

  /// A triangle by its first index in the primitive.
  struct Face {
    std::uint32_t primitive = 0, firstIndex = 0, triangle = 0;
  };

  /// SSDFs where `wings` and `faces` end, and nowhere else: what is settled needs none.
  void traceCorners(const EdgeTable& table, const std::vector<std::uint32_t>& wings, const std::vector<Face>& faces) {
    std::vector<std::vector<bool>> needed;
    for (const auto& primitive : scene_.primitives) needed.emplace_back(primitive.positions.size(), false);
    for (const auto s : wings) needed[table.sides[s].primitive][table.sides[s].a] = needed[table.sides[s].primitive][table.sides[s].b] = true;
    for (const auto& face : faces)
      for (std::size_t c = 0; c < 3; ++c) needed[face.primitive][scene_.primitives[face.primitive].indices[face.firstIndex + c]] = true;

    const auto viewpoints = viewpointsOf(scene_, rays_);
    struct Vertex {
      CoarseSsdf* ssdf;
      const Viewpoint* viewpoint;
    };
    std::vector<Vertex> missing;
    std::size_t first = 0;
    for (std::size_t p = 0; p < ssdf_.size(); ++p) {
      ssdf_[p].resize(needed[p].size());
      for (std::size_t v = 0; v < needed[p].size(); ++v) {
        if (!needed[p][v])
          ssdf_[p][v] = {};
        else if (ssdf_[p][v].empty())
          missing.push_back({&ssdf_[p][v], &viewpoints[first + v]});
      }
      first += needed[p].size();
    }
    forEach(missing.size(), 0.0, 0.3,
            [&](std::size_t i, TransferProbe::Scratch& scratch) { *missing[i].ssdf = probe_.trace(*missing[i].viewpoint, scratch); });
  }

  /// Of a triangle, towards the side the vertices' normals say is its front.
  glm::vec3 planeOf(const Primitive& primitive, std::size_t firstIndex, glm::vec3 normal) const {
    const auto at = [&](std::size_t c) { return primitive.positions[primitive.indices[firstIndex + c]]; };
    const glm::vec3 plane(triangleNormal(at(0), at(1), at(2)));
    return glm::dot(plane, normal) < 0.0f ? -plane : plane;
  }

  Viewpoint viewpointAt(const Primitive& primitive, glm::dvec3 position, glm::vec3 normal, glm::dvec3 inward) const {
    const double offset = static_cast<double>(rays_.surfaceOffset(glm::vec3(position)));
    const glm::dvec3 n(normal);
    return {.normal = normal,
            .front = glm::vec3(position + offset * (inward + n)),
            .back = glm::vec3(position + offset * (inward - n)),
            .doubleSided = materialOf(scene_, primitive).doubleSided};
  }

  double wingError(const EdgeTable& table, std::uint32_t firstSide, TransferProbe::Scratch& scratch) const {
    const auto& wing = table.sides[firstSide];
    const auto& primitive = scene_.primitives[wing.primitive];
    const auto edge = table.edgeOfCorner[3 * std::size_t{wing.triangle} + wing.corner];
    const glm::dvec3 a(primitive.positions[wing.a]), b(primitive.positions[wing.b]);
    const glm::dvec3 na(primitive.normals[wing.a]), nb(primitive.normals[wing.b]);
    const glm::vec3 sum(na + nb);

    std::vector<glm::vec3> planes;
    glm::dvec3 inward(0.0);  // as viewpointsOf() has it for the vertex that may come here
    for (auto s = firstSide; s < table.firstSide[edge + 1] && table.sides[s].sameWing(wing); ++s) {
      const auto& side = table.sides[s];
      planes.push_back(planeOf(primitive, side.firstIndex, sum));
      const glm::dvec3 opposite(primitive.positions[primitive.indices[side.firstIndex + (side.corner + 2) % 3]]);
      const auto along = (b - a) / table.length[edge];
      const auto into = opposite - a - glm::dot(opposite - a, along) * along;
      if (glm::length(into) > 0.0) inward += glm::normalize(into);
    }
    const auto parts = 2 * static_cast<int>(std::max(1.0, std::ceil(0.5 * table.length[edge] / spacing_)));
    double worst = 0.0;
    for (int i = 1; i < parts; ++i) {
      const double share = static_cast<double>(i) / parts;
      const auto n = glm::vec3(glm::normalize((1.0 - share) * na + share * nb));
      auto tangential = inward - glm::dot(inward, glm::dvec3(n)) * glm::dvec3(n);
      const double length = glm::length(tangential);
      tangential = length > 0.3 ? tangential / length : glm::dvec3(0.0);
      const std::array corners{WeightedSsdf{&ssdf_[wing.primitive][wing.a], static_cast<float>(1.0 - share)},
                               WeightedSsdf{&ssdf_[wing.primitive][wing.b], static_cast<float>(share)}};
      const auto viewpoint = viewpointAt(primitive, glm::mix(a, b, share), n, tangential);
      worst = std::max(worst, probe_.error(viewpoint, planes, corners, enough_, scratch));
    }
    return worst;
  }

  /// At the centroid, or on a grid no coarser than the spacing; of the first point above E.
  double faceError(const EdgeTable& table, const Face& face, TransferProbe::Scratch& scratch) const {
    const auto& primitive = scene_.primitives[face.primitive];
    const auto* v = &primitive.indices[face.firstIndex];
    const auto parts = static_cast<int>(std::max(3.0, std::ceil(table.length[table.longestOf(face.triangle)] / spacing_)));
    for (int i = 1; i < parts; ++i) {
      for (int j = 1; i + j < parts; ++j) {
        const glm::dvec3 share = glm::dvec3(parts - i - j, i, j) / static_cast<double>(parts);
        glm::dvec3 position(0.0), normal(0.0);
        std::array<WeightedSsdf, 3> corners;
        for (int c = 0; c < 3; ++c) {
          position += share[c] * glm::dvec3(primitive.positions[v[c]]);
          normal += share[c] * glm::dvec3(primitive.normals[v[c]]);
          corners[static_cast<std::size_t>(c)] = {&ssdf_[face.primitive][v[c]], static_cast<float>(share[c])};
        }
        const auto n = glm::vec3(glm::normalize(normal));
        const std::array planes{planeOf(primitive, face.firstIndex, n)};
        const double error = probe_.error(viewpointAt(primitive, position, n, glm::dvec3(0.0)), planes, corners, enough_, scratch);
        if (error > static_cast<double>(settings_.error)) return error;
      }
    }
    return 0.0;
  }

  /// What is too wrong and long enough, worst first: by wrong solid angle times the area it is wrong on.
  std::vector<std::uint32_t> candidatesOf(const EdgeTable& table) const {
    std::vector<std::pair<double, std::uint32_t>> ranked;
    for (std::uint32_t e = 0; e < table.size(); ++e) {
      if (table.length[e] < leastEdge_) continue;
      const auto it = tooWrong_.find(nameOf(table, e));
      if (it != tooWrong_.end()) ranked.emplace_back(-it->second * table.length[e] * table.length[e], e);
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::uint32_t> result;
    for (const auto& [rank, e] : ranked) result.push_back(e);
    return result;
  }

  /// Marks `candidates` and what must be split with them, while there are vertices for it. False when they ran out.
  bool mark(const EdgeTable& table, const std::vector<std::uint32_t>& candidates, std::vector<bool>& marked) const {
    std::size_t vertices = scene_.vertexCount();
    std::vector<std::uint32_t> chain;
    for (const auto candidate : candidates) {
      if (marked[candidate]) continue;
      chain.assign(1, candidate);
      marked[candidate] = true;
      std::size_t added = 0;
      for (std::size_t i = 0; i < chain.size(); ++i) {
        const auto e = chain[i];
        added += table.wings[e];
        for (auto s = table.firstSide[e]; s < table.firstSide[e + 1]; ++s) {
          const auto longest = table.longestOf(table.sides[s].triangle);
          if (marked[longest]) continue;
          marked[longest] = true;
          chain.push_back(longest);
        }
      }
      vertices += added;
      if (vertices <= settings_.mostVertices) continue;
      for (const auto e : chain) marked[e] = false;
      return false;
    }
    return true;
  }

  void finish(const EdgeTable& table) {
    for (std::uint32_t e = 0; e < table.size(); ++e) {
      const auto it = tooWrong_.find(nameOf(table, e));
      if (it == tooWrong_.end()) continue;
      ++(table.length[e] < leastEdge_ ? report_.edgesTooShort : report_.edgesOverBudget);
      report_.worstError = std::max(report_.worstError, it->second);
    }
    if (progress_) progress_(1.0);
  }

  const Scene source_;  ///< the surface does not change: rays are traced against its few triangles
  Scene& scene_;
  const RefineSettings& settings_;
  const int threads_;
  RefineReport& report_;
  const std::function<void(double)>& progress_;
  const RayScene rays_;
  const TransferProbe probe_;
  const double enough_ = 0.25 * static_cast<double>(settings_.error);  ///< a quarter of the directions may be this wrong
  double leastEdge_ = 0.0, spacing_ = 0.0;
  std::vector<std::uint32_t> firstNew_;       ///< per primitive: vertices from here on came with the last pass
  std::vector<std::vector<CoarseSsdf>> ssdf_; ///< per primitive and vertex; empty where nothing is measured
  std::map<EdgeName, double> tooWrong_;       ///< edges above E
};

}  // namespace

Scene refineScene(Scene scene, const RefineSettings& settings, int threads, RefineReport& report,
                  const std::function<void(double)>& progress) {
  requireValid(settings);
  report = {};
  const auto start = Clock::now();
  const auto vertices = scene.vertexCount(), triangles = scene.triangleCount();
  if (triangles > 0) Refinement(scene, settings, threads, report, progress).run();
  report.verticesAdded = scene.vertexCount() - vertices;
  report.trianglesAdded = scene.triangleCount() - triangles;
  report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return scene;
}

}  // namespace chiaro
