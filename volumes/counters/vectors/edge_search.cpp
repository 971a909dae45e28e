// SPDX-License-Identifier: Apache-2.0
// Searches for silhouette candidates of view samples: J. Lehtinen, S. Laine, T. Aila, An improved physically-based soft
// shadow volume algorithm, 2006 (kd-tree); S. Laine, T. Aila, U. Assarsson, J. Lehtinen, T. Akenine-Möller, Soft shadow
// volumes for ray tracing, 2005 (hemicube).

#include "volumes/counters/vectors/edge_search.hpp"

#include "volumes/wedges/wedge_casters.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace penumbra::volumes {
namespace {

using vectors::kWide;
using visibility::TriangleTree;

constexpr std::size_t kFewWedges = 16, kFewPixels = 16;  ///< cells with fewer are not divided
constexpr int kDeepest = 32;
constexpr std::uint32_t kCells = 32;  ///< cells along each side of a face of the hemicube
/// Factor that enlarges the light, so that no edge is missed that rounding may move across the light's rim. The
/// distance of stored light samples from their places (DeviceLight::deviation) is added separately.
constexpr double kAroundLight = 1 + 0x1p-10;

using Edge = std::array<glm::dvec3, 2>;
using Key = std::array<float, 6>;

Key key_of(const glm::vec3& a, const glm::vec3& b) {
  const bool turn = std::array{b.x, b.y, b.z} < std::array{a.x, a.y, a.z};
  const glm::vec3 &from = turn ? b : a, &to = turn ? a : b;
  return {from.x, from.y, from.z, to.x, to.y, to.z};
}

/// Returns a box around all stored light samples, in scene floats: its middle, then its corners. Close to the light's
/// plane, the box's thickness determines which objects may hide a sample.
LightHull hull_around(const visibility::DeviceLight& frame, float scale) {
  const double to_floats = 1 / static_cast<double>(scale), off = kAroundLight * static_cast<double>(frame.deviation);
  const glm::dvec3 u(frame.u), v(frame.v), n = glm::normalize(glm::cross(u, v));
  const auto longer = [&](const glm::dvec3& x) { return to_floats * (kAroundLight + off / glm::length(x)) * x; };
  LightHull hull;
  hull.center = to_floats * glm::dvec3(frame.center);
  hull.is_solid = true;
  for (const double side : {-off, off}) {
    const glm::dvec3 c = hull.center + to_floats * side * n;
    for (const glm::dvec2 at : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)})
      hull.corners.push_back(c + at.x * longer(u) + at.y * longer(v));
  }
  return hull;
}

enum class Overlap : std::uint8_t { none, some, all };
/// Returns the box's overlap with the wedge. Cases that are not certain in double are `some`.
Overlap overlap_of(const Wedge& wedge, const Box& box) {
  if (wedge.outcome == WedgeOutcome::empty) return Overlap::none;
  if (wedge.outcome != WedgeOutcome::wedge)
    return wedge.outcome == WedgeOutcome::everywhere ? Overlap::all : Overlap::none;
  const glm::dvec3 middle = 0.5 * (box.lower + box.upper), half = 0.5 * (box.upper - box.lower);
  Overlap overlap = Overlap::all;
  for (const Plane& plane : wedge.planes) {
    const double at = glm::dot(plane.normal(), middle) + plane.d, span = glm::dot(glm::abs(plane.normal()), half);
    const double rounding = 0x1p-45 * (glm::dot(glm::abs(plane.normal()), glm::abs(middle) + half) + std::abs(plane.d));
    if (at + span < -rounding) return Overlap::none;
    if (!(at - span > rounding)) overlap = Overlap::some;
  }
  return overlap;
}

