// SPDX-License-Identifier: Apache-2.0
// T. Aila, T. Akenine-Möller, A hierarchical shadow volume algorithm, Graphics Hardware 2004: a tile whose box meets no
// face of a shadow volume is inside or outside it as a whole. Departures: boxes are those of the tile's view samples,
// not of its pixels between the least and the largest depth; all volumes are tested together; a hierarchy over tiles
// replaces the rasteriser's stages.
//
// Triangles of the carrier's plane do not count, so a tile whose view samples are in several planes is never whole. For
// the tiles of one plane, the remaining faces are those of all other triangles: their caps, the sides of silhouette
// edges, and the sides of edges where the triangles of the plane end, which no longer cancel (`Rim`).

#include "volumes/raster/shadow_tiles.hpp"

#include "base/assert.hpp"
#include "base/parallel.hpp"
#include "volumes/raster/small_vectors.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <set>
#include <tuple>

namespace penumbra::volumes {
namespace {

constexpr std::uint32_t kNoPlane = gpu::kNotCounted, kManyPlanes = gpu::kNotCounted - 1;

/// View samples of a tile, or of a block of tiles: their box, relative to l, and the plane of their carriers.
struct Block {
  glm::dvec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};
  std::uint32_t plane = kNoPlane;

  void add(const Block& other) {
    if (other.plane == kNoPlane) return;
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
    plane = plane == kNoPlane || plane == other.plane ? other.plane : kManyPlanes;
  }
};

/// A convex set of points x relative to l: direction · x ≥ offset for each bound. Directions are products of up to
/// three differences of floats; `error` times the 1-norms of x bounds the rounding of direction · x − offset.
///
/// Each component of a product of two vectors is off by at most 8 units (2⁻⁵³) of the product of their 1-norms, and of
/// a product of three by 18; direction · x adds 8. kDeterminantError is 32 units; twice that is taken.
class ConvexFace {
 public:
  [[nodiscard]] bool misses(const Block& block) const {
    const glm::dvec3 middle = 0.5 * (block.lower + block.upper), half = 0.5 * (block.upper - block.lower);
    const double size = norm1(middle) + norm1(half);
    for (std::size_t i = 0; i < count_; ++i) {
      const Bound& bound = bounds_[i];
      const double most = glm::dot(bound.direction, middle) + glm::dot(glm::abs(bound.direction), half);
      if (most < bound.offset - bound.error * (size + bound.size)) return true;
    }
    return false;
  }

  /// Returns the side face of the edge a b, which extends from the edge away from l to infinity.
  static ConvexFace side(const glm::dvec3& a, const glm::dvec3& b) {
    ConvexFace face;
    const glm::dvec3 n = glm::cross(a, b), along = b - a;
    const double size = norm1(a) * norm1(b);
    face.add_plane(n, glm::dvec3(0), size);
    face.add(glm::cross(along, n), a, size * norm1(along));  // beyond the edge
    face.add(glm::cross(n, a), glm::dvec3(0), size * norm1(a));
    face.add(glm::cross(b, n), glm::dvec3(0), size * norm1(b));
    return face;
  }

  static ConvexFace triangle(const std::array<glm::dvec3, 3>& corners) {
    ConvexFace face;
    const glm::dvec3 first = corners[1] - corners[0], second = corners[2] - corners[0];
    const glm::dvec3 n = glm::cross(first, second);
    const double size = norm1(first) * norm1(second);
    face.add_plane(n, corners[0], size);
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 along = corners[(i + 1) % 3] - corners[i];
      face.add(glm::cross(n, along), corners[i], size * norm1(along));
    }
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 unit(0);
      unit[axis] = 1;
      const auto [least, most] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
      face.add(unit, unit * least, 1);
      face.add(-unit, unit * most, 1);
    }
    return face;
  }

 private:
  struct Bound {
    glm::dvec3 direction;
    double offset, error, size;
  };
  void add(const glm::dvec3& direction, const glm::dvec3& through, double size) {
    bounds_[count_++] = {direction, glm::dot(direction, through), 2 * gpu::kDeterminantError * size, norm1(through)};
  }
  void add_plane(const glm::dvec3& normal, const glm::dvec3& through, double size) {
    add(normal, through, size);
    add(-normal, through, size);
  }

  std::array<Bound, 11> bounds_{};
  std::size_t count_ = 0;
};

