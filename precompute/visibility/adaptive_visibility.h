#pragma once
/// What a vertex sees, traced at a coarse resolution everywhere and at a fine one only where visibility changes.

#include <cstdint>
#include <vector>

#include "precompute/embree/ray_scene.h"
#include "precompute/visibility/sphere_boards.h"
#include "precompute/visibility/viewpoints.h"
#include "precompute/visibility/visibility.h"

namespace chiaro {

/// The maps of every resolution from coarse to sampling; what is the same for every vertex and thread.
struct AdaptiveSphere {
  /// coarse: a multiple of 8; sampling: coarse times a power of two. leastOccluder: radians, an angular diameter: no occluder so wide is
  /// missed, and one partly below the horizon counts as wide as a disc that fits into what is above; 0 promises nothing, and tracing
  /// starts at `coarse`. Throws std::invalid_argument, also where the sampling resolution cannot keep the promise.
  AdaptiveSphere(int coarse, int sampling, double leastOccluder = 0.0);

  std::vector<SphereBoards> levels;  ///< coarse first
  std::size_t first = 0;             ///< the level that is traced throughout; those before it only take from the sampling one
};

/// The largest angle from any direction to the nearest texel centre of a map, radians: a disc of that angular radius or more
/// covers a centre wherever it is. resolution: even.
double coveringRadius(int resolution);

/// One thread's. At the first level every direction above the horizon is traced. A finer texel starts with the value of its
/// parent (the one a level up that holds it) and is traced where that differs from one that shares an edge with it, or where its
/// parent is below the horizon and the texels about the parent disagree; and where a traced value turns out to differ from one beside it,
/// that one is traced too, until there is no more such pair. So every pair that differs has been traced, and a feature is followed
/// to its end if the level before has met it anywhere. What falls between the coarse texels altogether is missed, except next to the
/// horizon: nine of ten misses of a scanned surface are there, so of the last row of texels above it one in eight is traced whatever the
/// coarse levels say, and all of it about one that turns out other than they said.
class AdaptiveVisibility {
 public:
  AdaptiveVisibility(const RayScene& rays, const AdaptiveSphere& sphere);

  /// Double-sided viewpoints: each side of the horizon from its own origin. Returns the number of rays.
  std::uint64_t operator()(const Viewpoint& viewpoint);

  /// Of the last viewpoint, at the sampling resolution. Bits of `visible` are 0 below the horizon of a one-sided one.
  const TexelBits& above() const { return above_; }
  const TexelBits& visible() const { return visible_; }

  /// The same at a level's resolution: where a ray went through a texel's centre what it met, elsewhere (nothing changes nearby, or the
  /// level was skipped) the sampling texel that holds it. Throws std::invalid_argument if `resolution` is no level.
  void at(int resolution, TexelBits& above, TexelBits& visible) const;

  /// Traced at the sampling resolution itself: #boards of its level.
  const std::vector<Board>& traced() const { return maps_.back().traced; }

 private:
  struct Map {
    std::vector<Board> side;          ///< where rays go from this side of the horizon
    std::vector<Board> seen, hidden;  ///< what is known of it so far: disjoint
    std::vector<Board> traced;
    std::vector<Board> visible;       ///< both sides
  };

  void traceSide(glm::vec3 origin);
  void traceAll(std::size_t level);
  void inherit(std::size_t level);
  void refine(std::size_t level);
  void refineRound(std::size_t level, bool first);
  void traceTile(std::size_t level, std::size_t tile, unsigned which);
  void traceGathered(std::size_t level);
  void settle(std::size_t level, std::size_t texel, bool hit);
  void mark(std::size_t board);

  const AdaptiveSphere& sphere_;
  OcclusionPacket packet_;
  std::vector<Map> maps_;  ///< by level
  std::vector<Board> otherSide_, horizon_;  ///< of the finest level
  std::vector<std::uint8_t> whole_;  ///< a board's part of the horizon is traced throughout: 1 as one beside it is, 2 for what it met
  bool bothSides_ = false;
  std::vector<std::uint32_t> round_, next_;
  std::vector<std::uint8_t> marked_;
  std::vector<Board> changed_;
  alignas(64) float x_[16] = {}, y_[16] = {}, z_[16] = {};
  std::uint32_t texel_[16] = {};  ///< 64 board + bit
  unsigned gathered_ = 0;
  std::uint64_t rays_ = 0;
  TexelBits above_, visible_;
};

}  // namespace chiaro