/// Makes lists from (index, entry) pairs, each list ascending and without duplicates.
void fill(std::size_t count, std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs,
          std::vector<std::uint32_t>& begin, std::vector<std::uint32_t>& of) {
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  begin.assign(count + 1, 0);
  of.clear();
  for (const auto& [number, entry] : pairs) {
    ++begin[number + 1];
    of.push_back(entry);
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
}

/// Returns the leaves that are reachable: others are disabled.
std::vector<std::uint32_t> leaves_in_use(const vectors::WideEdgeTree& tree) {
  std::vector<std::uint32_t> stack = tree.roots, leaves;
  while (!stack.empty()) {
    const std::uint32_t next = stack.back();
    stack.pop_back();
    if ((next & TriangleTree::kLeafBit) != 0) {
      leaves.push_back(next);
      continue;
    }
    const vectors::WideNode& node = tree.nodes[next];
    for (std::uint32_t used = node.used; used != 0; used &= used - 1)
      stack.push_back(node.reference[static_cast<std::size_t>(std::countr_zero(used))]);
  }
  std::ranges::sort(leaves);
  return leaves;
}

}  // namespace

EdgeSearch::EdgeSearch(Search search, const EdgeSearchInput& input) : search_(search) {
  const Casters casters = casters_of(input.scene, input.light);
  const LightHull hull = hull_around(input.frame, input.scale);
  center_ = hull.center;
  const CastingEdges casting = casting_edges(casters, hull, SilhouettesFrom::anywhere, search == Search::kd_tree);
  std::vector<Edge> edges;
  for (const WedgeEdge& edge : casting.wedges) edges.push_back({edge.a, edge.b});
  map_leaves(input, edges);
  if (search == Search::hemicube) {
    build_hemicube(edges, hull.corners);
  } else {
    build_kd_tree(input, build_wedges(casting.wedges, hull, Construction::tight));
  }
}

/// Maps edges to leaves of the tree, by their ends.
void EdgeSearch::map_leaves(const EdgeSearchInput& input, const std::vector<Edge>& edges) {
  struct Slot {
    Key key;
    std::uint32_t leaf;
    bool operator<(const Slot& other) const { return key < other.key; }
  };
  std::vector<Slot> slots;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> of_plane;
  const std::vector<std::uint32_t> leaves = leaves_in_use(input.tree);
  for (const std::uint32_t reference : leaves) {
    const vectors::WideEdges& leaf = input.tree.leaves[reference & ~TriangleTree::kLeafBit];
    for (std::uint32_t used = leaf.used; used != 0; used &= used - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(used));
      const glm::vec3 a(leaf.a[0][lane], leaf.a[1][lane], leaf.a[2][lane]),
          b(leaf.b[0][lane], leaf.b[1][lane], leaf.b[2][lane]);
      slots.push_back({key_of(a, b), reference});
      for (std::size_t side = 0; side < 2; ++side) {
        if (leaf.plane[side][lane] < input.scene.triangles.size())
          of_plane.emplace_back(leaf.plane[side][lane], reference);
      }
    }
  }
  fill(input.scene.triangles.size(), of_plane, leaves_of_plane_.begin, leaves_of_plane_.of);
  std::ranges::sort(slots, {}, &Slot::key);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> of_edge;
  // Skips edges created by cutting, and mesh edges of non-casters, which are never silhouettes.
  std::vector<Key> known;
  const Casters all = casters_of(input.scene, input.light);
  for (const mesh::Edge& edge : all.graph.edges)
    known.push_back(
        key_of(glm::vec3(all.positions[edge.a]) * input.scale, glm::vec3(all.positions[edge.b]) * input.scale));
  std::ranges::sort(known);
  for (const Slot& slot : slots) {
    if (!std::ranges::binary_search(known, slot.key)) always_.push_back(slot.leaf);
  }
  std::ranges::sort(always_);
  always_.erase(std::unique(always_.begin(), always_.end()), always_.end());
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    const Key key = key_of(glm::vec3(edges[i][0]) * input.scale, glm::vec3(edges[i][1]) * input.scale);
    for (auto slot = std::ranges::lower_bound(slots, key, {}, &Slot::key); slot != slots.end() && slot->key == key;
         ++slot)
      of_edge.emplace_back(i, slot->leaf);
  }
  fill(edges.size(), of_edge, leaves_of_.begin, leaves_of_.of);
}