/// An edge where the triangles of a plane end.
struct Rim {
  std::uint32_t plane;
  glm::vec3 a, b;
};

/// Returns the rims of these planes: edges at which their triangles (counter-clockwise as seen from l) do not cancel.
std::vector<Rim> rims_of(const LightVolumes& volumes, const std::set<std::uint32_t>& planes) {
  struct Directed {
    Rim rim;  ///< with ordered ends: a before b
    std::int32_t sign;
  };
  const auto place = [](const glm::vec3& x) { return std::tuple(x.x, x.y, x.z); };
  const auto key = [&](const Rim& rim) { return std::tuple(rim.plane, place(rim.a), place(rim.b)); };
  std::vector<Directed> edges;
  for (const VolumeCap& cap : volumes.caps) {
    if (!planes.contains(cap.plane)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 &a = cap.corners[i], &b = cap.corners[(i + 1) % 3];
      const bool forward = place(a) < place(b);
      edges.push_back({{cap.plane, forward ? a : b, forward ? b : a}, forward ? 1 : -1});
    }
  }
  std::ranges::sort(edges, [&](const Directed& x, const Directed& y) { return key(x.rim) < key(y.rim); });
  std::vector<Rim> rims;
  for (auto at = edges.begin(); at != edges.end();) {
    std::int32_t sum = 0;
    const Rim rim = at->rim;
    for (; at != edges.end() && key(at->rim) == key(rim); ++at) sum += at->sign;
    if (sum != 0) rims.push_back(rim);
  }
  return rims;
}

/// Quadtree over the tiles of some rows: level 0 is the tiles; each further level has a block for each four of the
/// level below.
class TileTree {
 public:
  TileTree(const glm::vec3& l, std::span<const gpu::VolumeReceiver> receivers, std::uint32_t width) {
    const auto rows = static_cast<std::uint32_t>(receivers.size() / width);
    levels_.emplace_back(tiles_across(width), tiles_across(rows));
    for (std::size_t i = 0; i < receivers.size(); ++i) {
      if (receivers[i].plane == gpu::kNotCounted) continue;
      const glm::dvec3 x = glm::dvec3(receivers[i].p) - glm::dvec3(l);
      levels_[0].blocks[tile_of(i, width)].add({x, x, receivers[i].plane});
    }
    touched_.resize(levels_[0].blocks.size());
    for (std::size_t i = 0; i < touched_.size(); ++i) touched_[i] = levels_[0].blocks[i].plane == kManyPlanes ? 1 : 0;
    while (levels_.back().blocks.size() > 1) {
      const Level& below = levels_.back();
      Level level((below.width + 1) / 2, (below.height + 1) / 2);
      for (std::uint32_t y = 0; y < below.height; ++y) {
        for (std::uint32_t x = 0; x < below.width; ++x) level.at(x / 2, y / 2).add(below.at(x, y));
      }
      levels_.push_back(std::move(level));
    }
  }

  [[nodiscard]] std::size_t tile_of(std::size_t pixel, std::uint32_t width) const {
    return pixel / width / kTileSide * levels_[0].width + pixel % width / kTileSide;
  }
  [[nodiscard]] std::span<const Block> tiles() const { return levels_[0].blocks; }
  [[nodiscard]] bool is_touched(std::size_t tile) const { return touched_[tile] != 0; }

  /// Marks the tiles that a face meets, among those where `concerns(plane)` is true for the plane of all carriers.
  template <typename Concerns>
  void touch(const ConvexFace& face, const Concerns& concerns) {
    visit(face, concerns, levels_.size() - 1, 0, 0);
  }