void EdgeSearch::build_kd_tree(const EdgeSearchInput& input, const std::vector<Wedge>& wedges) {
  std::vector<std::uint32_t> pixels, all(wedges.size());
  Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(-std::numeric_limits<double>::max())};
  for (std::uint32_t i = 0; i < input.samples.size(); ++i) {
    if (input.samples.triangle[i] == visibility::ViewSamples::kBackground) continue;
    pixels.push_back(i);
    box.lower = glm::min(box.lower, glm::dvec3(input.samples.p[i]));
    box.upper = glm::max(box.upper, glm::dvec3(input.samples.p[i]));
  }
  std::iota(all.begin(), all.end(), 0U);
  nodes_.emplace_back();
  if (!pixels.empty()) divide(0, box, wedges, all, pixels, input.samples, 0);
  cells_ = static_cast<std::size_t>(std::ranges::count(nodes_, 0U, &Node::children));
}

/// `list`: indices of the wedges that may meet the box and are not stored at a node above.
void EdgeSearch::divide(std::uint32_t node, const Box& box, std::span<const Wedge> wedges,
                        std::span<const std::uint32_t> list, std::vector<std::uint32_t>& pixels,
                        const visibility::ViewSamples& samples, int depth) {
  std::vector<std::uint32_t> here, below;
  for (const std::uint32_t number : list) {
    const Overlap overlap = overlap_of(wedges[number], box);
    if (overlap != Overlap::none) (overlap == Overlap::all ? here : below).push_back(number);
  }
  const glm::dvec3 size = box.upper - box.lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const bool is_leaf =
      below.size() <= kFewWedges || pixels.size() <= kFewPixels || depth >= kDeepest || !(size[axis] > 0);
  if (is_leaf) here.insert(here.end(), below.begin(), below.end());
  nodes_[node].first = static_cast<std::uint32_t>(entries_.size());
  std::vector<std::uint32_t> sources;
  for (const std::uint32_t number : here) sources.push_back(wedges[number].source);
  std::ranges::sort(sources);
  sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
  entries_.insert(entries_.end(), sources.begin(), sources.end());
  nodes_[node].count = static_cast<std::uint32_t>(sources.size());
  if (is_leaf) return;
  const double split = 0.5 * (box.lower[axis] + box.upper[axis]);
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].axis = axis;
  nodes_[node].split = split;
  nodes_[node].children = children;
  nodes_.resize(nodes_.size() + 2);
  std::array<std::vector<std::uint32_t>, 2> parts;
  for (const std::uint32_t pixel : pixels)
    parts[static_cast<double>(samples.p[pixel][axis]) < split ? 0 : 1].push_back(pixel);
  std::vector<std::uint32_t>().swap(pixels);
  for (std::uint32_t i = 0; i < 2; ++i) {
    Box part = box;
    (i == 0 ? part.upper : part.lower)[axis] = split;
    if (!parts[i].empty()) divide(children + i, part, wedges, below, parts[i], samples, depth + 1);
  }
}

namespace {

/// A cell of a face: directions with z > 0 along sign · axis and (x, y) / z in [low, high].
struct Cell {
  int axis;
  double sign;
  glm::dvec2 low, high;

  /// Returns whether certainly no direction of the cone of `directions` is in the cell.
  [[nodiscard]] bool misses(std::span<const glm::dvec3> directions) const {
    std::array<bool, 5> beyond;
    beyond.fill(true);
    for (const glm::dvec3& direction : directions) {
      const double z = sign * direction[axis], x = direction[(axis + 1) % 3], y = direction[(axis + 2) % 3];
      const double rounding = -0x1p-45 * (std::abs(x) + std::abs(y) + std::abs(z));
      beyond[0] = beyond[0] && z < rounding;
      beyond[1] = beyond[1] && x - low.x * z < rounding;
      beyond[2] = beyond[2] && high.x * z - x < rounding;
      beyond[3] = beyond[3] && y - low.y * z < rounding;
      beyond[4] = beyond[4] && high.y * z - y < rounding;
    }
    return std::ranges::any_of(beyond, [](bool all) { return all; });
  }
};

/// Calls `visit(column, row)` for the cells of a face that the cone may meet, within the block of `size` cells at
/// (column, row).
template <typename Visit>
void for_each_cell(const Cell& face, std::uint32_t column, std::uint32_t row, std::uint32_t size,
                   std::span<const glm::dvec3> directions, const Visit& visit) {
  const auto place = [](std::uint32_t i) { return 2.0 * i / kCells - 1; };
  const Cell cell{face.axis, face.sign, {place(column), place(row)}, {place(column + size), place(row + size)}};
  if (cell.misses(directions)) return;
  if (size == 1) return visit(column, row);
  for (const std::uint32_t i : {0U, 1U, 2U, 3U})
    for_each_cell(face, column + i % 2 * (size / 2), row + i / 2 * (size / 2), size / 2, directions, visit);
}

}  // namespace

/// Let c be the light's centre. A point p = x + t (x − l), x on the edge and t > 0, is seen from c in the direction (x
/// − c) + t (x − l): a direction in the cone spanned by x − c and x − l of both ends.
void EdgeSearch::build_hemicube(const std::vector<Edge>& edges, std::span<const glm::dvec3> light) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> in_cell;
  std::vector<glm::dvec3> directions;
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    directions.clear();
    for (const glm::dvec3& x : edges[i]) {
      directions.push_back(x - center_);
      for (const glm::dvec3& l : light) directions.push_back(x - l);
    }
    for (std::uint32_t face = 0; face < 6; ++face) {
      const Cell of_face{static_cast<int>(face / 2), face % 2 == 0 ? 1.0 : -1.0, {}, {}};
      for_each_cell(of_face, 0, 0, kCells, directions, [&](std::uint32_t column, std::uint32_t row) {
        in_cell.emplace_back((face * kCells + row) * kCells + column, i);
      });
    }
  }
  cells_ = std::size_t{6} * kCells * kCells;
  fill(cells_, in_cell, cells_of_.begin, entries_);
}

std::size_t EdgeSearch::cell_of(const glm::vec3& p) const {
  const glm::dvec3 direction = glm::dvec3(p) - center_, size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const double z = std::max(size[axis], std::numeric_limits<double>::min());
  const auto place = [&](int i) {
    const double at = std::floor((direction[i] / z + 1) * 0.5 * kCells);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kCells - 1)));
  };
  const std::size_t face = 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0 ? 1 : 0);
  return (face * kCells + place((axis + 2) % 3)) * kCells + place((axis + 1) % 3);
}

/// Visits the lists of p's cell.
template <typename Visit>
void EdgeSearch::for_each_list(const glm::vec3& p, const Visit& visit) const {
  if (search_ == Search::hemicube) {
    const std::size_t cell = cell_of(p);
    return visit(std::span(entries_).subspan(cells_of_.begin[cell], cells_of_.begin[cell + 1] - cells_of_.begin[cell]));
  }
  for (std::uint32_t at = 0;;) {
    const Node& node = nodes_[at];
    visit(std::span(entries_).subspan(node.first, node.count));
    if (node.children == 0) return;
    at = node.children + (static_cast<double>(p[node.axis]) < node.split ? 0 : 1);
  }
}

std::size_t EdgeSearch::count(const glm::vec3& p) const {
  std::size_t sum = 0;
  for_each_list(p, [&](std::span<const std::uint32_t> list) { sum += list.size(); });
  return sum;
}

void EdgeSearch::find_leaves(std::span<const glm::vec3> p, std::span<const std::uint32_t> planes,
                             std::vector<std::uint32_t>& leaves) const {
  leaves = always_;
  std::uint32_t before = static_cast<std::uint32_t>(leaves_of_plane_.begin.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    for_each_list(p[i], [&](std::span<const std::uint32_t> list) {
      for (const std::uint32_t wedge : list)
        leaves.insert(leaves.end(), leaves_of_[wedge].begin(), leaves_of_[wedge].end());
    });
    if (planes[i] != before) {
      const auto own = leaves_of_plane_[planes[i]];
      leaves.insert(leaves.end(), own.begin(), own.end());
    }
    before = planes[i];
  }
  std::ranges::sort(leaves);
  leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
}

std::uint64_t EdgeSearch::bytes() const {
  return sizeof(std::uint32_t) *
             (entries_.capacity() + cells_of_.begin.capacity() + leaves_of_.of.capacity() +
              leaves_of_.begin.capacity() + leaves_of_plane_.of.capacity() + leaves_of_plane_.begin.capacity()) +
         nodes_.capacity() * sizeof(Node);
}

}  // namespace penumbra::volumes