 private:
  struct Level {
    Level(std::uint32_t across, std::uint32_t down) : width(across), height(down), blocks(std::size_t{across} * down) {}
    Block& at(std::uint32_t x, std::uint32_t y) { return blocks[std::size_t{y} * width + x]; }
    [[nodiscard]] const Block& at(std::uint32_t x, std::uint32_t y) const { return blocks[std::size_t{y} * width + x]; }
    std::uint32_t width, height;
    std::vector<Block> blocks;
  };

  static std::uint32_t tiles_across(std::uint32_t pixels) { return (pixels + kTileSide - 1) / kTileSide; }

  template <typename Concerns>
  void visit(const ConvexFace& face, const Concerns& concerns, std::size_t level, std::uint32_t x, std::uint32_t y) {
    const Block& block = levels_[level].at(x, y);
    if (block.plane == kNoPlane || (block.plane != kManyPlanes && !concerns(block.plane)) || face.misses(block)) return;
    if (level == 0) {
      std::atomic_ref(touched_[std::size_t{y} * levels_[0].width + x]).store(1, std::memory_order_relaxed);
      return;
    }
    const Level& below = levels_[level - 1];
    for (std::uint32_t row = 2 * y; row < std::min(2 * y + 2, below.height); ++row) {
      for (std::uint32_t column = 2 * x; column < std::min(2 * x + 2, below.width); ++column) {
        visit(face, concerns, level - 1, column, row);
      }
    }
  }

  std::vector<Level> levels_;
  std::vector<std::uint32_t> touched_;  ///< 1 for each tile that is not whole
};

}  // namespace

TilePlan plan_tiles(const LightVolumes& volumes, std::span<const gpu::VolumeReceiver> receivers, std::uint32_t width) {
  PENUMBRA_ASSERT(width > 0 && receivers.size() % width == 0, "{} pixels in rows of {}", receivers.size(), width);
  TilePlan plan{std::vector<std::uint32_t>(receivers.size(), kNoPixel)};
  if (receivers.empty()) return plan;
  TileTree tree(volumes.l, receivers, width);
  const auto from_l = [&](const glm::vec3& x) { return glm::dvec3(x) - glm::dvec3(volumes.l); };
  for_each_index(volumes.edges.size(), [&](std::size_t i) {
    const VolumeEdge& edge = volumes.edges[i];
    tree.touch(ConvexFace::side(from_l(edge.a), from_l(edge.b)), [](std::uint32_t) { return true; });
  });
  for_each_index(volumes.caps.size(), [&](std::size_t i) {
    const auto& [a, b, c] = volumes.caps[i].corners;
    tree.touch(ConvexFace::triangle({from_l(a), from_l(b), from_l(c)}),
               [&](std::uint32_t plane) { return plane != volumes.caps[i].plane; });
  });
  std::set<std::uint32_t> planes;
  for (const Block& tile : tree.tiles()) planes.insert(tile.plane);
  const std::vector<Rim> rims = rims_of(volumes, planes);
  for_each_index(rims.size(), [&](std::size_t i) {
    tree.touch(ConvexFace::side(from_l(rims[i].a), from_l(rims[i].b)),
               [&](std::uint32_t plane) { return plane == rims[i].plane; });
  });
  for (std::size_t tile = 0; tile < tree.tiles().size(); ++tile) {
    if (tree.tiles()[tile].plane == kNoPlane) continue;
    ++plan.tiles;
    plan.whole += tree.is_touched(tile) ? 0 : 1;
  }
  std::vector<std::uint32_t> first(tree.tiles().size(), kNoPixel);
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    if (receivers[i].plane == gpu::kNotCounted) continue;
    const std::size_t tile = tree.tile_of(i, width);
    const auto pixel = static_cast<std::uint32_t>(i);
    if (first[tile] == kNoPixel) first[tile] = pixel;
    plan.stand_ins[i] = tree.is_touched(tile) ? pixel : first[tile];
  }
  return plan;
}

}  // namespace penumbra::volumes
